"""Folds and branch points between two points of a branch, located to rounding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.extended import Local

from .corrector import Corrector
from .points import BRANCH_POINT, FOLD, Point, near, reduced

CLOSE = 1e-11  # of an arclength, relative to that between the points
MOST_TRIALS = 60
ENOUGH = 1e-10  # next to a singular point rounding leaves no smaller steps
NEIGHBOURS = 4
BESIDE = (0.0, 1e-12, 1e-10, 1e-8)  # arclength from a point where equations are nearly singular
NEARLY, SMALL = 1e-2, 1e-6  # of a test function, relative to its values beside the point


@dataclass(frozen=True, eq=False)
class Trial:
    """A point at an arclength beyond another, and the linearised equations there."""

    arc: float
    solution: Solution
    position: float
    near: Local
    tangent: Array


def special_points(corrector: Corrector, a: Point, b: Point) -> list[Point]:
    """Return folds and branch points between two points of one layout, by arclength."""
    search = _Between(corrector, a, b)
    found = []
    if a.tangent[-1] * b.tangent[-1] < 0:
        found.append(search.located(FOLD, lambda trial: float(trial.tangent[-1])))
    if a.sign * b.sign < 0:
        origin = search.at(0.0).near.log
        found.append(
            search.located(
                BRANCH_POINT, lambda trial: trial.near.sign * float(np.exp(trial.near.log - origin))
            )
        )
    points = [point for point in found if point is not None]
    return sorted(points, key=lambda point: corrector.metric.length(_gap(a, point)))


def null_direction(corrector: Corrector, point: Point) -> Array:
    """Return the unit direction [dw, dl] of the branch that crosses at a branch point.

    Across the tangent of the branch itself, in the metric of the branch.
    """
    metric, curve = corrector.metric, corrector.curve
    ahead = reduced(point.solution, point.tangent)
    direction = point.tangent
    for offset in BESIDE:
        unknowns = point.unknowns + offset * point.tangent
        position = float(unknowns[-1])
        solution = corrector.beside(point.solution, position).restored(unknowns[:-1])
        try:
            found, _ = near(curve, metric, solution, position, ahead)
        except np.linalg.LinAlgError:  # singular to the last digit
            continue
        # Singular to rounding, or nearly: what any side gives is the null direction.
        direction = found.solve(_side(found))
        break
    direction = (
        direction - metric.product(reduced(point.solution, direction), ahead) * point.tangent
    )
    part = reduced(point.solution, direction) / metric.sizes
    # One of the two ways, the same in every run.
    sign = np.sign(part[np.abs(part).argmax()])
    return np.asarray(sign * direction / np.linalg.norm(part))


@dataclass(frozen=True, eq=False)
class _Between:
    """Points between two points of a branch."""

    corrector: Corrector
    a: Point
    b: Point
    known: dict[float, Array] = field(default_factory=dict)  # [w, l] by arclength

    def at(self, arc: float) -> Trial:
        """Return the branch at an arclength beyond the first point; LinAlgError for none."""
        corrector, a = self.corrector, self.a
        attempts, position = corrector.along(a, a.tangent, arc, self._between(arc), ENOUGH)
        if attempts.best is None or not attempts.best.status.converged:
            raise np.linalg.LinAlgError("no point of the branch was found")
        self.known[arc] = np.append(attempts.best.dense.w, position)
        solution = attempts.best
        ahead = reduced(solution, a.tangent)
        found, tangent = near(corrector.curve, corrector.metric, solution, position, ahead)
        return Trial(arc, solution, position, found, tangent)

    def bridged(self, arc: float, beside: Trial) -> Trial:
        """Return the branch at an arclength from known points next to it alone."""
        unknowns = self._between(arc)
        position = float(unknowns[-1])
        solution = self.corrector.beside(beside.solution, position).restored(unknowns[:-1])
        return replace(beside, arc=arc, solution=solution, position=position)

    def _between(self, arc: float) -> Array:
        """Interpolate [w, l] by a polynomial through the nearest points that are known.

        Next to a singular point Newton's method needs a guess that is this near.
        """
        known = {0.0: self.a.unknowns, self.whole: self.b.unknowns} | self.known
        nearest = sorted(known, key=lambda s: abs(s - arc))[:NEIGHBOURS]
        guess = np.zeros_like(self.a.unknowns)
        for s in nearest:
            others = [other for other in nearest if other != s]
            guess += known[s] * float(np.prod([(arc - other) / (s - other) for other in others]))
        return guess

    @property
    def whole(self) -> float:
        """Arclength from the first to the second point, along the first tangent."""
        metric = self.corrector.metric
        return metric.product(_gap(self.a, self.b), reduced(self.a.solution, self.a.tangent))

    def located(self, kind: str, test: Callable[[Trial], float]) -> Point | None:
        """Return the point where a test function vanishes, None where it does not."""
        try:
            trial = _root(self, test, self.whole)
        except np.linalg.LinAlgError:
            return None
        if trial is None or not trial.solution.verified:
            return None
        return replace(
            self.a,
            solution=trial.solution,
            position=trial.position,
            tangent=trial.tangent,
            kind=kind,
        )


def _root(search: _Between, test: Callable[[Trial], float], high: float) -> Trial | None:
    """Find a root by false position with halved weights (Illinois); None for a pole."""
    a, b = search.at(0.0), search.at(high)
    fa, fb = test(a), test(b)
    largest = max(abs(fa), abs(fb))
    if fa * fb > 0:
        return None
    best, fbest = (a, fa) if abs(fa) < abs(fb) else (b, fb)
    for _ in range(MOST_TRIALS):
        if abs(b.arc - a.arc) <= CLOSE * high or fbest == 0:
            break
        arc = (a.arc * fb - b.arc * fa) / (fb - fa)
        try:
            trial = search.at(arc)
        except np.linalg.LinAlgError:
            # Too near to the singular point for Newton's method, so that neighbours tell it well.
            return search.bridged(arc, best) if abs(fbest) < NEARLY * largest else None
        f = test(trial)
        settled = abs(trial.arc - best.arc) <= CLOSE * high
        best, fbest = trial, f
        if settled:
            break
        if f * fb < 0:
            a, fa = b, fb
        else:
            fa /= 2
        b, fb = trial, f
    return best if abs(fbest) < SMALL * largest else None


def _side(found: Local) -> Array:
    """Return a right-hand side with a share of every condition, and none of the row."""
    count = len(found.residuals.conditions)
    return np.append(np.cos(np.arange(1.0, count)), 0.0)


def _gap(a: Point, b: Point) -> Array:
    return reduced(a.solution, b.unknowns - a.unknowns)
