"""Buckling points on a branch of straight ribbons: the loads of one stage, found once."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ribbonopt.checks.zero_moment import SHORTEST, unbent_share
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.solution.solution import Solution

from .curve import Curve

if TYPE_CHECKING:
    from ribbonopt.studies.buckling.buckling import Buckling

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

    def nearest(self, straight: Solution, value: float) -> Buckling:
        """Return the one that is nearest to a value of the parameter."""
        return min(self.loads(straight), key=lambda one: abs(one.value - value))
