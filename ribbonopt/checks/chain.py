"""Elements of a minimum, linearised one after another: states from the start and the controls.

Shapes: N elements, K stages, nx states, nz controls, n = nx + nz K N independent variables.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.transcription import Tableau


class LinearisedChain:
    """Elements one after another, linearised: all states follow from x_0 and the moments.

    `J` (N, K, 7, 9) are the derivatives of the rates at the stages, `slopes` (N, K, 9) of the cost.
    """

    def __init__(self, J: Array, slopes: Array, widths: Array, tableau: Tableau) -> None:
        (N, K, nv), nx = slopes.shape, J.shape[2]
        nz, size = nv - nx, nx + (nv - nx) * K
        self.nx = nx
        self.J, self.slopes = J, slopes
        self.integral = widths[:, None, None] * tableau.matrix
        self.weight = widths[:, None] * tableau.weights
        M = -np.einsum("eij,ejxy->eixjy", self.integral, J[..., :nx]).reshape(N, K * nx, K * nx)
        self.inverse = np.linalg.inv(M + np.eye(K * nx))
        # Stages [x; z] (N, K, 9, 7 + 2 K) from the variables of their element.
        stages = np.zeros((N, K, nv, size))
        scale = 1 / np.sqrt(self.weight)[..., None, None]
        for j in range(K):
            stages[:, j, nx:, nx + nz * j : nx + nz * (j + 1)] = scale[:, j] * np.eye(nz)
        sides = np.einsum("eij,ejxc->eixjc", self.integral, scale * J[..., nx:])
        starts = np.broadcast_to(np.eye(nx), (N, K, nx, nx))
        sides = np.concatenate([starts, sides.reshape(N, K, nx, -1)], axis=3)
        stages[:, :, :nx] = (self.inverse @ sides.reshape(N, K * nx, -1)).reshape(N, K, nx, -1)
        self.stages = stages
        self.step = np.einsum("ej,ejxs->exs", self.weight, J @ stages)
        self.step[:, :, :nx] += np.eye(nx)
        self.cost = ((self.weight[..., None] * slopes)[:, :, None] @ stages)[:, :, 0].sum(axis=1)
        # Nodes (N + 1, 7, n) from the independent variables.
        self.nodes = np.zeros((N + 1, nx, nx + nz * K * N))
        self.nodes[0, :, :nx] = np.eye(nx)
        for e, step in enumerate(self.step):
            a, b = nx + nz * K * e, nx + nz * K * (e + 1)
            self.nodes[e + 1, :, :a] = step[:, :nx] @ self.nodes[e, :, :a]
            self.nodes[e + 1, :, a:b] = step[:, nx:]
        self.ends = np.vstack([self.nodes[0], self.nodes[-1]])
        self.gradient = np.tensordot(self.cost[:, :nx], self.nodes[:-1], 2)
        self.gradient[nx:] += self.cost[:, nx:].ravel()

    def weights(self, last: Array) -> Array:
        """Return d(Lagrangian)/d(rates, cost) (N, K, 8), from the costate (7,) at the end."""
        after = np.empty((len(self.step), 1, self.nx))
        for e in reversed(range(len(after))):
            after[e, 0] = last
            last = self.cost[e, : self.nx] + last @ self.step[e, :, : self.nx]
        change = self.slopes[..., : self.nx] + (after[:, :, None] @ self.J[..., : self.nx])[:, :, 0]
        change *= self.weight[..., None]
        change = (change.reshape(len(after), 1, -1) @ self.inverse).reshape(change.shape)
        rates = self.weight[..., None] * after + self.integral.swapaxes(1, 2) @ change
        return np.concatenate([rates, self.weight[..., None]], axis=2)

    def hessian(self, H: Array) -> Array:
        """Hessian (n, n) in the independent variables, from those of the stages (N, K, 9, 9)."""
        N, n, nx = len(H), self.nodes.shape[2], self.nx
        V = self.stages.reshape(N, -1, self.stages.shape[3])
        Q = V.swapaxes(1, 2) @ (H @ self.stages).reshape(V.shape)
        nodes = self.nodes[:-1]
        along = Q[:, :, :nx] @ nodes
        result: Array = nodes.reshape(-1, n).T @ along[:, :nx].reshape(-1, n)
        result[nx:] += along[:, nx:].reshape(-1, n)
        result[:, nx:] += along[:, nx:].reshape(-1, n).T
        own = np.zeros((N, V.shape[2] - nx, N, V.shape[2] - nx))
        own[np.arange(N), :, np.arange(N)] = Q[:, nx:, nx:]
        result[nx:, nx:] += own.reshape(n - nx, n - nx)
        return result
