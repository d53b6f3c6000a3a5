"""Curves of few unknowns that the walk follows: all that the protocol asks for, in dense numpy."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ribbonopt.studies.continuation.walk.metric import Metric
from ribbonopt.studies.continuation.walk.points import Point, Special
from ribbonopt.studies.continuation.walk.protocol import Trial
from ribbonopt.studies.continuation.walk.special import special_points

Array = np.ndarray


class Unit(NamedTuple):
    """A layout: all unknowns but the position are in a unit of this size."""

    size: float = 1.0


class DenseLinearised(NamedTuple):
    """A bordered matrix."""

    matrix: Array

    @property
    def direction(self) -> Array:
        return np.linalg.solve(self.matrix, np.eye(len(self.matrix))[-1])

    @property
    def sign(self) -> float:
        return float(np.linalg.slogdet(self.matrix)[0])

    @property
    def log(self) -> float:
        return float(np.linalg.slogdet(self.matrix)[1])

    def kernel(self) -> Array:
        return np.linalg.solve(self.matrix, np.append(np.ones(len(self.matrix) - 1), 0.0))


@dataclass(frozen=True)
class Dense:
    """f(z) = 0 with one equation less than unknowns, z = [w, l1 .. lk], in any units."""

    f: Callable[[Array], Array]
    jacobian: Callable[[Array], Array]
    metric: Metric
    admissible: Callable[[Array], bool] = lambda z: True
    unit_for: Callable[[Array], Unit] | None = None
    other: Callable[[float], Array] | None = None

    def measured(self, solution: Unit) -> "Dense":
        return self

    def reduced(self, solution: Unit, vector: Array) -> Array:
        return np.append(vector[:-1] * solution.size, vector[-1])

    def linearise(self, solution: Unit, unknowns: Array, ahead: Array) -> DenseLinearised:
        units = self.reduced(solution, np.ones(len(unknowns)))
        rows = self.jacobian(self.reduced(solution, unknowns))
        return DenseLinearised(np.vstack([rows, self.metric.dual(ahead)]) * units)

    def heading(self, solution: Unit, unknowns: Array, ahead: Array) -> DenseLinearised:
        return self.linearise(solution, unknowns, ahead)

    def correct_at(self, origin: Unit, guess: Array) -> Trial[Unit]:
        return self._newton(origin, guess, np.eye(len(guess))[-1], guess[-1])

    def correct_along(
        self, origin: Point[Unit], direction: Array, arc: float, guess: Array, enough: float = 0.0
    ) -> Trial[Unit]:
        row = self.metric.dual(self.reduced(origin.solution, direction))
        value = row @ self.reduced(origin.solution, origin.unknowns) + arc
        return self._newton(origin.solution, guess, row, value)

    def special(self, a: Point[Unit], b: Point[Unit]) -> Special[Unit]:
        return special_points(self, a, b)

    def crossings(self, a: Point[Unit], b: Point[Unit]) -> list[Point[Unit]]:
        return []

    def uncounted(self, a: Unit, b: Unit, changes: int) -> str:
        return ""

    def passed(self, point: Point[Unit], trial: Trial[Unit], expected: Array) -> None:
        return None

    def leaving(self, point: Point[Unit]) -> list[Point[Unit]]:
        return []

    def departure(self, point: Point[Unit]) -> None:
        return None

    def finer(self, origin: Unit, unknowns: Array) -> None:
        return None

    def enough(self, error: float, position: float) -> bool:
        return True

    def restored(self, origin: Unit, unknowns: Array) -> Unit:
        return origin

    def verified(self, trial: Trial[Unit]) -> Trial[Unit]:
        return trial

    def finished(self, origin: Point[Unit], trial: Trial[Unit]) -> Trial[Unit]:
        if self.unit_for is None:
            return trial
        z = self.reduced(trial.solution, trial.unknowns)
        unit = self.unit_for(z)
        if unit == trial.solution:
            return trial
        return replace(trial, solution=unit, unknowns=np.append(z[:-1] / unit.size, z[-1]))

    def elsewhere(self, origin: Point[Unit], position: float) -> Trial[Unit] | None:
        if self.other is None:
            return None
        z = self.other(position)
        return self.finished(origin, Trial(Unit(), z, True, "solved anew"))

    def _newton(self, unit: Unit, guess: Array, row: Array, value: float) -> Trial[Unit]:
        z, converged = self.reduced(unit, guess), False
        for _ in range(20):
            try:
                residual = np.append(self.f(z), row @ z - value)
                step = np.linalg.solve(np.vstack([self.jacobian(z), row]), -residual)
            except np.linalg.LinAlgError:
                break
            z = z + step
            converged = bool(np.abs(step).max() <= 1e-13 * (1 + np.abs(z).max()))
            if converged:
                break
        converged = converged and self.admissible(z)
        message = "converged" if converged else "not admissible"
        return Trial(unit, np.append(z[:-1] / unit.size, z[-1]), converged, message)


@dataclass(frozen=True)
class Straight:
    """A range whose position is the parameter itself."""

    start: float
    goals: tuple[float, ...]
    largest: float
    first: float = 0.1
    smallest: float = 1e-6
    special: bool = True
    rounds: bool = False
    most: int = 200
    name: str = "l"

    @property
    def span(self) -> float:
        return abs(self.goals[-1] - self.start)

    def value(self, position: float) -> float:
        return position


@dataclass(frozen=True)
class Plain:
    """Rows of the unknowns, conditions on them: one of points, one that is met exactly."""

    stops: Callable[[Array], bool] = lambda z: False
    beyond: Callable[[Array], float] | None = None
    special: tuple[str, int] = ("", 0)

    def row(self, point: Point[Unit]) -> dict[str, object]:
        return {"z": np.append(point.unknowns[:-1] * point.solution.size, point.position)}

    def stopped(self, row: dict[str, object]) -> str:
        beyond = self.beyond is not None and self.beyond(row["z"]) > 0
        return "z is far" if self.stops(row["z"]) or beyond else ""

    def margins(self, point: Point[Unit]) -> dict[str, float]:
        return {} if self.beyond is None else {"far": self.beyond(self.row(point)["z"])}

    def stopped_at(self, kind: str, count: int) -> str:
        return kind if (kind, count) == self.special else ""


@dataclass(frozen=True)
class DenseStage:
    """A stage of a dense curve that begins at z, or, without one, where the last one ended."""

    curve: Dense
    range: Straight
    begin: Array
    records: Plain = Plain()
    switch: int = 0
    missing: str = ""
    both: bool = False

    @property
    def ways(self) -> tuple[Straight, ...]:
        if not self.both:
            return (self.range,)
        back = replace(self.range, start=self.range.goals[-1], goals=(self.range.start,))
        return back, self.range

    def first(self) -> tuple[Unit, Array]:
        return Unit(), self.begin

    def equations(self, first: Unit) -> Dense:
        return self.curve
