"""Elements reduced to one relation between their nodes: A_e x_e + B_e x_{e+1} + C_e c = d_e.

The equations of the stages of an element, linearised, with the Butcher matrix a_ij and J the
derivatives of F h and g, are

    X_i - sum_j a_ij J_j [V_j, c] = x_0 - rho_i,      J_i [V_i, c] = -rho_i  (algebraic).

States R that follow by integration (`ribbonopt.transcription.collocation.splitting`) are put into
the equations of the rest Q first, so that only K nq unknowns V of an element are solved for:

    X_R = x_0R + E [V, c] - rho_R,                    E_ij = a_ij J_j[R].
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
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
        # Columns everywhere: unknowns of the rest at all stages, constants, first node.
        first, last = K * nq, K * nq + nc
        E = np.empty((N, K + 1, nr, last + nx))
        by_stage = of_R[..., Q].swapaxes(1, 2).reshape(N, 1, nr, first)
        np.multiply(splitting.repeated(nq), by_stage, out=E[..., :first])
        by_constants = of_R[..., lay.nv :].reshape(N, K, nr * nc)
        E[..., first:last] = (coefficients @ by_constants).reshape(N, K + 1, nr, nc)
        E[..., last:] = splitting.starts[R]
        inner, coupling = of_Q[..., Q], of_Q[..., R]
        rates = coupling @ E[:, :K]
        own = np.einsum("eiqip->eiqp", rates[..., :first].reshape(N, K, nq, K, nq))
        own += inner
        rates[..., first:last] += of_Q[..., lay.nv :]
        sums = coefficients @ rates[:, :, :nd].reshape(N, K, nd * (last + nx))
        sums = sums.reshape(N, K + 1, nd, last + nx)
        sums[..., last:] += splitting.starts[splitting.rest_states]
        rows = sums[:, :K] if nq == nd else np.concatenate([sums[:, :K], rates[:, :, nd:]], axis=2)
        matrix = -rows[..., :first].reshape(N, first, first)
        matrix.reshape(N, first**2)[:, :: first + 1] += splitting.diagonal
        sides = rows[..., first:].reshape(N, first, nc + nx)
        step = np.empty((N, nx, last + nx))
        step[:, R], step[:, splitting.rest_states] = E[:, K], sums[:, K]
        by_rest, relation = step[..., :first], step[..., first:]
        by_residuals = self._of_residuals(coupling)
        if only is None:
            self._by_residuals = by_residuals
            inverse = np.asarray(np.linalg.inv(matrix), dtype=float)
            self._to = inverse @ sides
            #: of right-hand sides: the rest, and below what the step makes of it
            self._solution = np.concatenate([inverse, by_rest @ inverse], axis=1)
        else:
            # Less work, if no other residuals come.
            own_sides, end = _sides(by_residuals, only.stages, first)
            sides = np.concatenate([sides, own_sides[..., None]], axis=2)
            solved = np.asarray(np.linalg.solve(matrix, sides), dtype=float)
            self._to, self._share = solved[..., :-1], solved[..., -1]
            self._end = end + times(by_rest, self._share)
        relation += by_rest @ self._to
        self._from_rest = E[:, :K].reshape(N, K * nr, last + nx)
        self._relations = -relation[..., nc:], splitting.identities, -relation[..., :nc]

    @property
    def relations(self) -> tuple[Array, Array, Array]:
        """A (N, nx, nx), B (N, nx, nx) and C (N, nx, nc)."""
        return self._relations

    def reduce(self, residuals: Residuals) -> tuple[Array, Share]:
        """Right-hand sides d (N, nx), and shares: of the rest (N, K nq), residuals of R."""
        of_R = residuals.stages[:, :, self._split.integrated]
        if self._only is not None:
            if residuals.stages is not self._only.stages:
                raise ValueError("these factors are for other residuals of the stages")
            return self._end - residuals.nodes, (self._share, of_R)
        first = len(self._split.diagonal)
        sides, end = _sides(self._by_residuals, residuals.stages, first)
        solved = times(self._solution, sides)
        end += solved[:, first:]
        end -= residuals.nodes
        return end, (solved[:, :first], of_R)

    def expand(self, nodes: Array, constants: Array, share: Share) -> Array:
        """Newton steps of the stages (N, K nv)."""
        split, lay = self._split, self._split.layout
        V, of_R = share
        N, first = V.shape
        found = np.empty((N, first + lay.nc + lay.nx))
        found[:, first : first + lay.nc], found[:, first + lay.nc :] = constants, nodes[:-1]
        np.add(V, times(self._to, found[:, first:]), out=found[:, :first])
        stages = np.empty((N, lay.stages, lay.nv))
        stages[:, :, split.rest] = found[:, :first].reshape(N, lay.stages, split.counts[1])
        integrals = times(self._from_rest, found).reshape(of_R.shape)
        stages[:, :, split.integrated] = integrals - of_R
        return stages.reshape(N, lay.stages * lay.nv)

    def _of_residuals(self, coupling: Array) -> Array:
        """Right-hand sides (N, K nq + nx, K ne) by residuals: of the rest, and of the step."""
        split, R = self._split, self._split.integrated
        (_, nq, nd), (N, K), nv = split.counts, coupling.shape[:2], split.layout.nv
        whole = np.zeros((N, K * nq + split.layout.nx, K, nv))
        rows, step = whole[:, : K * nq].reshape(N, K, nq, K, nv), whole[:, K * nq :]
        of_states = coupling[:, :, :nd].swapaxes(1, 2)
        factors = -split.tableau.coefficients[:, None, :, None]
        rows[:, :, :nd, :, R] = factors[:-1] * of_states[:, None]
        ends = np.zeros((N, nd, K, nv))
        ends[..., R] = factors[-1] * of_states
        step[:, split.rest_states] = ends
        held = np.einsum("eiqiv->eiqv", rows)
        held[:, :, nd:, R] -= coupling[:, :, nd:]
        held[..., split.rest] += np.diag(split.signs)
        return whole.reshape(N, K * nq + split.layout.nx, K * nv)


def _sides(by_residuals: Array, stages: Array, first: int) -> tuple[Array, Array]:
    """Right-hand sides by residuals: (N, K nq) of the rest, (N, nx) of the step but for V."""
    whole = times(by_residuals, stages.reshape(len(stages), -1))
    return whole[:, :first], whole[:, first:]


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
