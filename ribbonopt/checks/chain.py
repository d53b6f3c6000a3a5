"""Elements of a minimum, linearised one after another: states from the start and the controls.

Shapes: N elements, K stages, nx states, nz controls. The own variables y of an element are its
controls at the stages, m = nz K numbers, and one more where jumps are given: x_e moves by that many
jumps before the element begins. In all n = nx + m N independent variables [x_0, all y].
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.transcription import Tableau


class LinearisedChain:
    """Elements one after another, linearised: all states follow from x_0 and the controls.

    `J` (N, K, nx, nx + nz) are the derivatives of the rates at the stages, `slopes`
    (N, K, nx + nz) of the cost, `jumps` (N, nx) of the states at the start of each element, which
    cost `prices` (N,).
    Controls are scaled so that the sum of their squares is an integral along the chain, the
    elements of which have `widths` (N,), fractions of its `length`.
    """

    def __init__(
        self,
        J: Array,
        slopes: Array,
        widths: Array,
        tableau: Tableau,
        length: float = 1.0,
        jumps: Array | None = None,
        prices: Array | None = None,
    ) -> None:
        (N, K, nv), nx = slopes.shape, J.shape[2]
        nz = nv - nx
        self.nx = nx
        self.J, self.slopes = J, slopes
        self.integral = widths[:, None, None] * tableau.matrix
        self.weight = widths[:, None] * tableau.weights
        # States on which neither rates nor cost depend (positions) need no equations.
        used = np.flatnonzero(J[..., :nx].any(axis=(0, 1, 2)) | slopes[..., :nx].any(axis=(0, 1)))
        self.used, n = used, len(used)
        between = J[:, :, used[:, None], used]
        M = -np.einsum("eij,ejxy->eixjy", self.integral, between).reshape(N, K * n, K * n)
        self.inverse = np.linalg.inv(M + np.eye(K * n))
        # Stages [x; z] (N, K, nx + nz, nx + m) from the variables of their element.
        stages = np.zeros((N, K, nv, nx + nz * K + (jumps is not None)))
        controls = slice(nx, nx + nz * K)
        scale = 1 / np.sqrt(length * self.weight)[..., None, None]
        for j in range(K):
            stages[:, j, nx:, nx + nz * j : nx + nz * (j + 1)] = scale[:, j] * np.eye(nz)
        stages[:, :, :nx, :nx] = np.eye(nx)
        sides = np.einsum("eij,ejxc->eixjc", self.integral, scale * J[:, :, used, nx:])
        starts = stages[:, :, used, :nx]
        sides = np.concatenate([starts, sides.reshape(N, K, n, -1)], axis=3)
        solved = self.inverse @ sides.reshape(N, K * n, -1)
        stages[:, :, used, : controls.stop] = solved.reshape(sides.shape)
        rest = np.setdiff1d(np.arange(nx), used)
        rates = (J[:, :, rest] @ stages).reshape(N, K, -1)
        stages[:, :, rest] += (self.integral @ rates).reshape(N, K, len(rest), -1)
        self.stages = stages
        if jumps is not None:
            stages[..., -1] = (stages[..., :nx] @ jumps[:, None, :, None])[..., 0]
        self.step = np.einsum("ej,ejxs->exs", self.weight, J @ stages)
        self.step[:, :, :nx] += np.eye(nx)
        if jumps is not None:
            self.step[..., -1] += jumps
        self.cost = ((self.weight[..., None] * slopes)[:, :, None] @ stages)[:, :, 0].sum(axis=1)
        if prices is not None:
            self.cost[:, -1] += prices
        self._sweep()

    def _sweep(self) -> None:
        """Find the derivatives of both ends (2 nx, n) and of the cost (n,) by all variables."""
        N, nx = len(self.step), self.nx
        carried, slope = np.empty((N + 1, nx, nx)), np.zeros((N + 1, nx))
        carried[N] = np.eye(nx)
        for e in reversed(range(N)):
            carried[e] = carried[e + 1] @ self.step[e, :, :nx]
            slope[e] = self.cost[e, :nx] + slope[e + 1] @ self.step[e, :, :nx]
        own = self.step[:, :, nx:]
        last = (carried[1:] @ own).swapaxes(0, 1).reshape(nx, -1)
        first = np.hstack([np.eye(nx), np.zeros_like(last)])
        self.ends = np.vstack([first, np.hstack([carried[0], last])])
        by_own = self.cost[:, nx:] + (slope[1:, None] @ own)[:, 0]
        self.gradient = np.concatenate([slope[0], by_own.ravel()])

    def costates(self, last: Array) -> Array:
        """Costates (N + 1, nx) of the nodes, from that at the end."""
        found = np.empty((len(self.step) + 1, self.nx))
        found[-1] = last
        for e in reversed(range(len(self.step))):
            found[e] = self.cost[e, : self.nx] + found[e + 1] @ self.step[e, :, : self.nx]
        return found

    def weights(self, costates: Array) -> Array:
        """Return d(Lagrangian)/d(rates, cost) (N, K, nx + 1), from the costates of the nodes."""
        after = costates[1:, None]
        used = self.used
        change = self.slopes[..., used] + (after[:, :, None] @ self.J[..., used])[:, :, 0]
        change *= self.weight[..., None]
        change = (change.reshape(len(after), 1, -1) @ self.inverse).reshape(change.shape)
        rates = np.repeat(self.weight[..., None], self.nx, axis=2) * after
        rates[..., used] += self.integral.swapaxes(1, 2) @ change
        return np.concatenate([rates, self.weight[..., None]], axis=2)

    def hessians(self, H: Array) -> Array:
        """Hessians (N, nx + m, nx + m) in the variables [x_e; y_e], from those of the stages."""
        V = self.stages.reshape(len(H), -1, self.stages.shape[3])
        found: Array = V.swapaxes(1, 2) @ (H @ self.stages).reshape(V.shape)
        return found
