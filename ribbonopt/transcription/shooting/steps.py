"""One-step methods as CasADi functions: where a node goes in one step, and its derivatives.

Phi(x, c, theta, place, h) carries the states x over the relative width h from the relative position
sigma; the place is sigma, and the known fields at all positions where the step reads them. The
derivatives of an explicit method with respect to [x; c] are propagated from stage to stage;
`shooting.implicit` has the implicit methods. (Expanding a step to scalar operations was tried:
values a third slower, derivatives two to three times.)
"""

from __future__ import annotations

from functools import cached_property
from typing import Protocol, TypeVar

import casadi as ca

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.buffered import Mapped
from ribbonopt.transcription.functions import StageFunctions

from .runge_kutta import RungeKutta

Symbol = TypeVar("Symbol", ca.SX, ca.MX)


@dataclass(frozen=True, eq=False)
class Step:
    """Functions with the inputs (x, c, theta, place, h): Phi, and Phi with d Phi / d [x; c]."""

    values: ca.Function
    dense: ca.Function

    @cached_property
    def mapped_values(self) -> Mapped:
        """Any number of steps at once."""
        return Mapped(self.values)

    @cached_property
    def mapped_dense(self) -> Mapped:
        """Any number of steps at once, with their derivatives."""
        return Mapped(self.dense)

    def repeated(self, count: int) -> Step:
        """Return `count` equal steps that share the width h."""
        if count == 1:
            return self
        inputs = step_inputs(self.values)
        inputs[3] = ca.MX.sym("place", 1 + count * (inputs[3].numel() - 1))
        x, c, theta, place, h = inputs
        slope, constants = variables(x, c)
        plain, after = x, x
        for i in range(count):
            rest = [c, theta, shifted(place, (i / count) * h, i, count), h / count]
            plain = self.values(plain, *rest)
            after, jacobian = self.dense(after, *rest)
            slope = jacobian @ ca.vertcat(slope, constants)
        return Step(
            ca.Function("steps", inputs, [plain]),
            ca.Function("steps_dense", inputs, [after, slope]),
        )


class Method(Protocol):
    """A one-step method."""

    @property
    def name(self) -> str:
        """Family, and degree if there are several."""

    @property
    def degree(self) -> int:
        """Number of stages."""

    @property
    def order(self) -> int:
        """Declared order."""

    @property
    def symplectic(self) -> bool:
        """Whether quadratic invariants are kept to rounding."""

    @property
    def places(self) -> tuple[float, ...]:
        """Positions in a step, from 0 to 1, where it reads known fields."""

    @property
    def explicit(self) -> bool:
        """Whether the method serves ordinary differential equations only."""

    def step(self, stage: StageFunctions, nx: int, start: ca.SX) -> Step:
        """Return one step of nx states; `start` is where inner equations for z start."""


@dataclass(frozen=True, eq=False)
class Explicit:
    """Explicit Runge-Kutta steps."""

    tableau: RungeKutta
    symplectic: bool = False
    explicit: bool = True

    @property
    def name(self) -> str:
        """Name of the tableau."""
        return self.tableau.name

    @property
    def degree(self) -> int:
        """Number of stages."""
        return self.tableau.degree

    @property
    def order(self) -> int:
        """Declared order."""
        return self.tableau.order

    @property
    def places(self) -> tuple[float, ...]:
        """Positions of the stages."""
        return tuple(self.tableau.nodes.tolist())

    def step(self, stage: StageFunctions, nx: int, start: ca.SX) -> Step:
        """Return one step of nx states; there is no z to start."""
        x, c, theta, place, h = inputs = stage_inputs(stage, nx, self.degree)
        identity, constants = variables(x, c)
        plain: list[ca.MX] = []
        rates: list[ca.MX] = []
        slopes: list[ca.MX] = []
        t = self.tableau
        for i, (row, node) in enumerate(zip(t.matrix, t.nodes, strict=True)):
            where = [c, theta, shifted(place, node * h, i, self.degree)]
            plain.append(stage.values(_advance(x, h, row, plain), *where))
            rate, jacobian = stage.dense(_advance(x, h, row, rates), *where)
            rates.append(rate)
            slopes.append(jacobian @ ca.vertcat(_advance(identity, h, row, slopes), constants))
        both = [_advance(x, h, t.weights, rates), _advance(identity, h, t.weights, slopes)]
        return Step(
            ca.Function("step", inputs, [_advance(x, h, t.weights, plain)]),
            ca.Function("step_dense", inputs, both),
        )


def stage_inputs(stage: StageFunctions, nx: int, places: int) -> list[ca.MX]:
    """Return symbols x, c, theta, place, h for known fields at a number of places."""
    _, c, theta, _ = stage.inputs
    place = 1 + places * stage.known
    sizes = {"x": nx, "c": c.numel(), "theta": theta.numel(), "place": place, "h": 1}
    return [ca.MX.sym(name, size) for name, size in sizes.items()]


def shifted(place: Symbol, by: Symbol, part: int, parts: int) -> Symbol:
    """Return a place shifted, with one of equal parts of the known fields it has."""
    known = (place.numel() - 1) // parts
    if not known:
        here: Symbol = place + by
        return here
    result: Symbol = ca.vertcat(place[0] + by, place[1 + part * known : 1 + (part + 1) * known])
    return result


def step_inputs(function: ca.Function) -> list[ca.MX]:
    """Return symbols of all inputs of a function."""
    return [ca.MX.sym(f"i{i}", *function.size_in(i)) for i in range(function.n_in())]


def variables(x: ca.MX, c: ca.MX) -> tuple[ca.MX, ca.MX]:
    """Return the derivatives of x and of c with respect to [x; c]."""
    nx, nc = x.numel(), c.numel()
    identity = ca.MX(ca.DM.eye(nx + nc))
    return ca.densify(identity[:nx, :]), ca.densify(identity[nx:, :])


def _advance(start: ca.MX, h: ca.MX, weights: Array, rates: list[ca.MX]) -> ca.MX:
    """Return start + h sum of weights times rates, zero weights left out."""
    total = start
    for weight, rate in zip(weights.tolist(), rates, strict=False):  # an explicit row ends early
        if weight:
            total = total + h * (weight * rate)
    return total
