"""A branch under several laws: the same continuation, one law after the other.

Each begins near the first point of the scene's own branch. Special points are told apart by stage,
branch, group (folds, and what other branches cross) and number, so that those of one law stand
beside those of another.
"""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.errors import ConvergenceError, RibbonoptError
from ribbonopt.output.summary import versions
from ribbonopt.plain import Row, finite
from ribbonopt.scene import Scene
from ribbonopt.scene.stages import stages_of
from ribbonopt.scene.units import units_of
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.walk.points import CROSSINGS, POINT, Point
from ribbonopt.studies.machine import machine

from .choice import Choice, Sizes, choices, names_of, under
from .makers import ALL
from .rows import begun
from .solved import REFUSED, Outcome, near, told_of

SPECIAL = ("law", "kind", "place", "stage", "branch", "parameter", "value", "value_error")
NOT_REACHED = "target_not_reached"


@dataclass(frozen=True)
class BranchComparison:
    """One branch under several laws.

    Attributes
    ----------
    name, units : str, str
        Of the scene.
    laws : tuple of Row
        One for each law, the scene's own first; `points` are the rows of its branch.
    pairs : tuple of (str, str)
        Columns worth drawing against each other.
    log : tuple of str
        Columns on logarithmic axes.
    """

    name: str
    units: str
    laws: tuple[Row, ...]
    pairs: tuple[tuple[str, str], ...] = ()
    log: tuple[str, ...] = ()

    columns = (*SPECIAL, "energy", "note")

    @property
    def solved(self) -> bool:
        """Whether any law gave a verified point."""
        return any(row["verified"] for row in self.laws)

    @property
    def rows(self) -> tuple[Row, ...]:
        """The special points of all laws."""
        return tuple(row for law in self.laws for row in law["special"])

    def plain(self) -> dict[str, Any]:
        """Everything but the points of the branches as plain data for JSON."""
        laws = [{k: v for k, v in law.items() if k != "points"} for law in self.laws]
        head = {"name": self.name, "units": self.units, "laws": laws}
        return head | {"machine": machine(), "versions": versions()}

    def with_curves(self) -> dict[str, Any]:
        """Return everything, with what a figure draws."""
        drawn = {"pairs": [list(pair) for pair in self.pairs], "log": list(self.log)}
        return self.plain() | drawn | {"laws": list(self.laws)}


def compare_branches(
    scene: Scene,
    laws: Iterable[str] = (ALL,),
    sizes: Sizes | None = None,
    told: Callable[[str], None] = lambda text: None,
) -> BranchComparison:
    """Follow a scene's `continuation` under its own law and under others.

    Parameters
    ----------
    scene, laws, sizes
        As in `compare_laws`.
    told
        Is told where the walk is.

    Raises
    ------
    SceneError
        If a law is not known, or sizes are given twice. What a law cannot carry is a row.
    """
    rows: list[Row] = []
    first: Solution | None = None
    log: tuple[str, ...] = ()
    pairs: tuple[tuple[str, str], ...] = ()
    for choice in choices(scene, names_of(laws), sizes or Sizes()):
        row = begun(choice) | {"points": [], "special": [], "endings": []}
        if choice.law is not None:
            started = time.perf_counter()
            walk = _Walk(under(scene, choice), choice, told)
            row |= walk.followed(first, own=not rows)
            row["seconds"] = time.perf_counter() - started
            first = first or walk.first
            log, pairs = log or walk.log, pairs or walk.pairs
        rows.append(finite(row))
    return BranchComparison(scene.name, units_of(scene).name, tuple(rows), pairs, log)


def bar_of(value: float, error: float | None, log: bool) -> float | None:
    """Return the bar of a value from that of its position, which may be its logarithm."""
    return None if error is None else error * (math.log(10) * abs(value) if log else 1.0)


class _Walk:
    """One law's branch."""

    def __init__(self, scene: Scene, choice: Choice, told: Callable[[str], None]) -> None:
        self.scene, self.choice, self.told = scene, choice, told
        self.first: Solution | None = None
        self.points: list[Row] = []
        self.special: list[Row] = []
        self.counts: Counter[tuple[int, int, str]] = Counter()
        self.log: tuple[str, ...] = ()
        self.pairs: tuple[tuple[str, str], ...] = ()

    def followed(self, guess: Solution | None, *, own: bool) -> Row:
        """Follow the branch; return what its row says."""
        begin, ending = Outcome(None, ""), Row()
        try:
            found = Continuation(self.scene)
            if not own:
                begin = near(found.first_scene, guess, found.prepared)
                found.near = begin.solution if begin.verified else None
            for point in found:
                self._take(point)
            reached = found.ending.reached
            ending = {"status": "converged" if reached else NOT_REACHED}
            ending["message"] = found.ending.reason
            self._drawn(found)
            ending["endings"] = [
                {"stage": key[0], "branch": key[1], "reached": e.reached, "reason": e.reason}
                for key, e in found.endings.items()
            ]
        except (RibbonoptError, np.linalg.LinAlgError) as error:
            status = error.status if isinstance(error, ConvergenceError) else REFUSED
            ending = {"status": status, "message": " ".join(str(error).split())}
        told = [row["note"] for row in self.points if row["note"] and row["kind"] == POINT]
        lost = begin.lost if begin.verified else ""
        notes = filter(None, [self.choice.note, lost, told_of(begin), *dict.fromkeys(told)])
        verified = {"verified": bool(self.points), "start": begin.start}
        what = {"note": "; ".join(notes), "points": self.points, "special": self.special}
        return ending | verified | what

    def _take(self, point: Point[Solution]) -> None:
        row = dict(point.row)
        self.first = self.first or point.solution
        self.points.append(row)
        self.told(f"{self.choice.name}: {row['parameter']} = {row[row['parameter']]:.6g}")
        if point.kind == POINT:
            return
        crossing = point.kind in CROSSINGS  # of laws with a derivative branch points, else buckling
        key = point.stage, point.branch, "crossing" if crossing else point.kind
        self.counts[key] += 1
        value = float(row[row["parameter"]])
        log = stages_of(self.scene)[point.stage].scale == "log"
        names = ("kind", "stage", "branch", "parameter", "energy", "note")
        self.special.append(
            {"law": self.choice.name, "place": self.counts[key], "value": value}
            | {"value_error": bar_of(value, point.error, log), "group": key[2]}
            | {name: row.get(name) for name in names}
        )

    def _drawn(self, found: Continuation) -> None:
        """Choose what is worth seeing."""
        parameters = found.recorder.parameters
        x = parameters[0] if len(parameters) == 1 else "value"
        names = [*found.recorder.formulas, "energy", "u2", "H0", "u3"]
        self.pairs = tuple((x, name) for name in names)
        self.log = tuple(s.moved for s in found.stages if s.scale == "log")
