"""Dense output: states and algebraic variables anywhere on a collocation solution.

In an element the collocation polynomial x_0 + h sum_j F_j integral(l_j) has order K + 1, the nodes
2K (Gauss) or 2K - 1 (Radau). For ordinary differential equations the missing orders are won back:
the same scheme is applied to the substep from the node to the wanted point, its stages started on
the polynomial and improved by K - 1 fixed-point sweeps, each worth one order.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ribbonopt.arrays import Array

from .blocks import ElementBlocks
from .buffered import Buffered, shared_map
from .layout import Index


@dataclass(frozen=True, eq=False)
class DenseOutput:
    """Numbers of one solution; positions are relative to their phase.

    Attributes
    ----------
    blocks : ElementBlocks
        The discretised equations.
    w, p : arrays
        Unknowns, and parameters [theta, relative widths].
    """

    blocks: ElementBlocks
    w: Array
    p: Array

    @property
    def order(self) -> int:
        """Order of the error of `states` between the nodes."""
        tableau, lay = self.blocks.tableau, self.blocks.layout
        return tableau.order if lay.nz == lay.ng else tableau.dense_order

    @property
    def theta(self) -> Array:
        """Parameters of the problem."""
        return self.blocks.layout.theta(self.p)

    @property
    def constants(self) -> Array:
        """Unknown constants c."""
        return self.blocks.layout.unpack(self.w)[2]

    def nodes(self, phase: int) -> Array:
        """Relative positions (n + 1,) of the nodes of a phase."""
        return self.blocks.layout.phase_nodes(self.p, phase)

    def states(self, phase: int, sigma: Array) -> Array:
        """States x (k, nx) at the relative positions sigma (k,), to the order of the scheme."""
        element, t, h = self.blocks.layout.locate(self.p, phase, sigma)
        x = self._polynomial(element, t, h)
        # Nodes are known already; every other point is the end of a substep.
        inside = (t > 0) & (t < 1)
        if self.order > self.blocks.tableau.dense_order and inside.any():
            x[inside] = self._substeps(phase, element[inside], t[inside], h[inside])
        return x

    def _substeps(self, phase: int, element: Index, t: Array, h: Array) -> Array:
        """States (k, nx) after steps of t h from the first nodes of elements."""
        nodes, _, _ = self.blocks.layout.unpack(self.w)
        tableau = self.blocks.tableau
        e, count, K = element, len(element), tableau.degree
        stage_t = t[:, None] * tableau.nodes
        repeated = np.repeat(e, K)
        X = self._polynomial(repeated, stage_t.ravel(), np.repeat(h, K)).reshape(count, K, -1)
        positions = self.blocks.layout.starts(self.p)[e][:, None] + h[:, None] * stage_t
        lay = self.blocks.layout
        z = self._interpolated(repeated, stage_t.ravel())
        equations = self._mapped(phase, count * K)
        step = (h * t)[:, None]
        for sweep in range(K):
            x = X.reshape(count * K, -1)
            z = self._solved(phase, x, z, positions.ravel())
            values = equations(np.hstack([x, z]), self.constants, self.theta, positions)[0]
            F = values.reshape(count, K, -1)[:, :, : lay.nx]
            if sweep < K - 1:
                X = nodes[e][:, None] + step[:, None] * (tableau.matrix @ F)
        after: Array = nodes[e] + step * (tableau.weights @ F)
        return after

    def algebraic(self, phase: int, sigma: Array) -> Array:
        """Algebraic variables z (k, nz): from their equations at the states.

        Controls, for which there are none, are the polynomial through the stages.
        """
        element, t, _ = self.blocks.layout.locate(self.p, phase, sigma)
        z = self._interpolated(element, t)
        return self._solved(phase, self.states(phase, sigma), z, sigma) if z.size else z

    def stages(self, phase: int) -> tuple[Array, Array, Array]:
        """Stage values v (k, nv), relative positions (k,) and quadrature weights (k,)."""
        lay = self.blocks.layout
        s = lay.phase_slices()[phase]
        _, stages, _ = lay.unpack(self.w)
        positions = self.blocks.stage_positions(self.p)[s]
        weights = self.blocks.widths(self.p)[s, None] * self.blocks.tableau.weights
        return stages[s].reshape(-1, lay.nv), positions.ravel(), weights.ravel()

    def residual_between_nodes(self, per_element: int | None = None) -> Array:
        """Defects (N, k) of the differential equations between the stages of every element.

        Largest entry of |x' - F(x)| over the largest entry of |F| in the solution, x being the
        collocation polynomial: independent of what the solver made zero.
        """
        lay, tableau = self.blocks.layout, self.blocks.tableau
        count = per_element or tableau.degree + 1
        t = (np.arange(count) + 0.5) / count
        found = tableau.basis(t) @ self._rates  # (N, k, nx)
        scale = np.abs(self._rates).max()
        result = np.empty((lay.element_count, count))
        for phase, s in enumerate(lay.phase_slices()):
            nodes = self.nodes(phase)
            sigma = (nodes[:-1, None] + np.diff(nodes)[:, None] * t).ravel()
            element = np.repeat(np.arange(s.start, s.stop), count)
            h = self.blocks.widths(self.p)[element]
            x = self._polynomial(element, np.tile(t, s.stop - s.start), h)
            v = np.hstack([x, self.algebraic(phase, sigma)])
            values = self._mapped(phase, len(v))(v, self.constants, self.theta, sigma)[0]
            F = values.reshape(len(v), -1)[:, : lay.nx]
            error = np.abs(found[s].reshape(len(F), -1) - F).max(axis=1) / scale
            result[s] = error.reshape(-1, count)
        return result

    @cached_property
    def _rates(self) -> Array:
        """Derivatives (N, K, nx) at the stages, per relative position."""
        return self.blocks.rates(self.w, self.p)

    def _interpolated(self, element: Index, t: Array) -> Array:
        """Polynomials (k, nz) through the stages of z."""
        lay = self.blocks.layout
        _, stages, _ = lay.unpack(self.w)
        basis = self.blocks.tableau.basis(t)
        z: Array = np.einsum("kj,kjz->kz", basis, stages[element][:, :, lay.nx :])
        return z

    def _solved(self, phase: int, x: Array, z: Array, sigma: Array) -> Array:
        """Algebraic variables (k, nz) that solve their equations at the states x, from z."""
        lay = self.blocks.layout
        if not lay.nz or lay.nz != lay.ng:
            return z
        dense = Buffered(shared_map(self.blocks.phases[phase].dense, len(x)))
        rows, columns = slice(lay.nx, lay.nx + lay.ng), slice(lay.nx, lay.nv)
        for _ in range(3):  # from the accuracy of the polynomial to rounding
            values, jacobian = dense(np.hstack([x, z]), self.constants, self.theta, sigma)
            g = values.reshape(len(x), -1)[:, rows]
            slope = jacobian.reshape(len(x), lay.nv + lay.nc, -1).swapaxes(1, 2)[:, rows, columns]
            z = z - np.linalg.solve(slope, g[:, :, None])[:, :, 0]
        return z

    def _polynomial(self, element: Index, t: Array, h: Array) -> Array:
        nodes, _, _ = self.blocks.layout.unpack(self.w)
        integrals = self.blocks.tableau.integrals(t)
        increments = np.einsum("kj,kjx->kx", integrals, self._rates[element])
        x: Array = nodes[element] + h[:, None] * increments
        x[t == 1] = nodes[element[t == 1] + 1]
        return x

    def _mapped(self, phase: int, count: int) -> Buffered:
        return Buffered(shared_map(self.blocks.phases[phase].values, count))
