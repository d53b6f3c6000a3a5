"""A study under several laws: the same ribbons, a batch for each law, compared ribbon by ribbon.

Every ribbon starts as in any batch, from its neighbour or by itself: where there are several
equilibria, laws may be found on different ones. Energies and loads are compared, with bars.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from statistics import median
from typing import Any

from ribbonopt.classes import dataclass
from ribbonopt.errors import SceneError
from ribbonopt.output.summary import versions
from ribbonopt.plain import Row, finite
from ribbonopt.studies.batch.batch import run_batch
from ribbonopt.studies.batch.study import Study
from ribbonopt.studies.machine import machine

from .choice import Choice, Sizes, choices, names_of
from .makers import ALL
from .ribbons import Ribbons
from .row_gaps import GAPS, SPECIAL_GAPS, gaps_of, with_special
from .rows import begun

NOTHING = Sizes()
OWN = "own"


@dataclass(frozen=True)
class StudyComparison:
    """A study under several laws.

    Attributes
    ----------
    name : str
        Of the study.
    count : int
        Its ribbons.
    inputs : tuple of str
        What is swept.
    laws : tuple of Row
        One for each law, the scenes' own first: how many are verified, and how far from that.
    rows : tuple of Row
        One for each ribbon and law.
    """

    name: str
    count: int
    inputs: tuple[str, ...]
    laws: tuple[Row, ...]
    rows: tuple[Row, ...]

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns of rows."""
        return tuple(dict.fromkeys(("number", "law", *(name for row in self.rows for name in row))))

    @property
    def solved(self) -> bool:
        """Whether any ribbon is verified under any law."""
        return any(row["verified"] for row in self.rows)

    def plain(self) -> dict[str, Any]:
        """Everything but the single ribbons as plain data for JSON."""
        head = {"name": self.name, "ribbons": self.count, "inputs": list(self.inputs)}
        return head | {"laws": list(self.laws), "machine": machine(), "versions": versions()}

    def with_curves(self) -> dict[str, Any]:
        """Return everything, with what a figure draws."""
        return self.plain() | {"rows": list(self.rows)}


def compare_study(
    study: Study,
    laws: Iterable[str] = (ALL,),
    sizes: Sizes = NOTHING,
    jobs: int | None = None,
    told: Callable[[str], None] = lambda text: None,
) -> StudyComparison:
    """Solve all ribbons of a study under their own laws and under others.

    Parameters
    ----------
    study
        What to solve; full solutions are not kept.
    laws, sizes
        As in `compare_laws`.
    jobs
        Worker processes.
    told
        Is told what is done.

    Raises
    ------
    SceneError
        If a law is not known, or sizes are given twice. What a law cannot carry is a row.
    """
    ribbons = Ribbons(study, names_of(laws), sizes)
    found: dict[str, Row] = {}
    rows: list[Row] = []
    reference: dict[int, Row] = {}
    for choice in _wanted(ribbons):
        law = begun(choice) | {"ribbons": 0, "solved": 0}
        if choice.law is not None:
            started = time.perf_counter()
            chosen = study if choice.name == OWN else ribbons.under(choice.name)
            solved = []
            for row in run_batch(replace(chosen, save="none"), jobs=jobs):
                solved.append(row)
                told(f"{choice.name}: {len(solved)}/{study.count}")
            solved = [_named(row, choice.name) for row in sorted(solved, key=_number)]
            reference = reference or {row["number"]: row for row in solved}
            lengths = ribbons.lengths
            solved = [
                row | gaps_of(row, reference.get(row["number"]), lengths[row["number"] - 1])
                for row in solved
            ]
            rows += solved
            law |= _summed(solved) | {"seconds": time.perf_counter() - started}
        found[choice.name] = finite(law)
    keys = tuple(key for key in study.keys if key.split(".")[0] != "law")
    return StudyComparison(study.name, study.count, keys, tuple(found.values()), tuple(rows))


def _wanted(ribbons: Ribbons) -> Iterator[Choice]:
    """Yield the scenes' own laws, then those of names that are not that of all scenes."""
    firsts = list(ribbons.firsts())
    if not firsts:
        raise SceneError(f"{ribbons.study.name}: no scene of the study can be read")
    kinds = {scene.law.type for scene in firsts}
    alone = firsts[0].law.type if len(kinds) == 1 else OWN
    yield Choice(OWN, firsts[0].law, note=f"the law of the study, {alone}" if alone != OWN else "")
    for name in ribbons.names:
        if name != alone:
            _, *others = choices(firsts[0], (name,), ribbons.given)
            yield from others or [Choice(name, firsts[0].law)]


def _named(row: Row, law: str) -> Row:
    """Return a row with the word for its law in place of an input."""
    kept = {name: value for name, value in row.items() if name != "law"}
    return with_special({"number": kept.pop("number"), "law": law, **kept})


def _summed(rows: list[Row]) -> Row:
    """Return how many ribbons are verified under a law, and how far they are from the first."""
    solved = [row for row in rows if row["verified"]]
    result: Row = {"ribbons": len(rows), "solved": len(solved), "verified": bool(solved)}
    failed = [row for row in rows if not row["verified"]]
    result["status"] = "converged" if not failed else "some_failed" if solved else "none_solved"
    if failed:
        first = failed[0]
        result["message"] = f"number {first['number']}: {first['status']}: {first['message']}"
    for name in (*GAPS, *SPECIAL_GAPS):
        gaps = [row[f"{name}_gap"] for row in rows if row.get(f"{name}_gap") is not None]
        result[f"{name}_gap"] = median(gaps) if gaps else None
        result[f"{name}_gap_largest"] = max(gaps, key=abs) if gaps else None
    return result


def _number(row: Row) -> int:
    return int(row["number"])
