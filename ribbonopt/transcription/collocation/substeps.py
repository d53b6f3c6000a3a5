"""Ends of substeps from known states: their stages improved by fixed-point sweeps.

Each sweep X = x_0 + h A F(X) is worth one order, until the stages stand still.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.transcription.tableaus import Tableau

from .phase_equations import PhaseEquations

MOST_SWEEPS = 40
AWAY = 1e3  # times its smallest change, with which a step ends whose sweeps led away from it
STILL = 4 * np.finfo(float).eps  # change of a sweep: the next would only turn rounding about


def after_substeps(
    equations: PhaseEquations, tableau: Tableau, start: Array, step: Array, v: Array, places: Array
) -> Array:
    """States (k, nx) after steps (k, 1) from states start (k, nx); nan where sweeps lead away.

    `v` (k K, nv) are unknowns to start from at the stages of all steps, at `places`.
    """
    shape, nx = (len(start), tableau.degree, start.shape[1]), start.shape[1]
    X = v[:, :nx].reshape(shape)
    first, before, last = np.full(len(start), np.inf), np.inf, np.inf
    still = STILL * max(1.0, float(np.abs(X).max()))
    for _ in range(MOST_SWEEPS):
        F, v = equations.derivatives(v, places)
        F = F.reshape(shape)
        improved = start[:, None] + step[:, None] * (tableau.matrix @ F)
        changes = np.abs(improved - X).max(axis=(1, 2))
        change, first = float(changes.max()), np.minimum(first, changes)
        # A change passes from position to direction and back in two sweeps.
        if change <= still or (change >= last and change >= before):
            break
        X, before, last = improved, last, change
        x = X.reshape(-1, nx)
        v = x if v.shape[1] == nx else np.hstack([x, v[:, nx:]])
    found = np.asarray(start + step * (tableau.weights @ F))
    found[~(changes <= AWAY * np.maximum(first, still))] = np.nan
    return found
