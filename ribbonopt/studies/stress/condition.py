"""How much larger the linearised equations make an error: their condition, from kept factors.

An estimate from below, by a few right-hand sides at random: of the largest sum of a row of the
matrix, times the largest change of an unknown by residuals of one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.accuracy.spin import spins
from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.condense import factored
from ribbonopt.transcription.residuals import Derivatives

TRIES = 4


def condition_of(solution: Solution) -> float | None:
    """Return the condition of a solution's equations; infinite if singular.

    None of a minimum, and of what has inequalities.
    """
    problem = solution.problem
    if problem.recovered or not problem.square:
        return None
    dense = solution.dense
    with np.errstate(all="ignore"):
        residuals, derivatives = dense.blocks.linearize(dense.w, dense.p)
        try:
            factors = factored(dense.blocks, derivatives, dense.p, neutral=spins(solution))
        except np.linalg.LinAlgError:
            return float("inf")
        rng, largest = np.random.default_rng(0), 0.0

        def ones(shape: tuple[int, ...]) -> Array:
            return np.asarray(rng.choice((-1.0, 1.0), shape))

        for _ in range(TRIES):
            some = replace(
                residuals,
                stages=ones(residuals.stages.shape),
                nodes=ones(residuals.nodes.shape),
                conditions=ones(residuals.conditions.shape),
            )
            largest = max(largest, float(np.abs(factors.solve(some)).max()))
        found = largest * _largest_row(derivatives)
    return found if np.isfinite(found) else float("inf")


def _largest_row(derivatives: Derivatives) -> float:
    parts = (derivatives.stages, derivatives.conditions)
    return max(float(np.abs(part).sum(axis=-1).max(initial=1.0)) for part in parts)
