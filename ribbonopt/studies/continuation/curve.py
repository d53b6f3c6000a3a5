"""A parameter of a scene from one value to another: the line that a branch is followed along."""

from __future__ import annotations

from dataclasses import field, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from ribbonopt.accuracy.spin import spins
from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.problem import BoundaryValueProblem, Posed
from ribbonopt.scene import ContinuationStage, Scene
from ribbonopt.scene.faults import KeyPath
from ribbonopt.scene.lens import replaced, steps_to
from ribbonopt.scene.stages import ends_of
from ribbonopt.scene.units import Units
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.extended import Line
from ribbonopt.transcription.structure import Output

from .walk.points import Point

STEPS = 20  # from one end to the other, where the stage says nothing of its steps
SLOPE = 1e-5  # of the span: half the distance that derivatives by the position are taken over
SOME = 0.1  # of the span: what errors of smaller values are relative to
KEPT = 16  # scenes at recent positions


@dataclass(frozen=True, eq=False)
class Curve:
    """One stage of a continuation; the position is the parameter or, for `log`, its logarithm.

    Attributes
    ----------
    scene : Scene
        The scene, in the user's units.
    stage : ContinuationStage
        What is continued; `from_` is given.
    units : Units or None
        What counts as 1 inside, all along the curve; None for what each scene says.
    """

    scene: Scene
    stage: ContinuationStage
    units: Units | None = None
    _posed: dict[Any, Posed] = field(default_factory=dict)

    @property
    def count(self) -> int:
        """Number of positions: one of a branch, two of a locus."""
        return 1

    @cached_property
    def begin(self) -> float:
        """Position where the stage begins."""
        assert self.stage.from_ is not None
        return self.position(self.stage.from_)

    @cached_property
    def start(self) -> float:
        """Position of the end that is not the last: where the stage begins, or goes first."""
        to = self.stage.to
        return self.position(to[0]) if isinstance(to, tuple) else self.begin

    @cached_property
    def goals(self) -> tuple[float, ...]:
        """Positions that must be met exactly, in order; the last is the end."""
        return tuple(
            self.position(value) for value in self.stage.values or ends_of(self.stage)[-1:]
        )

    @property
    def ways(self) -> tuple[Curve, ...]:
        """The curve in each direction that is followed from where it begins."""
        if not isinstance(self.stage.to, tuple):
            return (self,)
        back = replace(self.stage, to=self.stage.to[::-1])
        return Curve(self.scene, back, self.units), self

    @cached_property
    def span(self) -> float:
        """Distance from end to end."""
        return abs(self.goals[-1] - self.start)

    @cached_property
    def largest(self) -> float:
        """Largest change of the position in a step."""
        if self.stage.largest or not self.stage.values:
            return self.stage.largest or max(self.span / STEPS, self.stage.first or 0.0)
        places = (self.start, *self.goals)
        return max(abs(b - a) for a, b in pairwise(places))

    @cached_property
    def first(self) -> float:
        """Change of the position in the first step."""
        return self.stage.first or self.largest

    @cached_property
    def smallest(self) -> float:
        """Change of the position below which a step is not tried."""
        return self.stage.smallest or 1e-6 * min(self.span, self.first)

    @property
    def special(self) -> bool:
        """Whether folds and branch points are located."""
        return self.stage.special

    @property
    def rounds(self) -> bool:
        """A branch that closes has not reached its goal."""
        return False

    @property
    def most(self) -> int:
        """Most points."""
        return self.stage.points

    @property
    def name(self) -> str:
        """Path of the parameter in the scene."""
        return self.stage.moved

    def moves(self, problem: BoundaryValueProblem) -> bool:
        """Whether the equations of the scene contain the parameter."""
        first, last = (self.posed_at(position).values for position in (self.start, self.goals[-1]))
        moving = [int(i) for i in np.flatnonzero(first != last)]
        return any(problem.contains(i) for i in moving)

    def position(self, value: float) -> float:
        """Position of a value of the parameter."""
        return float(np.log10(value)) if self.stage.scale == "log" else value

    def value(self, position: float) -> float:
        """Value of the parameter, exactly that of the scene file where it names one."""
        named = self._named.get(position)
        if named is not None:
            return named
        return float(10**position) if self.stage.scale == "log" else position

    @cached_property
    def _named(self) -> dict[float, float]:
        """Values that the scene file names, by position; the first of those at one position."""
        named = (self.stage.from_, *ends_of(self.stage), *(self.stage.values or ()))
        return {self.position(v): v for v in reversed(named) if v is not None}

    def error_of(self, point: Point[Solution]) -> float | None:
        """Return the bound of the error of a special point's value, relative; None for unknown."""
        return None if point.error is None else self.relative(point.error, point.position)

    def relative(self, error: float, position: float) -> float:
        """Return an error of a position relative to the value there, or to what counts as some."""
        if self.stage.scale == "log":
            return float(np.log(10)) * error
        return error / max(abs(position), SOME * self.span)

    def measure(self, value: float) -> float:
        """Return what the relative error of a value of the parameter is relative to."""
        log = self.stage.scale == "log"
        return abs(value) if log else max(abs(value), SOME * self.span)

    def scene_at(self, *positions: float) -> Scene:
        """Return the scene with the parameter's value at a position."""
        return self.posed_at(*positions).given

    def line(self, solution: Solution) -> Line:
        """Return the equations of a solution along this curve, on its mesh and in its phases."""
        return replace(self.line_of(solution.dense), neutral=spins(solution))

    def line_of(self, dense: Output) -> Line:
        """Return the equations of an output along this curve."""
        layout, known = dense.blocks.layout, dense.known
        widths = dense.blocks.widths(dense.p)
        return Line(
            dense.blocks,
            lambda *positions: layout.parameters(self._theta(*positions), widths, known),
            self._slopes,
            self.count,
        )

    @property
    def _slopes(self) -> float | tuple[float, ...]:
        """Half the distances that derivatives by the positions are taken over."""
        return SLOPE * self.span

    def _theta(self, *positions: float) -> Array:
        """Parameters theta at a position."""
        (position,) = positions
        if self._direct is None:
            return self.posed_at(position).values
        first, entry, scale = self._direct
        theta: Array = first.copy()
        theta[entry] = scale * self.value(position)
        return theta

    @cached_property
    def _direct(self) -> tuple[Array, int, float] | None:
        """Parameters, and which of them is the value times what; None if it is not so simple."""
        ends = self.start, self.goals[-1]
        places = [*ends, 0.3 * ends[0] + 0.7 * ends[1], 0.6 * ends[0] + 0.4 * ends[1]]
        found = np.array([self.posed_at(place).values for place in places])
        values = np.array([self.value(place) for place in places])
        moving = np.flatnonzero((found != found[0]).any(axis=0))
        if len(moving) != 1:
            return None
        entry = int(moving[0])
        largest = int(np.abs(values).argmax())
        scale = float(found[largest, entry] / values[largest])
        return (found[0], entry, scale) if bool((found[:, entry] == scale * values).all()) else None

    def posed_at(self, *positions: float) -> Posed:
        """Return the posed scene with the parameter's value at a position."""
        (position,) = positions
        if position not in self._posed:
            if len(self._posed) >= KEPT:
                self._posed.pop(next(iter(self._posed)))
            scene: Scene = replaced(*self._place, self.value(position))
            known = next(iter(self._posed.values()), None)
            posed = known.moved(scene, self.units) if known else Posed.of(scene, self.units)
            self._posed[position] = posed
        return self._posed[position]

    @cached_property
    def _place(self) -> tuple[Scene, KeyPath]:
        """The scene without its continuation, and the steps to the parameter in it."""
        steps = steps_to(self.scene, self.stage.moved)
        return replace(self.scene, continuation=None, map=None), steps
