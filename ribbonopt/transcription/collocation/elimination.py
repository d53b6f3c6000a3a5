"""Elements reduced to one relation between their nodes: A_e x_e + B_e x_{e+1} + C_e c = d_e."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.transcription.layout import Layout
from ribbonopt.transcription.residuals import Derivatives, Residuals
from ribbonopt.transcription.tableaus import Tableau


class StageElimination:
    """Collocation: the stage equations solved for the stages, all elements in one LAPACK call."""

    def __init__(
        self,
        layout: Layout,
        tableau: Tableau,
        J: Array,
        widths: Array,
        only: Residuals | None = None,
    ) -> None:
        lay, t = layout, tableau
        N, K, nx, nv = lay.element_count, lay.stages, lay.nx, lay.nv
        h = widths[:, None, None, None]
        dynamic = h * J[:, :, :nx]
        # Rows (i, equation), columns (j, unknown): identity - h a_ij dF_j, algebraic rows as are.
        M = np.zeros((N, K, nv, K, nv))
        M[:, :, :nx] = -np.einsum("ij,ejxv->eixjv", t.matrix, dynamic[..., :nv])
        i = np.arange(K)[:, None]
        x = np.arange(nx)
        M[:, i, x, i, x] += 1
        if nv > nx:
            j = np.arange(K)
            M[:, j, nx:, j] = np.moveaxis(J[:, :, nx:, :nv], 0, 1)
        matrix = M.reshape(N, K * nv, K * nv)
        # Stages from the node, the constants, and for given residuals.
        sides = np.zeros((N, K, nv, nx + lay.nc + 1))
        sides[:, :, x, x] = 1
        sides[:, :, :nx, nx:-1] = np.einsum("ij,ejxc->eixc", t.matrix, dynamic[..., nv:])
        sides[:, :, nx:, nx:-1] = -J[:, :, nx:, nv:]
        if only is None:
            self._inverse: Array = np.asarray(np.linalg.inv(matrix), dtype=float)
            solved = self._inverse @ sides.reshape(N, K * nv, -1)
        else:
            # A third of the work, if no other residuals come.
            sides[..., -1] = -only.stages
            solved = np.asarray(np.linalg.solve(matrix, sides.reshape(N, K * nv, -1)), dtype=float)
        self._to_node, self._to_constants = solved[:, :, :nx], solved[:, :, nx:-1]
        self._share, self._only = solved[:, :, -1], only
        # x_{e+1} = x_e + h sum b_j (dF_j . stages + dF_j/dc . c).
        weighted = t.weights[:, None, None] * dynamic
        self._step = weighted[..., :nv].swapaxes(1, 2).reshape(N, nx, K * nv)
        A = -(np.eye(nx) + self._step @ self._to_node)
        C = -(weighted[..., nv:].sum(axis=1) + self._step @ self._to_constants)
        self._relations = A, _identities(N, nx), C

    @property
    def relations(self) -> tuple[Array, Array, Array]:
        """A (N, nx, nx), B (N, nx, nx) and C (N, nx, nc)."""
        return self._relations

    def reduce(self, residuals: Residuals) -> tuple[Array, Array]:
        """Right-hand sides d (N, nx), and the stages (N, K nv) if nodes and constants stay."""
        if self._only is None:
            share = times(self._inverse, -residuals.stages.reshape(len(self._inverse), -1))
        elif residuals.stages is self._only.stages:
            share = self._share
        else:
            raise ValueError("these factors are for other residuals of the stages")
        return times(self._step, share) - residuals.nodes, share

    def expand(self, nodes: Array, constants: Array, share: Array) -> Array:
        """Newton steps of the stages (N, K nv)."""
        return share + times(self._to_node, nodes[:-1]) + self._to_constants @ constants


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

    def reduce(self, residuals: Residuals) -> tuple[Array, Array]:
        """Right-hand sides d (N, nx), and no stages (N, 0)."""
        return -residuals.nodes, np.zeros((len(residuals.nodes), 0))

    def expand(self, nodes: Array, constants: Array, share: Array) -> Array:
        """Return no stages (N, 0)."""
        return share


def times(matrices: Array, vectors: Array) -> Array:
    """Products of matrices (n, a, b) with vectors (n, b)."""
    return np.asarray((matrices @ vectors[:, :, None])[:, :, 0])


def _identities(count: int, size: int) -> Array:
    return np.broadcast_to(np.eye(size), (count, size, size))
