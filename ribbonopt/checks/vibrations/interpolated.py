"""Modes on the stages of another scheme in the same elements."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array

from ..variation import Variation


def interpolated(modes: Array, given: Variation, wanted: Variation) -> Array | None:
    """Return modes (N, nx + m, k) of one chain by the variables of another; None on other elements.

    Controls are polynomials in each element; scaled as they are by the roots of the weights of
    their stages. States before the elements, and switches that move, stay as they are.
    """
    N, nx, _ = given.form.B.shape
    if len(wanted.form.B) != N:
        return None
    before, after = (v.stages.tableau.nodes for v in (given, wanted))
    (_, K), L, count = given.chain.weight.shape, len(after), modes.shape[2]
    nz = given.stages.z.shape[1]
    own = modes[:, nx : nx + nz * K].reshape(N, K, -1) / np.sqrt(given.chain.weight)[..., None]
    gaps = before[:, None] - before + np.eye(K)
    lagrange = np.array(
        [
            [np.prod(np.delete(t - before, j) / np.delete(gaps[j], j)) for j in range(K)]
            for t in after
        ]
    )
    moved = np.sqrt(wanted.chain.weight)[..., None] * (lagrange @ own)
    rest = modes[:, nx + nz * K :]
    return np.concatenate([modes[:, :nx], moved.reshape(N, nz * L, count), rest], axis=1)
