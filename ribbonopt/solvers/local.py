"""The branch near one of its points: the extended equations linearised, and factored once.

Tangent, determinant and null direction come from the same factors; near a solution of another mesh
or scheme, Newton's step too, which is the estimate of that one's error.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.residuals import Derivatives, Residuals

from .condense import factored
from .extended import ExtendedSystem, Line, ScalarCondition

if TYPE_CHECKING:
    from .protocols import Condensed


@dataclass(frozen=True, eq=False)
class Local:
    """The branch near one of its points: the extended Jacobian, factored.

    Attributes
    ----------
    factors, residuals : Condensed, Residuals
        Factors, and the residuals they are for; all zero at a solution.
    step : (nw + k,) array
        Newton's step with row . dy = 0; zero at a solution.
    direction : (nw + k,) array
        Tangent [dw, dl] with row . dy = 1.
    sign, log : float
        Sign and logarithm of the determinant, comparable between points of one layout and rows
        that point the same way along the branch: it vanishes at branch points, not at folds.
    """

    factors: Condensed
    residuals: Residuals
    step: Array
    direction: Array
    sign: float
    log: float

    def solve(self, rows: Array) -> Array:
        """Solve the extended Jacobian for right-hand sides in the conditions (nb + k,) alone."""
        return _solved(self.factors, self.residuals, self.step, rows)

    def kernel(self) -> Array:
        """Solve for a right-hand side with a share of every condition, and none of the row.

        Next to a branch point that is the null direction, times much.
        """
        count = len(self.residuals.conditions)
        return self.solve(np.append(np.cos(np.arange(1.0, count)), 0.0))

    @property
    def step_at_position(self) -> Array:
        """Newton's step (nw,) at the same position, where there is one; LinAlgError at a fold."""
        rate = self.direction[-1]
        if rate == 0:
            raise np.linalg.LinAlgError("the branch turns here")
        return np.asarray(self.step[:-1] - (self.step[-1] / rate) * self.direction[:-1])


def local(
    line: Line,
    row: Array,
    w: Array,
    positions: float | Array,
    further: tuple[ScalarCondition, ...] = (),
) -> Local:
    """Linearise at a solution; `row` should point along the branch."""
    system = ExtendedSystem(line, row, 0.0, further)
    p = line.parameters(*np.atleast_1d(positions))
    residuals, derivatives = system.linearize(np.append(w, positions), p)
    none = Residuals(
        np.zeros_like(residuals.stages),
        np.zeros_like(residuals.nodes),
        np.zeros_like(residuals.conditions),
    )
    factors = factored(line.bordered, derivatives, p, none, line.neutral)
    return _local(line, factors, none, np.zeros(len(w) + line.count))


def local_near(
    line: Line,
    row: Array,
    w: Array,
    positions: float | Array,
    further: tuple[ScalarCondition, ...] = (),
) -> tuple[Local, Derivatives]:
    """Linearise near a solution, and tell Newton's step from there; the derivatives too."""
    system = ExtendedSystem(line, row, 0.0, further)
    p = line.parameters(*np.atleast_1d(positions))
    residuals, derivatives = system.linearize(np.append(w, positions), p)
    # The rows say nothing of where along the branch.
    conditions = residuals.conditions.copy()
    conditions[-line.count :] = 0.0
    residuals = replace(residuals, conditions=conditions)
    factors = factored(line.bordered, derivatives, p, residuals, line.neutral)
    return _local(line, factors, residuals, factors.solve(residuals)), derivatives


def _local(line: Line, factors: Condensed, residuals: Residuals, step: Array) -> Local:
    along = np.zeros(len(residuals.conditions))
    along[-1] = 1.0
    direction = _solved(factors, residuals, step, along)
    # A neutral direction leaves the determinant zero all along: it tells nothing.
    told = (0.0, 0.0) if line.neutral else factors.determinant
    return Local(factors, residuals, step, direction, *told)


def _solved(factors: Condensed, residuals: Residuals, step: Array, rows: Array) -> Array:
    """Solve for `rows` in the conditions: factors are for the stages' part of the residuals."""
    wider = replace(residuals, conditions=residuals.conditions - rows)
    return np.asarray(factors.solve(wider) - step)
