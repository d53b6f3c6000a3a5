"""What any locus answers where the walk asks for what only branches have."""

from __future__ import annotations

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution

from ..walk.departure import Departure
from ..walk.points import Point
from ..walk.protocol import Passage, Trial


class Alone:
    """No branches leave a locus, its phases stay, and each of its points is as exact as asked."""

    def crossings(self, a: Point[Solution], b: Point[Solution]) -> list[Point[Solution]]:
        """Return nothing: `special` tells all."""
        return []

    def uncounted(self, a: Solution, b: Solution, changes: int) -> str:
        """Say nothing of counts, which are those beside the locus."""
        return ""

    def passed(
        self, point: Point[Solution], trial: Trial[Solution], expected: Array
    ) -> Passage[Solution] | None:
        """Return nothing: the phases stay."""
        return None

    def leaving(self, point: Point[Solution]) -> list[Point[Solution]]:
        """Return nothing: no branches are followed from a locus."""
        return []

    def departure(self, point: Point[Solution]) -> Departure[Solution] | None:
        """Return nothing, as above."""
        return None

    def finer(self, origin: Solution, unknowns: Array) -> tuple[Solution, Array] | None:
        """Return nothing: each point is as exact as asked."""
        return None

    def enough(self, error: float, position: float) -> bool:
        """Whether an error of l1 is as small as asked."""
        return True

    def elsewhere(self, origin: Point[Solution], position: float) -> Trial[Solution] | None:
        """Return nothing: there is no other way to a point of a locus."""
        return None
