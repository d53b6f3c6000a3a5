"""Two parameters of a scene: the surface of equilibria that a locus is a curve on.

F(w, l1, l2) = 0: branches move l1 at a fixed l2; the position of a locus is l2.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np

from ribbonopt.accuracy.spin import spins
from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.problem import BoundaryValueProblem, Posed
from ribbonopt.scene import ContinuationStage, Scene
from ribbonopt.scene.faults import KeyPath
from ribbonopt.scene.lens import replaced, steps_to, value_at
from ribbonopt.scene.units import Units
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.extended import Line

from ..coordinates import reduced
from ..curve import KEPT, SLOPE, SOME, Curve
from ..walk.metric import Metric
from ..walk.points import Point
from .laid import Laid

SMALLEST = 1e-4  # of the first step


@dataclass(frozen=True, eq=False)
class Surface(Curve):
    """One locus stage: its range in l2 as of any curve, and the scenes by (l1, l2).

    `stage.between`, the range of l1, is given. Where one position is asked for, l1 is that of the
    scene.
    """

    @property
    def count(self) -> int:
        """Number of positions."""
        return 2

    @property
    def ways(self) -> tuple[Surface, ...]:
        """The surface in each direction that is followed from where the locus begins."""
        if not isinstance(self.stage.to, tuple):
            return (self,)
        back = replace(self.stage, to=self.stage.to[::-1])
        return Surface(self.scene, back, self.units), self

    @property
    def rounds(self) -> bool:
        """A locus that closes has nothing more to be found."""
        return True

    @property
    def other(self) -> str:
        """Path of l1."""
        return self.stage.paths[0]

    @cached_property
    def smallest(self) -> float:
        """Change of l2 below which a step is not tried: next to its end nothing is to be seen."""
        return self.stage.smallest or SMALLEST * min(self.span, self.first)

    @cached_property
    def between(self) -> tuple[float, float]:
        """Least and largest l1 of the locus."""
        assert self.stage.between is not None
        a, b = self.stage.between
        return min(a, b), max(a, b)

    @cached_property
    def spans(self) -> tuple[float, float]:
        """Changes of l1 and l2 that count as one."""
        low, high = self.between
        return high - low, self.span

    def moves(self, problem: BoundaryValueProblem) -> bool:
        """Whether the equations of the scene contain l2."""
        l1 = self.between[0]
        ends = ((l1, self.start), (l1, self.goals[-1]))
        first, last = (self.posed_at(*end).values for end in ends)
        return any(problem.contains(int(i)) for i in np.flatnonzero(first != last))

    def positions_of(self, scene: Scene) -> Array:
        """Positions (2,) of a scene on this surface."""
        l1, l2 = (value_at(scene, path) for path in self.stage.paths)
        return np.array([l1, self.position(l2)])

    def error_of(self, point: Point[Solution]) -> float | None:
        """Return the bound of the error of l1 at a point of the locus, relative; None if unknown.

        It is relative to the value of l1, or to what counts as some.
        """
        laid = point.solution.trajectory.found.get(Laid)
        error = point.error if laid is None or point.error is not None else laid.error
        return None if error is None else self.relative_of(error, float(point.unknowns[-2]))

    def relative_of(self, error: float, l1: float) -> float:
        """Return an error of l1 relative to its value."""
        return error / max(abs(l1), SOME * self.spans[0])

    def measure(self, value: float) -> float:
        """Return what the relative error of a value of l1 is relative to."""
        return max(abs(value), SOME * self.spans[0])

    def metric_at(self, solution: Solution, unknowns: Array) -> Metric:
        """Return the metric at a point of the surface, as `coordinates.metric_at` of a branch."""
        sizes = 1 + np.abs(reduced(solution, unknowns, self.count))
        nx = solution.dense.blocks.layout.nx
        # Loads together: one that vanishes by symmetry is as large as the others.
        sizes[2 * nx : -2] = sizes[2 * nx : -2].max(initial=1.0)
        sizes[-2:] = self.spans
        return Metric(sizes)

    def line(self, solution: Solution) -> Line:
        """Return the equations of a solution on this surface, on its mesh and in its phases."""
        return replace(self.line_of(solution.dense), neutral=spins(solution))

    @property
    def _slopes(self) -> tuple[float, ...]:
        return SLOPE * self.spans[0], SLOPE * self.spans[1]

    def _theta(self, *positions: float) -> Array:
        """Parameters theta at (l1, l2)."""
        return self.posed_at(*positions).values

    def posed_at(self, *positions: float) -> Posed:
        """Return the posed scene with l1 and l2, or the l2 alone."""
        if len(positions) == 1:
            positions = value_at(self.scene, self.other), *positions
        if positions not in self._posed:
            if len(self._posed) >= KEPT:
                self._posed.pop(next(iter(self._posed)))
            l1, l2 = positions
            scene, first, second = self._places
            scene = replaced(replaced(scene, first, l1), second, self.value(l2))
            known = next(iter(self._posed.values()), None)
            posed = known.moved(scene, self.units) if known else Posed.of(scene, self.units)
            self._posed[positions] = posed
        return self._posed[positions]

    @cached_property
    def _places(self) -> tuple[Scene, KeyPath, KeyPath]:
        """The scene without its continuation, and the steps to both parameters in it."""
        first, second = (steps_to(self.scene, path) for path in self.stage.paths)
        return replace(self.scene, continuation=None, map=None), first, second


def curve_of(scene: Scene, stage: ContinuationStage, units: Units | None = None) -> Curve:
    """Return the curve that a stage follows: the surface where it is a locus."""
    return (Surface if stage.is_locus else Curve)(scene, stage, units)
