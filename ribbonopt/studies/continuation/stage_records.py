"""What is recorded of the points of one stage, and the conditions that end it."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

from ribbonopt.classes import dataclass
from ribbonopt.plain import Row
from ribbonopt.solution.solution import Solution

from .curve import Curve
from .frequencies import frequencies
from .recorded import Recorder
from .stops import Stops
from .walk.points import Point


@dataclass(frozen=True, eq=False)
class StageRecords:
    """What is recorded of the points of one stage."""

    recorder: Recorder
    curve: Curve

    def row(self, point: Point[Solution]) -> Row:
        """Return what is recorded of a point."""
        return self.recorder.row(point, self.curve)

    @cached_property
    def stops(self) -> Stops:
        """What ends the stage."""
        return Stops(self.curve.stage)

    def stopped(self, row: Mapping[str, Any]) -> str:
        """Return the condition of the stage that a row meets, "" if none."""
        if not self.stops.conditions:
            return ""
        return self.stops.met(self.recorder.named(row, self.curve.stage))

    def stopped_at(self, kind: str, count: int) -> str:
        """Return what ends the stage at the special point of a kind and number, "" if nothing."""
        return self.stops.met_at(kind, count)

    def margins(self, point: Point[Solution]) -> dict[str, float]:
        """Return how far a point is beyond the conditions on what varies along the branch.

        Counts jump, and bounds of the error are none: conditions on them are met as they come.
        """
        if not self.stops.conditions:
            return {}
        varying = self.recorder.varying(point, self.curve)
        if self.stops.words.intersection(self.recorder.frequencies):
            varying |= frequencies(point.solution, self.curve.stage.modes)
        return self.stops.margins(self.recorder.named(varying, self.curve.stage))
