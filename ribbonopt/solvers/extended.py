"""A square problem whose parameters move along a line: the position on it is one more unknown.

    F(w, p(l)) = 0,        row . y = value,        y = [x at the points, c, l].

The second equation says which point of the branch is meant: l itself (natural continuation), or
the projection on the tangent (pseudo-arclength continuation, after Keller), regular at folds too.
States at the ends and constants determine the whole solution; so they stand for it in the row. The
extended system has the structure of the original with one more constant and one more condition, and
is factored by the same code.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.transcription.residuals import Derivatives, Residuals

from .condense import CondensedSystem

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Blocks


@dataclass(frozen=True, eq=False)
class Line:
    """A problem along a line of parameters.

    Attributes
    ----------
    blocks : Blocks
        The problem, discretised.
    parameters : function of float
        Parameters p = [theta, widths] at a position l.
    step : float
        Half the distance of the positions that derivatives by l are taken from.
    """

    blocks: Blocks
    parameters: Callable[[float], Array]
    step: float

    def at_points(self, w: Array) -> Array:
        """States at all points, one after another, and constants: y without its last entry."""
        nodes, _, c = self.blocks.layout.unpack(w)
        return np.concatenate([nodes[list(self.blocks.layout.point_elements)].ravel(), c])

    def slope(self, w: Array, position: float) -> tuple[Array, Array]:
        """Return derivatives by l of what `Blocks.values` gives, by central differences."""
        values = [
            self.blocks.values(w, self.parameters(position + sign * self.step)) for sign in (1, -1)
        ]
        stages, conditions = ((a - b) / (2 * self.step) for a, b in zip(*values, strict=True))
        return stages, conditions


@dataclass(frozen=True, eq=False)
class ExtendedSystem:
    """The equations on a line with `row . y = value`; unknowns [w, l], a system for Newton."""

    line: Line
    row: Array
    value: float

    def build(self) -> None:
        """Build the functions now rather than at the first evaluation."""
        self.line.blocks.build()

    def residuals(self, w: Array, p: Array) -> Residuals:
        """Residuals at [w, l]; p is not used."""
        own = self.line.blocks.residuals(w[:-1], self.line.parameters(w[-1]))
        return self._with_row(own, w)

    def linearize(self, w: Array, p: Array) -> tuple[Residuals, Derivatives]:
        """Residuals and derivatives at [w, l]."""
        blocks = self.line.blocks
        residuals, derivatives = blocks.linearize(w[:-1], self.line.parameters(w[-1]))
        stages, conditions = self.line.slope(w[:-1], w[-1])
        rows, columns = derivatives.conditions.shape
        border = np.empty((rows + 1, columns + 1))
        border[:-1, :-1], border[:-1, -1], border[-1] = derivatives.conditions, conditions, self.row
        wider = np.concatenate([derivatives.stages, stages[..., None]], axis=-1)
        return self._with_row(residuals, w), Derivatives(wider, border)

    def factor(self, derivatives: Derivatives, p: Array) -> CondensedSystem:
        """Factors of the Jacobian; LinAlgError where it is singular."""
        # Of p the elimination reads the widths, which do not depend on l.
        return CondensedSystem(self.line.blocks.bordered, derivatives, p)

    def vector(self, w: Array, p: Array) -> Array:
        """Residuals in the order of the program's constraints, the row's last."""
        return self.residuals(w, p).vector()

    def _with_row(self, residuals: Residuals, w: Array) -> Residuals:
        y = np.append(self.line.at_points(w[:-1]), w[-1])
        off = self.row @ y - self.value
        return replace(residuals, conditions=np.append(residuals.conditions, off))


@dataclass(frozen=True, eq=False)
class Local:
    """The branch near one of its points: the extended Jacobian, factored.

    Attributes
    ----------
    direction : (nw + 1,) array
        Tangent [dw, dl] with row . dy = 1.
    sign, log : float
        Sign and logarithm of the determinant, comparable between points of one layout and rows
        that point the same way along the branch: it vanishes at branch points, not at folds.
    """

    factors: CondensedSystem
    residuals: Residuals
    direction: Array
    sign: float
    log: float

    def solve(self, rows: Array) -> Array:
        """Solve the extended Jacobian for right-hand sides in the conditions (nb + 1,) alone."""
        return self.factors.solve(replace(self.residuals, conditions=-rows))


def local(line: Line, row: Array, w: Array, position: float) -> Local:
    """Linearise at a solution; `row` should point along the branch."""
    system = ExtendedSystem(line, row, 0.0)
    p = line.parameters(position)
    residuals, derivatives = system.linearize(np.append(w, position), p)
    none = Residuals(
        np.zeros_like(residuals.stages),
        np.zeros_like(residuals.nodes),
        np.zeros_like(residuals.conditions),
    )
    # Whatever is solved for later has its right-hand side in the conditions alone.
    factors = CondensedSystem(line.blocks.bordered, derivatives, p, only=none)
    last = none.conditions.copy()
    last[-1] = 1.0
    direction = factors.solve(replace(none, conditions=-last))
    return Local(factors, none, direction, *factors.determinant)
