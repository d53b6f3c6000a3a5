"""Elements reduced to one relation between their nodes: A_e x_e + B_e x_{e+1} + C_e c = d_e.

The equations of the stages of an element, linearised, with the Butcher matrix a_ij and J the
derivatives of F h and g, are

    X_i - sum_j a_ij J_j [V_j, c] = x_0 - rho_i,      J_i [V_i, c] = -rho_i  (algebraic).

States R that follow by integration (`ribbonopt.transcription.collocation.splitting`) are put into
the equations of the rest Q first, so that only K nq unknowns V of an element are solved for:

    X_R = x_0R + E [V, c] - rho_R,                    E_ij = a_ij J_j[R].
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.transcription.residuals import Derivatives, Residuals, Share

from .splitting import Splitting


class StageElimination:
    """Collocation: the stage equations solved for the stages, all elements in one LAPACK call."""

    def __init__(
        self, splitting: Splitting, J: Array, widths: Array, only: Residuals | None = None
    ) -> None:
        self._split, self._only = splitting, only
        lay, R, Q = splitting.layout, splitting.integrated, splitting.rest
        (nr, nq, nd), coefficients = splitting.counts, splitting.tableau.coefficients
        N, K, nx, nc = lay.element_count, lay.stages, lay.nx, lay.nc
        J = J * splitting.scaled(widths)
        of_R, of_Q = J[:, :, R], J[:, :, Q]
        inner, self._coupling = of_Q[..., Q], of_Q[..., R]
        # Columns everywhere: unknowns of the rest at all stages, constants, first node, residuals.
        first, last = K * nq, K * nq + nc
        E = np.empty((N, K + 1, nr, last))
        by_stage = of_R[..., Q].swapaxes(1, 2).reshape(N, 1, nr, first)
        np.multiply(splitting.repeated, by_stage, out=E[..., :first])
        by_constants = of_R[..., lay.nv :].reshape(N, K, nr * nc)
        E[..., first:] = (coefficients @ by_constants).reshape(N, K + 1, nr, nc)
        columns = last + nx + (only is not None)
        rates = np.zeros((N, K, nq, columns))
        np.matmul(self._coupling, E[:, :K], out=rates[..., :last])
        own = np.einsum("eiqip->eiqp", rates[..., :first].reshape(N, K, nq, K, nq))
        own += inner
        rates[..., first:last] += of_Q[..., lay.nv :]
        rates[..., last : last + nx][..., R] = self._coupling
        if only is not None:
            rates[..., -1:] = self._coupling @ -only.stages[:, :, R, None]
        sums = coefficients @ rates[:, :, :nd].reshape(N, K, nd * columns)
        sums = sums.reshape(N, K + 1, nd, columns)
        rows = sums[:, :K] if nq == nd else np.concatenate([sums[:, :K], rates[:, :, nd:]], axis=2)
        matrix = -rows[..., :first].reshape(N, first, first)
        matrix.reshape(N, first**2)[:, :: first + 1] += splitting.diagonal
        sides = rows[..., first:]
        sides[..., nc : nc + nx] += splitting.start
        if only is not None:
            sides[..., -1] += self._own(only.stages)
        sides = sides.reshape(N, first, columns - first)
        if only is None:
            self._inverse: Array = np.asarray(np.linalg.inv(matrix), dtype=float)
            solved = self._inverse @ sides
        else:
            # Less work, if no other residuals come.
            solved = np.asarray(np.linalg.solve(matrix, sides), dtype=float)
        step = np.zeros((N, nx, columns))
        step[:, R, :last], step[:, splitting.rest_states] = E[:, K], sums[:, K]
        self._step = step[..., :first]
        relation = step[..., first:] + self._step @ solved
        self._to, self._share = solved[..., : nc + nx], solved[..., -1]
        self._from_rest = E[:, :K].reshape(N, K * nr, last)
        ones = splitting.identities
        self._relations = -ones - relation[..., nc : nc + nx], ones, -relation[..., :nc]
        self._end = relation[..., -1]

    @property
    def relations(self) -> tuple[Array, Array, Array]:
        """A (N, nx, nx), B (N, nx, nx) and C (N, nx, nc)."""
        return self._relations

    def reduce(self, residuals: Residuals) -> tuple[Array, Share]:
        """Right-hand sides d (N, nx), and shares of the rest (N, K nq) and of R (N, K, nr)."""
        split = self._split
        of_R = -residuals.stages[:, :, split.integrated]
        if self._only is not None:
            if residuals.stages is not self._only.stages:
                raise ValueError("these factors are for other residuals of the stages")
            return self._end - residuals.nodes, (self._share, of_R)
        count, states = len(of_R), split.counts[2]
        rates = self._coupling @ of_R[..., None]
        sums = split.tableau.coefficients @ rates[:, :, :states, 0]
        sides = self._own(residuals.stages)
        sides[:, :, :states] += sums[:, :-1]
        if len(split.own) > states:
            sides[:, :, states:] += rates[:, :, states:, 0]
        V = times(self._inverse, sides.reshape(count, len(split.diagonal)))
        d = times(self._step, V)
        d[:, split.rest_states] += sums[:, -1]
        d -= residuals.nodes
        return d, (V, of_R)

    def expand(self, nodes: Array, constants: Array, share: Share) -> Array:
        """Newton steps of the stages (N, K nv)."""
        split, lay = self._split, self._split.layout
        V, of_R = share
        N, first = V.shape
        found = np.empty((N, first + lay.nc))
        found[:, first:] = constants
        known = np.empty((N, lay.nc + lay.nx))
        known[:, : lay.nc], known[:, lay.nc :] = constants, nodes[:-1]
        np.add(V, times(self._to, known), out=found[:, :first])
        stages = np.empty((N, lay.stages, lay.nv))
        stages[:, :, split.rest] = found[:, :first].reshape(N, lay.stages, split.counts[1])
        integrals = times(self._from_rest, found).reshape(of_R.shape)
        integrals += of_R
        stages[:, :, split.integrated] = integrals + nodes[:-1, None, split.integrated]
        return stages.reshape(N, lay.stages * lay.nv)

    def _own(self, stages: Array) -> Array:
        """Right-hand sides (N, K, nq) of the rest of the equations by residuals of their own."""
        return np.asarray(stages[:, :, self._split.rest] * self._split.signs)


@dataclass(frozen=True, eq=False)
class NothingToEliminate:
    """Shooting: x_{e+1} - Phi_e(x_e, c) relates neighbouring nodes already."""

    derivatives: Derivatives

    @property
    def relations(self) -> tuple[Array, Array, Array]:
        """A = -dPhi/dx, the identities B, and C = -dPhi/dc."""
        step = self.derivatives.stages[:, 0]
        count, nx = step.shape[:2]
        return -step[:, :, :nx], _identities(count, nx), -step[:, :, nx:]

    def reduce(self, residuals: Residuals) -> tuple[Array, Share]:
        """Right-hand sides d (N, nx), and no share."""
        return -residuals.nodes, ()

    def expand(self, nodes: Array, constants: Array, share: Share) -> Array:
        """Return no stages (N, 0)."""
        return np.empty((len(nodes) - 1, 0))


def times(matrices: Array, vectors: Array) -> Array:
    """Products of matrices (n, a, b) with vectors (n, b)."""
    return np.asarray((matrices @ vectors[:, :, None])[:, :, 0])


def _identities(count: int, size: int) -> Array:
    return np.broadcast_to(np.eye(size), (count, size, size))
