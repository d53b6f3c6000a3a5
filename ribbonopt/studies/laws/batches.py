"""A study under several laws: the same ribbons, a batch for each law, compared ribbon by ribbon.

Every ribbon starts as in any batch, from its neighbour or by itself: where there are several
equilibria, laws may be found on different ones. Energies and loads are compared, with bars.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial
from statistics import median
from typing import Any

import numpy as np

from ribbonopt.errors import SceneError
from ribbonopt.output.summary import versions
from ribbonopt.plain import Row, finite
from ribbonopt.scene import Law, Scene
from ribbonopt.scene.quantities import START_VECTORS
from ribbonopt.scene.units import units_of
from ribbonopt.scene.yamlio import loads_scene
from ribbonopt.studies.batch.batch import run_batch
from ribbonopt.studies.batch.inputs import Inputs, InputRows
from ribbonopt.studies.batch.study import Study, Sweep, assignments
from ribbonopt.studies.machine import machine

from .choice import ALL, Choice, Sizes, choices, names_of
from .rows import begun

NOTHING = Sizes()
GAPS = ("energy", "n0", "m0")
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


@dataclass(frozen=True)
class _Ribbons:
    """The ribbons of a study as scenes, and the laws that are wanted of them."""

    study: Study
    names: tuple[str, ...]
    given: Sizes

    @cached_property
    def lengths(self) -> list[float | None]:
        """Units of length by ribbon; None for a scene that cannot be read."""
        return [
            None if scene is None else units_of(scene).length
            for sweep in self.study.sweeps
            for scene in map(partial(_scene, sweep), sweep.inputs)
        ]

    def firsts(self) -> Iterator[Scene]:
        """Yield the first ribbon of every sweep, where it can be read."""
        for sweep in self.study.sweeps:
            scene = _scene(sweep, sweep.inputs[0])
            if scene is not None:
                yield scene

    def law(self, name: str, scene: Scene) -> Law | None:
        """Return a law with the numbers of one ribbon."""
        found = {choice.name: choice.law for choice in choices(scene, (name,), self.given)}
        return found[name]

    def under(self, name: str) -> Study:
        """Return the study under another law."""
        sweeps = tuple(self._sweep(sweep, name) for sweep in self.study.sweeps)
        return replace(self.study, sweeps=sweeps, save="none")

    def _sweep(self, sweep: Sweep, name: str) -> Sweep:
        def at(index: int) -> Inputs:
            inputs, scene = sweep.inputs[index], _scene(sweep, sweep.inputs[index])
            law = None if scene is None else self.law(name, scene)
            kept = {key: value for key, value in inputs.items() if key.split(".")[0] != "law"}
            return kept | {"law": name if law is None else _plain(law)}

        keys = tuple(dict.fromkeys((*sweep.inputs.keys, "law")))
        common = {k: v for k, v in sweep.common.items() if k.split(".")[0] != "law"}
        return replace(sweep, common=common, inputs=InputRows(sweep.inputs.size, keys, at))


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
    ribbons = _Ribbons(study, names_of(laws), sizes)
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
            solved = [row | _gaps(row, reference, lengths) for row in solved]
            rows += solved
            law |= _summed(solved) | {"seconds": time.perf_counter() - started}
        found[choice.name] = finite(law)
    keys = tuple(key for key in study.keys if key.split(".")[0] != "law")
    return StudyComparison(study.name, study.count, keys, tuple(found.values()), tuple(rows))


def _wanted(ribbons: _Ribbons) -> Iterator[Choice]:
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
    return {"number": kept.pop("number"), "law": law, **kept}


def _gaps(row: Row, reference: dict[int, Row], lengths: list[float | None]) -> Row:
    """Return the relative differences of a row to that under the own law, with bars."""
    other = reference.get(row["number"])
    length = lengths[row["number"] - 1]
    if other is None or row["law"] == other["law"] or length is None:
        return {}
    if not (row["verified"] and other["verified"]):
        return {}
    result: Row = {}
    here, there = (_vectors(some, length) for some in (row, other))
    loads = max(float(np.linalg.norm(there[name])) for name in ("n0", "m0"))
    for name in GAPS:
        gap = here[name] - there[name]
        own = float(np.linalg.norm(there[name]))
        size = own if own > 1e-9 * loads else loads
        value = float(gap[0]) if name == "energy" else float(np.linalg.norm(gap))
        result[f"{name}_gap"] = value / size if size else None
        bars = [_bar(some, vectors, name) for some, vectors in ((row, here), (other, there))]
        known = [bar for bar in bars if bar is not None]
        bar = sum(known) + abs(value) / size * known[1] if len(known) == 2 and size else None
        result[f"{name}_gap_error"] = None if bar is None else bar / size
    return result


def _vectors(row: Row, length: float) -> dict[str, Any]:
    """Energy and loads of a row as vectors, all times such powers of the length as make moments."""
    n, m = (np.array([row[name] for name in names]) for names in START_VECTORS[:2])
    return {"energy": np.array([row["energy"]]), "n0": n * length, "m0": m}


def _bar(row: Row, vectors: dict[str, Any], name: str) -> float | None:
    """Return a bar from the relative bound of all of a row; loads are measured by the larger."""
    if row["error"] is None:
        return None
    parts = ("energy",) if name == "energy" else ("n0", "m0")
    largest = max(float(np.abs(vectors[part]).max()) for part in parts)
    return float(row["error"]) * largest * (1.0 if name == "energy" else 3**0.5)


def _summed(rows: list[Row]) -> Row:
    """Return how many ribbons are verified under a law, and how far they are from the first."""
    solved = [row for row in rows if row["verified"]]
    result: Row = {"ribbons": len(rows), "solved": len(solved), "verified": bool(solved)}
    failed = [row for row in rows if not row["verified"]]
    result["status"] = "converged" if not failed else "some_failed" if solved else "none_solved"
    if failed:
        first = failed[0]
        result["message"] = f"number {first['number']}: {first['status']}: {first['message']}"
    for name in GAPS:
        gaps = [row[f"{name}_gap"] for row in rows if row.get(f"{name}_gap") is not None]
        result[f"{name}_gap"] = median(gaps) if gaps else None
        result[f"{name}_gap_largest"] = max(gaps, key=abs) if gaps else None
    return result


def _scene(sweep: Sweep, inputs: Inputs) -> Scene | None:
    try:
        return loads_scene(
            sweep.source.text, sweep.source.name, assignments(sweep.common | inputs)
        )
    except SceneError:
        return None  # its row says why


def _number(row: Row) -> int:
    return int(row["number"])


def _plain(law: Law) -> dict[str, Any]:
    """Return a law as a scene file says it."""
    named = {f.name: getattr(law, f.name) for f in fields(law)}
    return {k: list(v) if isinstance(v, tuple) else v for k, v in named.items() if v is not None}
