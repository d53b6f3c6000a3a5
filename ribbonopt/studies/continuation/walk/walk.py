"""Following one branch towards its goals, point after point."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Generic

import numpy as np

from ribbonopt.arrays import Array

from .asked import Range
from .points import FOLD, TURNING, Point, S
from .protocol import Equations
from .steps import DIGITS, Stepper
from .strides import Stride
from .tangents import near

Land = Callable[[Point[S], Stride[S]], Stride[S]]  # a point, and the step from there


@dataclass(frozen=True)
class Ending:
    """How a stage or a branch ended: whether it reached its goal, and in words."""

    reached: bool
    reason: str


class Walk(Generic[S]):
    """One branch of one stage; `ending` says why there are no more points."""

    def __init__(self, equations: Equations[S], range_: Range, direction: int) -> None:
        """Follow a curve; `direction` is +1 or -1, or 0 where either end of it will do."""
        self.equations, self.range, self.direction = equations, range_, direction
        self.stepper = Stepper(equations, range_)
        self.ending = Ending(False, "not begun")
        self.turned: list[tuple[str, float]] = []

    def begin(self, solution: S, unknowns: Array) -> Point[S]:
        """Return the point that a stage begins with, facing its goal."""
        ahead = np.zeros_like(self.equations.reduced(solution, unknowns))
        ahead[-1] = self.direction or 1
        found, tangent = near(self.equations, solution, unknowns, ahead)
        length = self.stepper.first_length(tangent)
        return Point(solution, unknowns, tangent, found.sign, length)

    def points(self, point: Point[S], land: Land[S] | None = None) -> Iterator[Point[S]]:
        """Points after a given one, special points among them; `land` may shorten each step."""
        while True:
            goal = self._goal(point)
            if goal is None:
                return
            step = self.stepper.step(point, goal)
            if step is None:
                self.ending = self._stuck(point)
                return
            step = land(point, step) if land else step
            for found in step.special:
                yield found
                self.note(found)
            point = step.following
            yield point

    def _goal(self, point: Point[S]) -> float | None:
        """Return the position to land on next, None at the end; sets `ending`."""
        start, goals, here = self.range.start, self.range.goals, point.position
        heading = np.sign(point.tangent[-1]) or 1.0
        if self.direction == 0:
            ends = sorted((start, goals[-1]))
            if not ends[0] < here < ends[1]:
                self.ending = Ending(True, f"reached {self._named(here)}")
                return None
            return ends[1] if heading > 0 else ends[0]
        left = [goal for goal in goals if self.direction * (goal - here) > 0]
        if not left:
            self.ending = Ending(True, f"reached {self._named(here)}")
            return None
        if self.direction * (here - start) < -DIGITS * self.range.span:
            self.ending = self._turned_back()
            return None
        return left[0] if heading == self.direction else start - self.direction * self.range.span

    def note(self, point: Point[S]) -> None:
        """Keep where the position turns."""
        if point.kind in TURNING:
            self.turned.append((point.kind, self.range.value(point.position)))

    def _turned_back(self) -> Ending:
        at: dict[str, list[str]] = {}
        for kind, value in self.turned:
            at.setdefault(kind, []).append(f"{value:.8g}")
        curve = "locus" if at.keys() - {FOLD} else "branch"
        name = self.range.name
        where = "; ".join(f"{kind}s at {name} = {', '.join(at[kind])}" for kind in at)
        where = f" ({where})" if where else ""
        return Ending(False, f"the {curve} turned back and left the range{where}")

    def _stuck(self, point: Point[S]) -> Ending:
        return Ending(
            False,
            f"the step fell below {self.range.smallest:.3g} beyond "
            f"{self._named(point.position)}: {self.stepper.trouble}",
        )

    def _named(self, position: float) -> str:
        return f"{self.range.name} = {self.range.value(position):.6g}"
