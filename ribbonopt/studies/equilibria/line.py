"""One number of a scene as it moves: the branches through equilibria of the scene itself.

On the way no tolerance is met and no special point located: what counts is where a branch comes
back to the scene's own value.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field, replace
from functools import cached_property

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import RibbonoptError
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.problem.wellposed.examine import refuse_unreachable
from ribbonopt.scene import ContinuationStage, Scene, validate_scene
from ribbonopt.scene.lens import value_at, with_value
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.coordinates import metric_at, reduced
from ribbonopt.studies.continuation.curve import Curve
from ribbonopt.studies.continuation.ribbons import RibbonEquations
from ribbonopt.studies.continuation.walk.points import Point
from ribbonopt.studies.continuation.walk.tangents import near
from ribbonopt.studies.continuation.walk.walk import Walk

FAR = 8.0  # times what changes the states by as much as they are: range where none is given
LARGEST, FIRST, SMALLEST = 0.35, 0.15, 1e-5  # steps, in the same measure
LEAST = 1e-9  # of that size: beyond the own value, where it may go no further to one side
HALVINGS = 12  # to where a range must end because there is no scene beyond
MOST = 400  # points of one walk
CELL, KNOTS = 0.5, 10  # ranges, in the same measure, on which theta is a polynomial through so many
EXACT = 1e-10  # of theta: what is exact enough on the way


@dataclass(frozen=True, eq=False)
class Cell:
    """Parameters theta on a small range of positions, by the polynomial through some of them.

    Attributes
    ----------
    places, values : (k,) and (k, ntheta) arrays
        Positions, and theta there.
    exact : bool
        Whether it tells theta to what counts on the way.
    """

    places: Array
    values: Array
    exact: bool

    @classmethod
    def of(cls, curve: Curve, low: float, high: float) -> Cell:
        """Read theta at Chebyshev's positions and, as a test, at two others."""
        nodes = np.cos(np.pi * (np.arange(KNOTS) + 0.5) / KNOTS)
        places = (low + high) / 2 + (high - low) / 2 * nodes
        try:
            found = cls(places, np.array([curve.posed_at(place).values for place in places]), True)
            tests = [low + share * (high - low) for share in (0.27, 0.61)]
            off = [np.abs(found.at(x) - curve.posed_at(x).values).max() for x in tests]
        except (RibbonoptError, ArithmeticError, ValueError):  # no scene is there
            return cls(places, np.empty((KNOTS, 0)), False)
        size = float(np.abs(found.values).max())
        return replace(found, exact=bool(max(off) <= EXACT * (1 + size)))

    def at(self, position: float) -> Array:
        """Return theta (ntheta,) at a position, by barycentric weights."""
        away = position - self.places
        if not away.all():
            return np.asarray(self.values[int(np.abs(away).argmin())])
        turns = np.pi * (np.arange(KNOTS) + 0.5) / KNOTS
        weights = (-1.0) ** np.arange(KNOTS) * np.sin(turns) / away
        return np.asarray(weights @ self.values / weights.sum())


@dataclass(frozen=True, eq=False)
class SearchCurve(Curve):
    """A curve on which a given change of the position, its `scale`, counts as one."""

    scale: float = 1.0
    _cells: dict[int, Cell] = field(default_factory=dict)

    @cached_property
    def span(self) -> float:
        """Change of the position that counts as one, and that steps are measured by."""
        return self.scale

    def _theta(self, *positions: float) -> Array:
        """Parameters theta at a position: posing a scene costs as much as a step of Newton's."""
        (position,) = positions
        if self._direct is not None:
            return super()._theta(position)
        number = int(np.floor((position - self.begin) / (CELL * self.scale)))
        if number not in self._cells:
            low = self.begin + number * CELL * self.scale
            self._cells[number] = Cell.of(self, low, low + CELL * self.scale)
        cell = self._cells[number]
        return cell.at(position) if cell.exact else self.posed_at(position).values


@dataclass(frozen=True, eq=False)
class Line:
    """One number that moves, from the scene's own value to both sides.

    Attributes
    ----------
    prepared : Prepared
        The structure.
    curve : Curve
        The scenes by its position, without a tolerance.
    """

    prepared: Prepared
    curve: Curve

    @classmethod
    def of(
        cls,
        prepared: Prepared,
        scene: Scene,
        path: str,
        range_: tuple[float, float] | None,
        first: Solution,
    ) -> Line | None:
        """Return the line of a number at a path; None where it changes nothing.

        `first` is an equilibrium of the scene, by which steps are measured, and the range where
        none is given.
        """
        loose, own = (
            replace(scene, tolerance=None, continuation=None, equilibria=None),
            value_at(scene, path),
        )
        size = _size_of(prepared, loose, path, first)
        if size is None:
            return None
        low, high = range_ or (own - FAR * size, own + FAR * size)
        low, high = (_within(prepared, loose, path, own, end) for end in (low, high))
        size = min(size, (high - low) / 2) or size
        low, high = min(low, own - LEAST * size), max(high, own + LEAST * size)
        stage = ContinuationStage(
            path,
            to=(low, high),
            from_=own,
            first=FIRST * size,
            largest=LARGEST * size,
            smallest=SMALLEST * size,
            points=MOST,
            special=False,
            stability=False,
        )
        return cls(prepared, SearchCurve(loose, stage, scale=size))

    @property
    def own(self) -> float:
        """The scene's own value."""
        return self.curve.begin

    @property
    def name(self) -> str:
        """Path of the number."""
        return self.curve.name

    def equations(self, solution: Solution) -> RibbonEquations:
        """Return the equations of the branches, measured at a solution."""
        return RibbonEquations(self.prepared, self.curve, metric_at(solution, self.curve))

    @property
    def home(self) -> float | None:
        """Zero, where other shapes are known, if it is another value of the range; else None."""
        low, high = sorted((self.curve.start, self.curve.goals[-1]))
        return 0.0 if low < 0.0 < high and self.own != 0.0 else None

    def begun(self, solution: Solution, sign: int, position: float) -> Point[Solution]:
        """Return an equilibrium at a position as the point of a branch that goes to one side.

        LinAlgError where the branch turns at this very value, or others cross.
        """
        search = self.prepared.search(self.curve.posed_at(position))
        on_mesh = search.on_mesh(solution.sheets, solution.mesh, solution.trajectory.ends[1:-1])
        loose = on_mesh.restored(solution.dense.w)
        equations, unknowns = self.equations(loose), np.append(loose.dense.w, position)
        ahead = np.zeros_like(reduced(loose, unknowns))
        ahead[-1] = sign
        found, tangent = near(equations, loose, unknowns, ahead)
        length = self.walk(equations).stepper.first_length(tangent)
        return Point(loose, unknowns, tangent, found.sign, length)

    def walk(self, equations: RibbonEquations) -> Walk[Solution]:
        """Return the means to follow a branch to either end of the range."""
        return Walk(equations, self.curve, 0)

    def points(self, first: Point[Solution]) -> Iterator[Point[Solution]]:
        """Points behind a first one, whatever they are."""
        return self.walk(self.equations(first.solution)).points(first)


def _size_of(prepared: Prepared, scene: Scene, path: str, first: Solution) -> float | None:
    """Return the change of a number that changes the states by as much as they are; None for none.

    At a first equilibrium.
    """
    own = value_at(scene, path)
    step = 1e-3 * max(abs(own), 1e-3)
    stage = ContinuationStage(path, to=(own - step, own + step), from_=own, special=False)
    line = Line(prepared, SearchCurve(scene, stage))
    if not line.curve.moves(prepared.problem):
        return None
    point = line.begun(first, 1, own)
    parts: Array = reduced(first, point.tangent) / line.equations(first).metric.sizes
    states = float(np.linalg.norm(parts[:-1]))
    return abs(float(parts[-1])) / states if states > 0 else None


def _within(prepared: Prepared, scene: Scene, path: str, own: float, end: float) -> float:
    """Return the end of a range, or as far towards it as there are scenes: by halving."""

    def there(value: float) -> bool:
        try:
            refuse_unreachable(prepared.posed(validate_scene(with_value(scene, path, value))))
        except (RibbonoptError, ArithmeticError, ValueError):
            return False
        return True

    if there(end):
        return end
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if there(own + middle * (end - own)) else (low, middle)
    return own + low * (end - own)
