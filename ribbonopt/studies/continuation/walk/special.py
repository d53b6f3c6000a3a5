"""Folds and branch points between two points of a branch, located to rounding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Generic

import numpy as np

from ribbonopt.arrays import Array

from .points import BRANCH_POINT, FOLD, Point, S
from .protocol import Equations, Linearised
from .tangents import near

CLOSE = 1e-11  # of an arclength, relative to that between the points
MOST_TRIALS = 60
ENOUGH = 1e-10  # next to a singular point rounding leaves no smaller steps
NEIGHBOURS = 4
ASIDE = 1e-3  # of an arclength, relative to that between points that enclose the singular one
NEARLY, SMALL = 1e-2, 1e-6  # of a test function, relative to its values beside the point


@dataclass(frozen=True, eq=False)
class Probe(Generic[S]):
    """A point at an arclength beyond another, and the linearised equations there."""

    arc: float
    solution: S
    unknowns: Array
    near: Linearised
    tangent: Array


def special_points(equations: Equations[S], a: Point[S], b: Point[S]) -> list[Point[S]]:
    """Return folds and branch points between two points of one layout, by arclength."""
    search = _Between(equations, a, b)
    found = []
    if a.tangent[-1] * b.tangent[-1] < 0:
        found.append(search.located(FOLD, lambda probe: float(probe.tangent[-1])))
    if a.sign * b.sign < 0:
        origin = search.at(0.0).near.log
        found.append(
            search.located(
                BRANCH_POINT, lambda probe: probe.near.sign * float(np.exp(probe.near.log - origin))
            )
        )
    points = [point for point in found if point is not None]
    return sorted(points, key=lambda point: equations.metric.length(search.gap(point)))


@dataclass(frozen=True, eq=False)
class _Between(Generic[S]):
    """Points between two points of a branch."""

    equations: Equations[S]
    a: Point[S]
    b: Point[S]
    known: dict[float, Array] = field(default_factory=dict)  # unknowns by arclength

    def at(self, arc: float) -> Probe[S]:
        """Return the branch at an arclength beyond the first point; LinAlgError for none."""
        equations, a = self.equations, self.a
        trial = equations.correct_along(a, a.tangent, arc, self._between(arc), ENOUGH)
        if not trial.converged:
            raise np.linalg.LinAlgError("no point of the branch was found")
        self.known[arc] = trial.unknowns
        ahead = equations.reduced(trial.solution, a.tangent)
        found, tangent = near(equations, trial.solution, trial.unknowns, ahead)
        return Probe(arc, trial.solution, trial.unknowns, found, tangent)

    def bridged(self, arc: float, beside: Probe[S]) -> Probe[S]:
        """Return the branch at an arclength from known points next to it alone."""
        unknowns = self._between(arc)
        solution = self.equations.restored(beside.solution, unknowns)
        return replace(beside, arc=arc, solution=solution, unknowns=unknowns)

    def _between(self, arc: float) -> Array:
        """Interpolate the unknowns by a polynomial through the nearest points that are known.

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
        along = self.equations.reduced(self.a.solution, self.a.tangent)
        return self.equations.metric.product(self.gap(self.b), along)

    def gap(self, point: Point[S]) -> Array:
        """Coordinates of the way from the first point to another."""
        return self.equations.reduced(self.a.solution, point.unknowns - self.a.unknowns)

    def located(self, kind: str, test: Callable[[Probe[S]], float]) -> Point[S] | None:
        """Return the point where a test function vanishes, None where it does not."""
        try:
            probe = _root(self, test, self.whole)
        except np.linalg.LinAlgError:
            return None
        if probe is None:
            return None
        return replace(
            self.a,
            solution=probe.solution,
            unknowns=probe.unknowns,
            tangent=probe.tangent,
            kind=kind,
            note="",
        )


def _root(search: _Between[S], test: Callable[[Probe[S]], float], high: float) -> Probe[S] | None:
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
            probe = search.at(arc)
        except np.linalg.LinAlgError:
            if abs(fbest) < NEARLY * largest:
                # Too near to the singular point for Newton's method, so neighbours tell it well.
                return search.bridged(arc, best)
            probe = search.at(arc + ASIDE * (b.arc - a.arc))  # singular to the last digit at once
        f = test(probe)
        settled = abs(probe.arc - best.arc) <= CLOSE * high
        best, fbest = probe, f
        if settled:
            break
        if f * fb < 0:
            a, fa = b, fb
        else:
            fa /= 2
        b, fb = probe, f
    return best if abs(fbest) < SMALL * largest else None
