"""What is recorded of the points of a locus, and that it ends where l1 leaves its range."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.plain import Row
from ribbonopt.solution.solution import Solution

from ..stage_records import StageRecords
from ..walk.points import Point
from .laid import Laid
from .surface import Surface

LEFT = "{} has left the range {:g} to {:g}"


@dataclass(frozen=True, eq=False)
class LocusRecords(StageRecords):
    """What is recorded of the points of one locus.

    Attributes
    ----------
    beside : function of a solution and unknowns (n + 2,)
        The solution of these on the mesh of the other.
    """

    beside: Callable[[Solution, Array], Solution]

    @property
    def surface(self) -> Surface:
        """The locus's surface."""
        assert isinstance(self.curve, Surface)
        return self.curve

    def row(self, point: Point[Solution]) -> Row:
        """Return what is recorded of a point; negative directions are counted beside.

        Of the special point itself one direction is neutral: it is left out of the count.
        """
        row = dict(super().row(point))
        laid = point.solution.trajectory.found.get(Laid)
        if isinstance(laid, Laid) and laid.sides and self.surface.stage.stability:
            row["negative"] = self._least(point, laid.sides)
        return row

    def _least(self, point: Point[Solution], sides: tuple[Array, Array]) -> int | None:
        """Return the least count of negative directions on both sides of a point."""
        from ribbonopt.checks.stability import negative_directions  # builds second derivatives

        counts = [negative_directions(self.beside(point.solution, side)) for side in sides]
        known = [count for count in counts if count is not None]
        return min(known) if len(known) == len(counts) else None

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
