"""What is to be exported as solutions: a result with its other equilibria, a branch, a batch."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import field
from pathlib import Path

from ribbonopt.classes import dataclass
from ribbonopt.errors import OutputError
from ribbonopt.output.results import other_equilibria
from ribbonopt.plain import Row, is_number
from ribbonopt.reading import is_file
from ribbonopt.scene import Scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.batch.results import Batch
from ribbonopt.studies.continuation.branch import Branch
from ribbonopt.studies.loading import load
from ribbonopt.studies.maps.map import Map

Thing = Solution | tuple[Solution, ...] | Branch | Batch


@dataclass(frozen=True, eq=False)
class Ribbon:
    """A solution to be exported.

    Attributes
    ----------
    solution : Solution
        It itself.
    label : str
        What the names of its files have behind the common one, such as `-0012`.
    words : str
        What it is among others, behind the name of its scene.
    numbers : mapping of str to float
        What tells it from the others: its number, and its parameter on a branch.
    series : str or None
        The label of the series that it belongs to, if any.
    """

    solution: Solution
    label: str = ""
    words: str = ""
    numbers: Mapping[str, float] = field(default_factory=dict)
    series: str | None = None


def opened(path: str | Path, scene: Scene | None = None) -> Thing:
    """Return what a folder of results holds; of a result all equilibria, the first one first.

    Raises
    ------
    OutputError
        If it holds no result, a damaged one, or a map, whose shapes are results by themselves.
    """
    found = load(path, scene)
    if isinstance(found, Map):
        raise OutputError(found.held)
    if not isinstance(found, Solution):
        return found
    folder = Path(path)
    folder = folder.parent if is_file(folder) else folder
    return (found, *other_equilibria(folder, scene))


def name_of(thing: Thing) -> str:
    """Return the name that files of something have in common."""
    if isinstance(thing, Batch):
        return thing.name
    first = thing[0] if isinstance(thing, tuple) else thing
    return first.scene.name


def ribbons_of(thing: Thing) -> Iterator[Ribbon]:
    """Yield all ribbons of something, restored one by one.

    Raises
    ------
    OutputError
        If a batch has saved no solution, or one is damaged.
    """
    if isinstance(thing, Solution):
        thing = (thing, *thing.others)
    if isinstance(thing, tuple):
        yield Ribbon(thing[0])
        for i, other in enumerate(thing[1:], start=2):
            yield Ribbon(other, f"-{i}", f", equilibrium {i}", {"equilibrium": float(i)})
    elif isinstance(thing, Branch):
        yield from _points(thing, "")
    else:
        yield from _saved(thing)


def left_out_of(thing: Thing) -> list[str]:
    """Return what there is no solution of."""
    if not isinstance(thing, Batch) or len(thing.saved) == len(thing.rows):
        return []
    lacking = len(thing.rows) - len(thing.saved)
    return [f"{lacking} of {len(thing.rows)} ribbons, which the batch did not save (`save: all`)"]


def _points(branch: Branch, label: str) -> Iterator[Ribbon]:
    """Yield the points of a branch, each in the series of its stage and branch."""
    keys = list(dict.fromkeys((row["stage"], row["branch"]) for row in branch.rows))
    for solution, row in zip(branch, branch.rows, strict=True):
        key = row["stage"], row["branch"]
        own = f"-stage{key[0] + 1}-branch{key[1]}" if len(keys) > 1 else ""
        yield Ribbon(
            solution,
            f"{label}-{row['number']:04d}",
            _told(row),
            _numbers(row),
            f"{label}{own}",
        )


def _told(row: Row) -> str:
    kind = "" if row["kind"] == "point" else f" ({row['kind']})"
    return f", point {row['number']}{kind}: {row['parameter']} = {row[row['parameter']]:.6g}"


def _numbers(row: Row) -> dict[str, float]:
    """Return the numbers that tell a point of a branch."""
    named = {"number": row["number"], "parameter": row[row["parameter"]]}
    return _plain(named | {name: row.get(name) for name in ("stage", "branch")})


def _plain(values: Row) -> dict[str, float]:
    """Return those values that are numbers."""
    return {name: float(value) for name, value in values.items() if is_number(value)}


def _saved(batch: Batch) -> Iterator[Ribbon]:
    """Yield what a batch has saved; of ribbons that were continued, all their points."""
    if not batch.saved:
        if not any(row["verified"] for row in batch.rows):
            raise OutputError(
                f"{batch.name}: none of its {len(batch)} ribbons was solved, so there is nothing "
                "to export; what failed stands in its table.csv and report.html"
            )
        raise OutputError(
            f"{batch.name}: no solution of this batch was saved; `save: all` in its study keeps "
            "them, and with it the batch is to be solved again"
        )
    rows = {row["number"]: row for row in batch.rows}
    for number in batch.saved:
        found, label = batch[number], f"-{number:04d}"
        if isinstance(found, Solution):
            told = _plain({name: rows[number].get(name) for name in ("number", *batch.inputs)})
            yield Ribbon(found, label, f", ribbon {number}", told)
            for i, other in enumerate(batch.others(number), start=2):
                words = f", ribbon {number}, equilibrium {i}"
                yield Ribbon(other, f"{label}-{i}", words, told | {"equilibrium": float(i)})
        else:
            yield from _points(found, label)
