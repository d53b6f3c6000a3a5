"""The branch from a point on, in its phases: where a margin of these vanishes along it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution

from .phases import Change, margins
from .walk.points import Point
from .walk.tangents import near

if TYPE_CHECKING:
    from .ribbons import RibbonEquations

CLOSE, MOST_TRIALS, MOST_SECANTS = 1e-14, 60, 12


class Segment:
    """The branch from a point on in its phases, by arclength along the tangent."""

    def __init__(
        self,
        equations: RibbonEquations,
        a: Point[Solution],
        end: Array,
        solution: Solution | None = None,
    ) -> None:
        self.equations, self.a = equations, a
        gap = equations.reduced(a.solution, end - a.unknowns)
        along = equations.reduced(a.solution, a.tangent)
        self.whole = equations.metric.product(gap, along)
        self.known: dict[float, tuple[Solution, Array]] = {0.0: (a.solution, a.unknowns)}
        if solution is not None:
            self.known[self.whole] = solution, end

    def at(self, arc: float) -> tuple[Solution, Array]:
        """Return the branch at an arclength, from what is known of it near there."""
        if arc not in self.known:
            nearest = sorted(self.known, key=lambda s: abs(s - arc))[:4]
            guess = np.zeros_like(self.a.unknowns)
            if len(nearest) == 1:
                guess = arc * self.a.tangent
            for s in nearest:
                others = [other for other in nearest if other != s]
                weight = float(np.prod([(arc - other) / (s - other) for other in others]))
                guess += weight * self.known[s][1]
            found = self.equations.correct_along(self.a, self.a.tangent, arc, guess)
            if not found.converged:
                raise np.linalg.LinAlgError(f"no point where phases change: {found.message}")
            self.known[arc] = found.solution, found.unknowns
        return self.known[arc]

    def margins(self, arc: float) -> dict[Change, float]:
        """Return the margins at an arclength."""
        return margins(self.at(arc)[0])

    def extrapolated(self, change: Change, arc: float) -> float:
        """Return the arclength where a margin vanishes, by secants from before; near `arc`."""
        before, value = 0.0, self.margins(0.0)[change]
        for _ in range(MOST_SECANTS):
            found = self.margins(arc).get(change, 1.0)
            if abs(found) <= CLOSE or found == value:
                return arc
            following = arc - found * (arc - before) / (found - value)
            if abs(following - arc) <= CLOSE * abs(self.whole):
                return following
            before, value, arc = arc, found, following
        raise np.linalg.LinAlgError("no point where phases change was found")

    def root(self, change: Change) -> float:
        """Return the arclength where a margin vanishes that is negative at the trial."""

        def margin(arc: float) -> float:
            return self.margins(arc).get(change, 1.0)

        return _root(margin, 0.0, self.whole)

    def point(self, arc: float) -> Point[Solution]:
        """Return the point at an arclength."""
        solution, unknowns = self.at(arc)
        ahead = self.equations.reduced(solution, self.a.tangent)
        found, tangent = near(self.equations, solution, unknowns, ahead)
        return replace(
            self.a,
            solution=solution,
            unknowns=unknowns,
            tangent=tangent,
            sign=found.sign,
            note="",
        )


def _root(f: Callable[[float], float], a: float, b: float) -> float:
    """Return a root by false position with halved weights (Illinois)."""
    fa, fb, whole = f(a), f(b), abs(b - a)
    if fa <= 0:
        return a
    for _ in range(MOST_TRIALS):
        if abs(fb) <= CLOSE or abs(b - a) <= CLOSE * whole:
            break
        c = (a * fb - b * fa) / (fb - fa)
        fc = f(c)
        if fc * fb < 0:
            a, fa = b, fb
        else:
            fa /= 2
        b, fb = c, fc
    return b
