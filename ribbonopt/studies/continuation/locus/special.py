"""Special points of a locus: cusps, isola centres, crossings, double points and turns.

They are where a test function of `readings` changes its sign from one point to the next, located
like those of branches: from a distance, by the root of a polynomial; then once more on a mesh
twice as fine, which tells the error of both parameters.

Where a locus of folds turns in l2 the surface of equilibria is level in l2. So with the second
derivatives H of l2 on it there is, at a given l2 on one side, no branch and on the other a small
closed one, if H is definite: an isola centre; else two branches cross there.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution

from ..walk.beside import ENOUGH, Probe
from ..walk.points import CROSSING, CUSP, DOUBLE, FOLD, ISOLA, TURN, Point, Special
from .bars import ROUNDING, SAFETY, halved
from .laid import Laid
from .readings import AREA, DETERMINANT, SLOPE, SPEED, Readings
from .roots import AFAR, Apart, from_afar, regular

if TYPE_CHECKING:
    from .equations import LocusEquations

ROUND = 0.5  # least cosine of the angle that the direction in the plane turns by in one step
ASIDE = 0.25  # of a step: on both sides of a special point, between which it is found again
BESIDE = 1e-3  # half the arclength that second derivatives of l2 are taken over
MEETS = {
    DETERMINANT: "a locus of branch points is met",
    AREA: "a locus of folds is met",
    SLOPE: "another locus of branch points is met",
}
DIRECTION = "direction of the locus"


@dataclass(frozen=True, eq=False)
class Root:
    """Where a test function vanishes between two points."""

    equations: LocusEquations
    beside: Apart
    arc: float
    name: str

    @cached_property
    def unknowns(self) -> Array:
        """Unknowns (n + 2,) there: of the locus, or interpolated where that is singular."""
        beside, guess = self.beside, self.beside.unknowns(self.arc)
        if self.equations.kind == FOLD and self.name != DETERMINANT:
            a = beside.a
            trial = self.equations.correct_along(a, a.tangent, self.arc, guess, ENOUGH)
            if trial.converged:
                return trial.unknowns
        return guess


def special_of(
    equations: LocusEquations, a: Point[Solution], b: Point[Solution]
) -> Special[Solution]:
    """Return what is special between two points of a locus, of one layout.

    A test function that changes its sign without a root that is found is named in `unresolved`.
    """
    if len(a.unknowns) != len(b.unknowns):
        return Special([])
    try:
        readings = Readings(equations, a)
        first, last = (readings.signs(p) for p in (a, b))
        names = [name for name, value in first.values.items() if value * last.values[name] < 0]
        if abs(float(first.way @ last.way)) < ROUND:
            return Special([], (DIRECTION,), 1)
        if not names:
            return Special([])
        beside = Apart(equations, a, b)
        roots = {name: _root(beside, readings, name) for name in names}
    except np.linalg.LinAlgError:
        return Special([])
    found = sorted((arc, name) for name, arc in roots.items() if arc is not None)
    points = {name: _point(Root(equations, beside, arc, name)) for arc, name in found}
    # Read from afar alone, and not found again on a finer mesh, a meeting may be anywhere near.
    doubted = {name for name in MEETS if name in points and points[name].error is None}
    lost = [name for name in names if name not in points or name in doubted]
    unresolved = tuple(f"where {MEETS[name]}" if name in MEETS else name for name in lost)
    sure = [point for name, point in points.items() if name not in doubted]
    return Special(sure, unresolved, len(names))


def _root(beside: Apart, readings: Readings, name: str) -> float | None:
    """Return the arclength where a test function vanishes, None where it is not found.

    Where loci meet none is found next to the place: it is read from afar.
    """

    def test(probe: Probe[Solution]) -> float:
        return readings.at(probe.solution, probe.unknowns).values[name]

    if name not in MEETS:
        return regular(beside, test)
    first, last = (readings.at(end.solution, end.unknowns).values[name] for end in beside.ends)
    if name == SLOPE:
        return from_afar(beside, readings.slope, (first, last))
    return from_afar(beside, test, (first, last))


def _point(root: Root) -> Point[Solution]:
    """Return the special point at a root, with its kind and its error."""
    equations, name, place = root.equations, root.name, root.unknowns
    error, note = None, MEETS.get(name, "")
    finer = _finer(root)
    if finer is not None:
        moved = np.abs(finer.unknowns[-2:] - place[-2:])
        moved += finer.beside.doubt * np.abs(finer.beside.tangent(finer.arc)[-2:])
        root, place = finer, finer.unknowns
        # Of both parameters, in units of l1.
        first, second = equations.surface.spans
        off = max(float(moved[0]), float(moved[1]) * first / second)
        error = max(SAFETY * off, ROUNDING * abs(float(place[-2])))
    a = root.beside.a
    solution, tangent = equations.restored(a.solution, place), root.beside.tangent(root.arc)
    nearest = min(root.beside.known.values(), key=lambda probe: abs(probe.arc - root.arc))
    laid = equations.laid(nearest.solution)
    solution.trajectory.found[Laid] = Laid(tangent, laid.across, laid.slope, error=error)
    kind = DOUBLE if name in MEETS else CUSP if name == SPEED else TURN
    if kind == TURN and equations.kind == FOLD:
        kind = _level(equations, replace(a, solution=solution, unknowns=place, tangent=tangent))
    return replace(
        a, solution=solution, unknowns=place, tangent=tangent, kind=kind, note=note, error=error
    )


def _level(equations: LocusEquations, point: Point[Solution]) -> str:
    """Return what is where l2 is level on the surface: ISOLA, CROSSING, or TURN for unknown."""
    chart = Readings(equations, point).chart
    try:
        here = chart.read(point.unknowns)
        rows = []
        for i, tangent in enumerate((here.first, here.second)):
            slopes = []
            for sign in (1, -1):
                place = [0.0, 0.0]
                place[i] = sign * BESIDE
                there = chart.sample(point.unknowns + sign * BESIDE * tangent, *place)
                slopes.append(np.array([there.first[-1], there.second[-1]]))
            rows.append((slopes[0] - slopes[1]) / (2 * BESIDE))
    except np.linalg.LinAlgError:
        return TURN
    (ss, st), (ts, tt) = rows
    return ISOLA if ss * tt - st * ts > 0 else CROSSING


def _finer(root: Root) -> Root | None:
    """Return the root between two points of the locus on a mesh twice as fine."""
    equations, beside = root.equations, root.beside
    aside = 2 * AFAR if root.name in MEETS else ASIDE * beside.whole
    aside = min(aside, beside.reach(root.arc))
    try:
        sides = [_on_halves(equations, beside, root.arc + off) for off in (-aside, aside)]
        readings, again = Readings(equations, sides[0]), Apart(equations, *sides)
        first, last = (readings.at(p.solution, p.unknowns).values[root.name] for p in sides)
        arc = _root(again, readings, root.name) if first * last < 0 else None
    except np.linalg.LinAlgError:
        return None
    return None if arc is None else Root(equations, again, arc, root.name)


def _on_halves(equations: LocusEquations, beside: Apart, arc: float) -> Point[Solution]:
    """Return the point of a locus at an arclength on halved elements; LinAlgError for none."""
    a = beside.a
    trial = equations.correct_along(a, a.tangent, arc, beside.unknowns(arc), ENOUGH)
    if trial.converged:
        finer, y = halved(equations, trial)
        begin = replace(a, solution=finer, unknowns=y)
        trial = equations.correct_along(begin, equations.laid(finer).tangent, 0.0, y, ENOUGH)
    if not trial.converged:
        raise np.linalg.LinAlgError(trial.message)
    tangent = equations.laid(trial.solution).tangent
    ahead = equations.reduced(trial.solution, tangent)
    sign = 1.0 if equations.metric.product(ahead, beside.along) >= 0 else -1.0
    tangent = sign * tangent / equations.metric.length(ahead)
    return replace(a, solution=trial.solution, unknowns=trial.unknowns, tangent=tangent)
