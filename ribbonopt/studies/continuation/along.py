"""Errors along a branch: at a given arclength, where those at a given position grow without bound.

At a fold the answer is no function of the parameter, next to it a very steep one: the error of the
answer at that very value is large on any mesh. As a point of the branch it is as exact as others.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.accuracy.estimate import analyse, relative_error
from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.extended import ExtendedSystem
from ribbonopt.solvers.protocols import Factors
from ribbonopt.transcription.residuals import Residuals

from .curve import Curve

NEXT_TO_FOLD = "next to a fold: at this very value of the parameter the error is larger than asked"


@dataclass(frozen=True, eq=False)
class _Bordered:
    """Factors of the equations with the position as an unknown more, and a row along the branch."""

    factors: Factors

    def solve(self, residuals: Residuals) -> Array:
        """Step (nw,) of Newton's method at a given arclength."""
        wider = replace(residuals, conditions=np.append(residuals.conditions, 0.0))
        return self.factors.solve(wider)[:-1]


def error_along(solution: Solution, curve: Curve, position: float, row: Array) -> float:
    """Relative error bound of a solution as a point of a branch; inf where the branch is singular.

    `row` is along the branch: of the states at the points where phases meet, constants, position.
    """
    finer, _ = solution.dense.refined()
    system = ExtendedSystem(curve.line_of(finer), row, 0.0)
    fresh = replace(solution, trajectory=replace(solution.trajectory, found={}))
    try:
        _, derivatives = system.linearize(np.append(finer.w, position), finer.p)
        analyse(fresh, _Bordered(system.factor(derivatives, finer.p)))
    except np.linalg.LinAlgError:
        return np.inf
    return relative_error(fresh)[0]
