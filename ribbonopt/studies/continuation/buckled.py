"""Buckling points on a branch of straight ribbons: the loads of one stage, found once."""

from __future__ import annotations

from dataclasses import field, replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.checks.zero_moment import SHORTEST, unbent_share
from ribbonopt.classes import dataclass
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.solution.solution import Solution

from .curve import Curve
from .relaid import in_other_phases
from .walk.departure import Departure
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

    def departure(
        self, equations: Equations[Solution], point: Point[Solution]
    ) -> Departure[Solution]:
        """Return the deflection at a buckling point, and that point in phases that it needs."""
        value, loads = self.curve.value(point.position), self.loads(point.solution)
        load = min(loads, key=lambda one: abs(one.value - value))
        search = self.prepared.search(self.curve.posed_at(point.position))
        mode, old = load.mode, point.solution
        if mode.pieces is None or not search.needs_phases:
            attempt = search.on_mesh(old.sheets, old.mesh, old.trajectory.ends[1:-1])
            return Departure(_direction(attempt, load), point, point)
        ahead = equations.restored(old, point.unknowns + point.tangent)
        sides, switches = [], mode.trajectory.ends[1:-1]
        for sign in (1, -1):
            kinds = tuple(sign * kind for kind in mode.pieces.kinds)
            attempt, w = in_other_phases(search, old, kinds, switches)
            tangent = np.append(attempt.unknowns(ahead) - w, point.tangent[-1])
            unknowns = np.append(w, point.position)
            straight = replace(point, solution=attempt.restored(w), unknowns=unknowns)
            sides.append(replace(straight, tangent=tangent))
        return Departure(_direction(attempt, load), *sides)


def _direction(attempt: Attempt, load: Buckling) -> Array:
    """Direction (n + 1,) of a deflection, in the layout of an attempt."""
    bent, straight = (attempt.unknowns(load.guess(a)) for a in (AMPLITUDE, 0.0))
    return np.append(bent - straight, 0.0)
