"""One stage of a scene's continuation: where it begins, its equations, and what is refused."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.solution.solution import Solution

from .coordinates import metric_at
from .curve import Curve
from .recorded import Recorder
from .ribbons import RibbonEquations
from .stage_records import StageRecords


@dataclass(frozen=True, eq=False)
class RibbonStage:
    """One stage; `before` is the solution that the stage before has ended with.

    `near` is one near which the first is looked for, before the automatic start.
    """

    prepared: Prepared
    curve: Curve
    recorder: Recorder
    before: Solution | None = None
    near: Solution | None = None

    @property
    def range(self) -> Curve:
        """Where it goes."""
        return self.curve

    @property
    def ways(self) -> tuple[Curve, ...]:
        """The same in each direction from where it begins."""
        return self.curve.ways

    @property
    def records(self) -> StageRecords:
        """What is recorded of its points."""
        return StageRecords(self.recorder, self.curve)

    @property
    def switch(self) -> int:
        """How deep branches that cross are followed."""
        return int(self.curve.stage.switch)

    @property
    def missing(self) -> str:
        """Nothing: it can begin."""
        return ""

    def first(self) -> tuple[Solution, Array]:
        """Solve where it begins.

        Raises
        ------
        ConvergenceError
            If no solution is found.
        """
        curve = self.curve
        scene = curve.scene_at(curve.begin)
        guess = self.before or self.near
        found = self.prepared.solve(scene, guess=guess, fallback=self.before is None)
        if not found.verified:
            raise ConvergenceError(
                f"no solution to begin with, at {curve.name} = {curve.stage.from_:g}: "
                f"{found.message}",
                found.status.name.lower(),
            )
        return found, np.append(found.dense.w, curve.begin)

    def equations(self, first: Solution) -> RibbonEquations:
        """Return its equations, with the metric of a stage that begins at a solution."""
        return RibbonEquations(self.prepared, self.curve, metric_at(first, self.curve))


def refuse_idle(curve: Curve, problem: BoundaryValueProblem) -> None:
    """Raise a ModelError where the parameter changes nothing."""
    if not curve.moves(problem):
        raise ModelError(
            f"continuation.parameter: {curve.name} changes nothing in this scene; "
            "continue a number that its equations contain",
            "continuation.parameter",
        )
