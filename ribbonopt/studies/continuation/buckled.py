"""Buckling points on a branch of straight ribbons: the loads of one stage, found once."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.checks.zero_moment import SHORTEST, unbent_share
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.solution.solution import Solution

from .curve import Curve
from .walk.points import BUCKLING, Point
from .walk.protocol import Equations

if TYPE_CHECKING:
    from ribbonopt.studies.buckling.found import Buckling

AMPLITUDE = 1e-5  # of a deflection, relative to the length, that stands for its direction


@dataclass(frozen=True, eq=False)
class StageBuckling:
    """The buckling loads in the range of one stage."""

    prepared: Prepared
    curve: Curve
    _found: list[tuple[Buckling, ...]] = field(default_factory=list)

    def loads(self, straight: Solution) -> tuple[Buckling, ...]:
        """Return the loads, from a straight solution of the stage; none where only a part is so."""
        law = self.prepared.ribbon.law
        if unbent_share(straight, law) < 1 - SHORTEST or law.states:
            return ()
        if not self._found:
            from ribbonopt.studies.buckling.buckling import buckling_from  # few branches need it

            ends = (self.curve.value(p) for p in (self.curve.start, self.curve.goals[-1]))
            self._found.append(buckling_from(self.prepared, straight, self.curve.name, *ends))
        return self._found[0]

    def between(
        self, equations: Equations[Solution], a: Point[Solution], b: Point[Solution]
    ) -> list[Point[Solution]]:
        """Return the buckling points between two straight ones."""
        found, whole = [], b.position - a.position
        for load in self.loads(a.solution):
            position = self.curve.position(load.value)
            if not 0 < (position - a.position) / whole <= 1:
                continue
            trial = equations.correct_at(a.solution, np.append(a.unknowns[:-1], position))
            trial = equations.verified(trial) if trial.converged else trial
            if trial.converged:
                straight = replace(a, solution=trial.solution, unknowns=trial.unknowns)
                found.append(replace(straight, kind=BUCKLING, note=""))
        return found

    def direction(self, attempt: Attempt, point: Point[Solution]) -> Array:
        """Direction (n + 1,) of the deflection at a buckling point; the attempt is beside it."""
        value, loads = self.curve.value(point.position), self.loads(point.solution)
        load = min(loads, key=lambda one: abs(one.value - value))
        bent, straight = (attempt.unknowns(load.guess(a)) for a in (AMPLITUDE, 0.0))
        return np.append(bent - straight, 0.0)
