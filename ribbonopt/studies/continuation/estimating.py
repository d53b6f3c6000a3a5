"""The better scheme factored once at a point of a branch: for its tangent and for its error.

The estimate of the error is a Newton step of the next better scheme at the given position. With the
position as an unknown more, and a row along the branch, the same factors tell the tangent and the
determinant as that scheme has them: those of the point to within its error.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.accuracy.estimate import Analysis
from ribbonopt.accuracy.improved import Improved, growth_of
from ribbonopt.accuracy.spin import spins
from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.local import local_near

from .coordinates import reduced_in
from .curve import Curve


@dataclass(frozen=True, eq=False)
class Ahead:
    """Where a branch goes at a solution, in its layout.

    Attributes
    ----------
    direction : (nw + 1,) array
        Tangent, of any length.
    sign : float
        Sign of the bordered determinant.
    off : (m,) array
        From the solution to the branch that the better scheme finds, as `coordinates` has it.
    """

    direction: Array
    sign: float
    off: Array


def estimating(solution: Solution, curve: Curve, row: Array, position: float) -> Ahead | None:
    """Return where a branch goes by the better scheme, the step to the estimate left for that.

    `row` is along the branch, of states at the points where phases meet, constants and position.
    None where the error is known already, or cannot be told so.
    """
    dense, known = solution.dense, solution.trajectory.found
    if Analysis in known or spins(solution):
        return None
    finer, split = dense.refined()
    try:
        found, derivatives = local_near(curve.line_of(finer), row, finer.w, position)
        step = found.step_at_position
    except np.linalg.LinAlgError:
        return None
    conditions = found.residuals.conditions[:-1]
    residuals = replace(found.residuals, conditions=conditions)
    known[Improved] = Improved(finer, split, residuals, step, growth_of(finer, split, derivatives))
    direction = np.append(dense.blocks.of_finer(found.direction[:-1]), found.direction[-1])
    off = reduced_in(finer.blocks.layout, solution.problem, found.step)
    return Ahead(direction, found.sign, off)
