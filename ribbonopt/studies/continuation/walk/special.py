"""Folds and branch points between two points of a branch, located to rounding."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from .beside import ENOUGH, Beside, Probe
from .points import BRANCH_POINT, FOLD, Point, S, Special
from .protocol import Equations
from .switching import named
from .tangents import near

ONE = 1e-6  # arclength within which a fold and a branch point are one: a pitchfork from its side
FROM_THE_SIDE = "pitchfork, met from its side branch"
ASIDE = 0.03  # arclength on both sides of a special point, between which it is found again
MESHES = 3  # on finer meshes, at most
SAFETY = 4.0  # bar over what a finer mesh moves, as of all other numbers
ROUNDING = 2e-14  # of a position: how exactly the root of a test function is known at best


def special_points(equations: Equations[S], a: Point[S], b: Point[S]) -> Special[S]:
    """Return folds and branch points between two points of one layout.

    A test function that changes its sign without a root that is found is named in `unresolved`.
    """
    kinds = _changed(a, b)
    if not kinds:
        return Special([])
    try:
        beside = Beside(equations, a, b)
        found = {kind: beside.root(TESTS[kind](beside)) for kind in kinds}
    except np.linalg.LinAlgError:
        return Special([], kinds, len(kinds))
    unresolved = tuple(kind for kind, arc in found.items() if arc is None)
    arcs = {kind: arc for kind, arc in found.items() if arc is not None}
    note = ""
    if len(arcs) == 2 and abs(arcs[FOLD] - arcs[BRANCH_POINT]) < ONE:
        del arcs[FOLD]
        note = FROM_THE_SIDE
    points = []
    for kind, arc in sorted(arcs.items(), key=lambda item: item[1]):
        point = _on_finer_meshes(equations, beside, _point(beside, kind, arc), arc)
        if kind == BRANCH_POINT:
            point = replace(point, note=note or named(equations, point))
        points.append(point)
    return Special(points, unresolved, len(kinds))


def _changed(a: Point[S], b: Point[S]) -> tuple[str, ...]:
    """Kinds of points whose test functions change their sign."""
    turns, crosses = a.tangent[-1] * b.tangent[-1] < 0, a.sign * b.sign < 0
    return tuple(kind for kind, is_ in ((FOLD, turns), (BRANCH_POINT, crosses)) if is_)


def _turning(beside: Beside[S]) -> Callable[[Probe[S]], float]:
    """Test function of folds."""
    return lambda probe: float(probe.tangent[-1])


def _determinant(beside: Beside[S]) -> Callable[[Probe[S]], float]:
    """Test function of branch points, relative to its value at the first point."""
    origin = beside.ends[0].near.log
    return lambda probe: probe.near.sign * float(np.exp(probe.near.log - origin))


TESTS: Mapping[str, Callable[[Beside[Any]], Callable[[Probe[Any]], float]]] = {
    FOLD: _turning,
    BRANCH_POINT: _determinant,
}


def _point(beside: Beside[S], kind: str, arc: float) -> Point[S]:
    unknowns = beside.unknowns(arc)
    return replace(
        beside.a,
        solution=beside.equations.restored(beside.a.solution, unknowns),
        unknowns=unknowns,
        tangent=beside.tangent(arc),
        kind=kind,
        note="",
        error=None,
    )


def _on_finer_meshes(
    equations: Equations[S], beside: Beside[S], point: Point[S], arc: float
) -> Point[S]:
    """Find a special point again in finer layouts, until that moves it little enough."""
    for _ in range(MESHES):
        try:
            again = _finer(equations, beside, point, arc)
        except np.linalg.LinAlgError:
            again = None
        if again is None:
            return point
        beside, arc = again
        found = _point(beside, point.kind, arc)
        # Of the coarser of the two: that of the finer is less, but for an accident of both.
        error = SAFETY * abs(found.position - point.position)
        # But two may agree by accident.
        point = replace(found, error=max(error, ROUNDING * abs(found.position)))
        if equations.enough(error, point.position):
            break
    return point


def _finer(
    equations: Equations[S], beside: Beside[S], point: Point[S], arc: float
) -> tuple[Beside[S], float] | None:
    """Return the branch on both sides of a special point in a finer layout, and where it is."""
    sides, aside = [], min(ASIDE, beside.reach(arc))
    for place in (arc - aside, arc + aside):
        finer = equations.finer(beside.a.solution, beside.unknowns(place))
        ahead = equations.finer(beside.a.solution, beside.unknowns(place + (arc - place) / 3))
        if finer is None or ahead is None:
            return None
        solution, unknowns = finer
        way = np.sign(arc - place) * (ahead[1] - unknowns)
        tangent = way / equations.metric.length(equations.reduced(solution, way))
        guess = replace(point, solution=solution, unknowns=unknowns, tangent=tangent)
        trial = equations.correct_along(guess, tangent, 0.0, unknowns, ENOUGH)
        if not trial.converged:
            return None
        along = equations.reduced(trial.solution, tangent)
        found, tangent = near(equations, trial.solution, trial.unknowns, along)
        sides.append(
            replace(
                point,
                solution=trial.solution,
                unknowns=trial.unknowns,
                tangent=tangent,
                sign=found.sign,
            )
        )
    a, b = sides
    if point.kind not in _changed(a, b):
        return None
    beside = Beside(equations, a, b)
    root = beside.root(TESTS[point.kind](beside))
    return None if root is None else (beside, root)
