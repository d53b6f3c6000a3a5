"""Answers of which no error is known, because their mesh steps over a layer of the law.

They solve the equations at the stages, which is verified; between the stages nobody knows what they
are, and they may be off by percents. That is told beside every such answer.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.accuracy.compared import alone
from ribbonopt.accuracy.estimate import analyse
from ribbonopt.solution.solution import Solution

from .zero_moment import lacks_linearisation


def unknown_bars(solution: Solution) -> list[str]:
    """Say that a converged solution has no bars, where they could be known on a finer mesh."""
    if alone(solution) or lacks_linearisation(solution):
        return []  # no mesh would do
    try:
        if analyse(solution).known:
            return []
    except np.linalg.LinAlgError:
        return ["no error of this answer is known: its equations have no linearisation"]
    off = solution.verification.residual_between_nodes
    remedy = "give a tolerance" if solution.scene.tolerance is None else "lower the tolerance"
    return [
        "no error of this answer is known, it may be off by percents: the mesh steps over a layer "
        f"of the law, and the equations are off by {off:.1e} between the stages; {remedy}, or "
        "take more intervals"
    ]
