"""What the rows of one scene are read from: its solution, its branch, its buckling loads.

Each is computed when the first row asks for it, and once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

from ribbonopt.classes import dataclass
from ribbonopt.errors import ConvergenceError
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import Scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.buckling.buckling import buckling_loads
from ribbonopt.studies.buckling.found import Buckling
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.walk.points import Point

from .measured import NoAnswerError


@dataclass(frozen=True, eq=False)
class Branch:
    """A scene's branches, followed to their ends."""

    continuation: Continuation
    points: Sequence[Point[Solution]]

    def of_kind(self, kind: str) -> list[Point[Solution]]:
        """Return the special points of a kind, in the order in which they were found."""
        return [point for point in self.points if point.kind == kind]

    def parameter(self, point: Point[Solution]) -> str:
        """Return the path of the number that the stage of a point moves."""
        return self.continuation.stages[point.stage].moved


@dataclass(frozen=True, eq=False)
class Answers:
    """The answers of one scene."""

    scene: Scene

    @cached_property
    def solution(self) -> Solution:
        """Its equilibrium; NoAnswerError where none is verified."""
        try:
            found = solve(replace(self.scene, continuation=None))
        except ConvergenceError as error:
            raise NoAnswerError(str(error)) from None
        if not found.verified:
            raise NoAnswerError(found.message)
        return found

    @cached_property
    def branch(self) -> Branch:
        """Its branches; NoAnswerError where one ends short of its goal."""
        continuation = Continuation(self.scene)
        try:
            points = list(continuation)
        except ConvergenceError as error:
            raise NoAnswerError(str(error)) from None
        if not continuation.ending.reached:
            raise NoAnswerError(f"the goal was not reached: {continuation.ending.reason}")
        return Branch(continuation, points)

    @cached_property
    def buckling(self) -> tuple[Buckling, ...]:
        """The buckling loads in the range of its `continuation`, of whose first stage."""
        stage = Continuation(self.scene).stages[0]
        assert stage.from_ is not None and isinstance(stage.to, float)
        try:
            return buckling_loads(self.scene, stage.moved, stage.from_, stage.to)
        except ConvergenceError as error:
            raise NoAnswerError(str(error)) from None
