"""A square problem whose parameters depend on k positions, which are k more unknowns.

    F(w, p(l1 .. lk)) = 0,    g2 = ... = gk = 0,    row . y = value,

y = [x at the points, c, l1 .. lk]. The last equation says which point of the curve is meant: a
position itself (natural continuation), or the projection on the tangent (pseudo-arclength
continuation, after Keller), regular at folds too. A branch is followed along one position, k = 1;
a locus along more, with conditions g that tell it. States at the ends and constants determine the
whole solution; so they stand for it in rows. The extended system has the structure of the original
with k more constants and k more conditions, and is factored by the same code.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Protocol

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.residuals import Derivatives, Residuals

from .condense import factored

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Blocks

    from .protocols import Condensed


@dataclass(frozen=True, eq=False)
class Line:
    """A problem along a line of parameters, or a surface of them.

    Attributes
    ----------
    blocks : Blocks
        The problem, discretised.
    parameters : function of floats
        Parameters p = [theta, widths] at the positions l1 .. lk.
    step : float or k floats
        Half the distance of the positions that derivatives by l are taken from; of each its own,
        where they differ in size.
    count : int
        Number k of positions.
    neutral : bool
        Whether one direction is known to change nothing, so that steps shall leave it alone.
    """

    blocks: Blocks
    parameters: Callable[..., Array]
    step: float | tuple[float, ...]
    count: int = 1
    neutral: bool = False

    def split(self, extended: Array) -> tuple[Array, Array]:
        """Return w and the positions (k,) of [w, l]."""
        return extended[: -self.count], extended[-self.count :]

    def at_points(self, w: Array) -> Array:
        """States at all points, one after another, and constants: y without its positions."""
        return w[self.blocks.layout.condition_columns]

    def reduced(self, extended: Array) -> Array:
        """Return y of [w, l]."""
        w, positions = self.split(extended)
        return np.concatenate([self.at_points(w), positions])

    def slope(self, w: Array, *positions: float, by: int = 0) -> tuple[Array, Array]:
        """Return derivatives by a position of what `Blocks.values` gives, by central differences.

        Parameters
        ----------
        w
            Unknowns (nw,).
        *positions
            Where, l1 .. lk.
        by
            Index of the position that moves.
        """
        values = []
        step = self.step[by] if isinstance(self.step, tuple) else self.step
        for sign in (1, -1):
            moved = list(positions)
            moved[by] += sign * step
            values.append(self.blocks.values(w, self.parameters(*moved)))
        stages, conditions = ((a - b) / (2 * step) for a, b in zip(*values, strict=True))
        return stages, conditions

    @property
    def bordered(self) -> Blocks:
        """The blocks with k more constants and conditions: to eliminate, not to evaluate."""
        blocks = self.blocks
        for _ in range(self.count):
            blocks = blocks.bordered
        return blocks


class ScalarCondition(Protocol):
    """A scalar condition besides the equations, such as a test function."""

    def value(self, extended: Array) -> float:
        """Return its value at [w, l]."""

    def row(self, extended: Array) -> Array:
        """Return its derivatives by y."""


@dataclass(frozen=True, eq=False)
class ExtendedSystem:
    """The equations on a line with `row . y = value`; unknowns [w, l], a system for Newton.

    `further` are the k - 1 conditions besides.
    """

    line: Line
    row: Array
    value: float
    further: tuple[ScalarCondition, ...] = ()

    def __post_init__(self) -> None:
        """Count: ValueError where positions and conditions do not fit."""
        if self.line.count != 1 + len(self.further):
            raise ValueError(
                f"further: found {len(self.further)} conditions, expected {self.line.count - 1}, "
                "one less than there are positions"
            )

    def build(self) -> None:
        """Build the functions now rather than at the first evaluation."""
        self.line.blocks.build()

    def residuals(self, w: Array, p: Array) -> Residuals:
        """Residuals at [w, l]; p is not used."""
        own, positions = self.line.split(w)
        return self._with_rows(self.line.blocks.residuals(own, self.line.parameters(*positions)), w)

    def linearize(self, w: Array, p: Array) -> tuple[Residuals, Derivatives]:
        """Residuals and derivatives at [w, l]."""
        line, k = self.line, self.line.count
        own, positions = line.split(w)
        residuals, derivatives = line.blocks.linearize(own, line.parameters(*positions))
        rows, columns = derivatives.conditions.shape
        border = np.empty((rows + k, columns + k))
        border[:-k, :-k], border[-1] = derivatives.conditions, self.row
        for i, condition in enumerate(self.further):
            border[rows + i] = condition.row(w)
        wider = [derivatives.stages]
        for i in range(k):
            stages, border[:-k, columns + i] = line.slope(own, *positions, by=i)
            wider.append(stages[..., None])
        stages = np.concatenate(wider, axis=-1)
        return self._with_rows(residuals, w), Derivatives(stages, border)

    def factor(self, derivatives: Derivatives, p: Array) -> Condensed:
        """Factors of the Jacobian; LinAlgError where it is singular."""
        # Of p the elimination reads the widths, which do not depend on l.
        return factored(self.line.bordered, derivatives, p, neutral=self.line.neutral)

    def vector(self, w: Array, p: Array) -> Array:
        """Residuals in the order of the program's constraints, the row's last."""
        return self.residuals(w, p).vector()

    def _with_rows(self, residuals: Residuals, w: Array) -> Residuals:
        off = self.row @ self.line.reduced(w) - self.value
        further = [condition.value(w) for condition in self.further]
        conditions = np.concatenate([residuals.conditions, further, [off]])
        return replace(residuals, conditions=conditions)
