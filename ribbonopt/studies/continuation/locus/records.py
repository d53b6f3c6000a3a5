"""What is recorded of the points of a locus, and that it ends where l1 leaves its range."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ribbonopt.plain import Row
from ribbonopt.solution.solution import Solution

from ..recorded import StageRecords
from ..walk.points import Point
from .laid import Laid
from .surface import Surface

LEFT = "{} has left the range {:g} to {:g}"


class LocusRecords(StageRecords):
    """What is recorded of the points of one locus."""

    @property
    def surface(self) -> Surface:
        """The locus's surface."""
        assert isinstance(self.curve, Surface)
        return self.curve

    def stopped(self, row: Mapping[str, Any]) -> str:
        """Return the condition of the stage that a row meets, "" if none."""
        if self._beyond(row) > 0:
            return LEFT.format(self.surface.other, *self.surface.between)
        return super().stopped(row)

    def margins(self, point: Point[Solution]) -> dict[str, float]:
        """Return how far a point is beyond each condition that is met exactly."""
        row = {self.surface.other: float(point.unknowns[-2])}
        return {**super().margins(point), LEFT: self._beyond(row)}

    def _beyond(self, row: Mapping[str, Any]) -> float:
        low, high = self.surface.between
        value = float(row[self.surface.other])
        return max(value - high, low - value)
