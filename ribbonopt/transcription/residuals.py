"""Residuals and derivatives of a discretised problem, as numbers; shapes as in `structure`."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

Share = tuple[Array, ...]  # what a right-hand side is to the stages of elements


@dataclass(frozen=True, eq=False)
class Residuals:
    """Residuals of one iterate.

    `stages` (N, K, ne): equations of the stages; `nodes` (N, nx): x_{e+1} minus what element e
    makes of its first node; `conditions` (nb,).
    """

    stages: Array
    nodes: Array
    conditions: Array

    def vector(self) -> Array:
        """All residuals in the order of the layout."""
        count = len(self.nodes)
        elements = np.hstack([self.stages.reshape(count, -1), self.nodes])
        return np.concatenate([elements.ravel(), self.conditions])


@dataclass(frozen=True, eq=False)
class Derivatives:
    """Derivative blocks: `stages` (N, K, ne, nv + nc) and `conditions` (nb, (P+1) nx + nc).

    Without stages, `stages` (N, 1, nx, nx + nc) holds the derivatives of an element's step.
    """

    stages: Array
    conditions: Array
