"""Where a branch of ribbons goes at one of its solutions, and the sign of its determinant."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.checks.zero_moment import unseen
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.local import Local, local

from .coordinates import row_of
from .estimating import estimating
from .phases import orientation
from .walk.linearised import Heading

if TYPE_CHECKING:
    from .ribbons import RibbonEquations

SAME = 1e-6  # arclength to what the better scheme finds, up to which its tangent is as good


def linearised(
    equations: RibbonEquations, solution: Solution, unknowns: Array, ahead: Array
) -> Local:
    """Linearise at a solution with a row along the branch."""
    row = row_of(solution, equations.metric.dual(ahead))
    there, unbent = (solution.dense.w, float(unknowns[-1])), equations.unbent(solution)
    try:
        found = local(equations.curve.line(solution), row, *there)
    except np.linalg.LinAlgError:
        rod = equations.rod if unbent else None
        if rod is None:
            raise
        found = local(rod.curve.line(rod.restored(solution, unknowns)), row, *there)
    return replace(found, sign=_sign(equations, solution, found.sign))


def heading(
    equations: RibbonEquations, solution: Solution, unknowns: Array, ahead: Array
) -> Heading:
    """Return where the branch goes, from what estimates the error of a solution if possible."""
    metric = equations.metric
    if not equations.unbent(solution):
        row = row_of(solution, metric.dual(ahead))
        found = estimating(solution, equations.curve, row, float(unknowns[-1]))
        if found is not None and metric.length(found.off) <= SAME:
            return replace(found, sign=_sign(equations, solution, found.sign))
    return linearised(equations, solution, unknowns, ahead)


def _sign(equations: RibbonEquations, solution: Solution, sign: float) -> float:
    """Return the sign of a determinant as it is comparable between layouts; 0 for unknown."""
    if solution.problem.slack:
        # Conditions with slack keep a ribbon in its phases: their zeros are no branch points.
        return 1.0
    # Its determinant would be that of the law's guard.
    told = not (equations.unbent(solution) or unseen(solution, equations.prepared.ribbon.law))
    return orientation(solution.sheets) * sign if told else 0.0
