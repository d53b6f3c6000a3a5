"""Dense output: states and algebraic variables anywhere on a collocation solution.

In an element the collocation polynomial x_0 + h sum_j F_j integral(l_j) has order K + 1, the nodes
2K (Gauss) or 2K - 1 (Radau). For ordinary differential equations the missing orders are won back:
the same scheme is applied to the substep from the node to the wanted point, its stages started on
the polynomial and improved by fixed-point sweeps, each worth one order, until they stand still. In
a stiff element, where neighbouring solutions part fast, that would follow one of them: there only
the polynomial, which both nodes hold, is of use.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.known import Known, at_places
from ribbonopt.transcription.layout import Index
from ribbonopt.transcription.tableaus import Inside

from .blocks import ElementBlocks
from .phase_equations import PhaseEquations
from .substeps import after_substeps

if TYPE_CHECKING:
    from .refined import Refined

STIFF = 3.0  # exponent of an element, from which on neighbouring solutions part too fast


@dataclass(frozen=True, eq=False)
class DenseOutput:
    """Numbers of one solution; positions are relative to their phase.

    Attributes
    ----------
    blocks : ElementBlocks
        The discretised equations.
    w, p : arrays
        Unknowns, and parameters.
    known : Known or None
        The known fields that p was sampled from, if the problem has any.
    """

    blocks: ElementBlocks
    w: Array
    p: Array
    known: Known | None = None

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
        return self._parts[2]

    @property
    def at_nodes(self) -> Array:
        """States (N + 1, nx) at the nodes of all phases."""
        return self._parts[0]

    def nodes(self, phase: int) -> Array:
        """Relative positions (n + 1,) of the nodes of a phase."""
        return self.blocks.layout.phase_nodes(self.p, phase)

    def states(self, phase: int, sigma: Array) -> Array:
        """States x (k, nx) at the relative positions sigma (k,), to the order of the scheme."""
        element, t, h = self.blocks.layout.locate(self.p, phase, sigma)
        x = self._polynomial(element, t, h)
        # Nodes are known already; every other point is the end of a substep.
        inside = (t > 0) & (t < 1) & (self.growth[element] < STIFF)
        if self.order > self.blocks.tableau.dense_order and inside.any():
            ends = self._substeps(phase, element[inside], t[inside], h[inside])
            # Where neighbouring solutions part faster than one place shows, the polynomial stays.
            x[inside] = np.where(np.isfinite(ends), ends, x[inside])
        return x

    def many(self, phase: int, sigma: Array) -> Array:
        """States x (k, nx) as `states`, sooner at many places: see `refined`."""
        from .refined import states_at_many  # for pictures and exports

        return states_at_many(self, phase, sigma)

    @cached_property
    def polynomials(self) -> Refined:
        """Polynomials of the elements that have the order of the nodes."""
        from .refined import Refined

        return Refined.of(self)

    def approximate(self, phase: int, sigma: Array) -> Array:
        """Unknowns v (k, nv) at relative positions sigma (k,): the collocation polynomials."""
        element, t, h = self.blocks.layout.locate(self.p, phase, sigma)
        return self._with_algebraic(self._polynomial(element, t, h), element, t)

    def moved(self, step: Array) -> DenseOutput:
        """Return the output of the unknowns w + step."""
        return replace(self, w=self.w + step)

    def refined(self) -> tuple[DenseOutput, int]:
        """Return this output on the next better scheme, and the parts of each element."""
        blocks, split = self.blocks.finer
        widths = np.repeat(self.blocks.widths(self.p) / split, split)
        p = blocks.layout.parameters(self.theta, widths, self.known)
        if split == 1:
            stages = self._everywhere(self.blocks.tableau.at_better)
            w = blocks.layout.pack(self.at_nodes, stages, self.constants)
        else:
            w = blocks.sampled(self, p)
        return DenseOutput(blocks, w, p, self.known), split

    def _substeps(self, phase: int, element: Index, t: Array, h: Array) -> Array:
        """States (k, nx) after steps of t h from the first nodes of elements."""
        tableau, lay = self.blocks.tableau, self.blocks.layout
        stage_t = t[:, None] * tableau.nodes
        positions = lay.starts(self.p)[element][:, None] + h[:, None] * stage_t
        places = self.places(phase, positions.ravel())
        repeated, K = np.repeat(element, tableau.degree), tableau.degree
        x = self._polynomial(repeated, stage_t.ravel(), np.repeat(h, K))
        v = self._with_algebraic(x, repeated, stage_t.ravel())
        equations, start = self.equations(phase), self.at_nodes[element]
        return after_substeps(equations, tableau, start, (h * t)[:, None], v, places)

    @cached_property
    def growth(self) -> Array:
        """Exponents (N,) by which neighbouring solutions part in each element, or meet."""
        lay, middle = self.blocks.layout, self.blocks.tableau.degree // 2
        v, positions = self._parts[1][:, middle], self.blocks.stage_positions(self.p)[:, middle]
        rates = [
            self.equations(phase).rates(v[s], self.places(phase, positions[s]))
            for phase, s in enumerate(lay.phase_slices)
        ]
        return np.asarray(lay.widths(self.p) * np.concatenate(rates))

    def algebraic(self, phase: int, sigma: Array) -> Array:
        """Algebraic variables z (k, nz): from their equations at the states.

        Controls, for which there are none, are the polynomial through the stages.
        """
        element, t, _ = self.blocks.layout.locate(self.p, phase, sigma)
        z = self._interpolated(element, t)
        if not z.size:
            return z
        places = self.places(phase, sigma)
        return self.equations(phase).algebraic(self.states(phase, sigma), z, places)

    def stages(self, phase: int) -> tuple[Array, Array, Array]:
        """Stage values v (k, nv), relative positions (k,) and quadrature weights (k,)."""
        lay = self.blocks.layout
        s = lay.phase_slices[phase]
        stages = self._parts[1]
        positions = self.blocks.stage_positions(self.p)[s]
        weights = self.blocks.widths(self.p)[s, None] * self.blocks.tableau.weights
        return stages[s].reshape(-1, lay.nv), positions.ravel(), weights.ravel()

    def decay(self) -> Array:
        """Sizes (N, K) of the Legendre coefficients of x' in every element.

        Each state relative to its largest derivative along the solution; the largest of all.
        """
        coefficients = np.abs(self.blocks.tableau.legendre @ self.rates)
        scale = np.maximum(np.abs(self.rates).max(axis=(0, 1)), np.finfo(float).tiny)
        return np.asarray((coefficients / scale).max(axis=2))

    def residual_between_nodes(self) -> Array:
        """Defects (N, K + 1) of the differential equations between the stages of every element.

        Largest entry of |x' - F(x)| over the largest entry of |F| in the solution, x being the
        collocation polynomial: independent of what the solver made zero.
        """
        lay, between = self.blocks.layout, self.blocks.tableau.between
        count = len(between.t)
        found = between.basis @ self.rates  # (N, k, nx)
        everywhere = self._everywhere(between)
        positions = lay.starts(self.p)[:, None] + lay.widths(self.p)[:, None] * between.t
        result = np.empty((lay.element_count, count))
        for phase, s in enumerate(lay.phase_slices):
            v = everywhere[s].reshape(-1, lay.nv)
            places = self.places(phase, positions[s].ravel())
            F, _ = self.equations(phase).derivatives(v, places)
            result[s] = np.abs(found[s] - F.reshape(-1, count, lay.nx)).max(axis=2)
        return np.asarray(result / np.abs(self.rates).max())

    @cached_property
    def _parts(self) -> tuple[Array, Array, Array]:
        """Nodes, stages and constants."""
        return self.blocks.layout.unpack(self.w)

    @cached_property
    def rates(self) -> Array:
        """Derivatives (N, K, nx) at the stages, per relative position."""
        return self.blocks.rates(self.w, self.p)

    def _everywhere(self, inside: Inside) -> Array:
        """Polynomials v (N, k, nv) at the same places of all elements."""
        lay = self.blocks.layout
        v = np.empty((lay.element_count, len(inside.t), lay.nv))
        x = v[:, :, : lay.nx]
        np.multiply(lay.widths(self.p)[:, None, None], inside.integrals @ self.rates, out=x)
        x += self.at_nodes[:-1, None]
        if inside.t[-1] == 1:
            x[:, -1] = self.at_nodes[1:]
        if lay.nz:
            v[:, :, lay.nx :] = inside.basis @ self._parts[1][:, :, lay.nx :]
        return v

    def _with_algebraic(self, x: Array, element: Index, t: Array) -> Array:
        """States x (k, nx) and the polynomials through the stages of z: unknowns v (k, nv)."""
        return np.hstack([x, self._interpolated(element, t)]) if self.blocks.layout.nz else x

    def _interpolated(self, element: Index, t: Array) -> Array:
        """Polynomials (k, nz) through the stages of z."""
        lay = self.blocks.layout
        if not lay.nz:
            return np.empty((len(t), 0))
        basis = self.blocks.tableau.basis(t)
        z: Array = np.einsum("kj,kjz->kz", basis, self._parts[1][element][:, :, lay.nx :])
        return z

    def places(self, phase: int, sigma: Array) -> Array:
        """Positions sigma (k,) with the known fields there, as stage functions take them."""
        return at_places(self.known, phase, sigma, self.blocks.layout.known)

    def equations(self, phase: int) -> PhaseEquations:
        """Return the equations of a phase with these numbers."""
        blocks = self.blocks
        return PhaseEquations(blocks.phases[phase], blocks.layout, (self.constants, self.theta))

    def _polynomial(self, element: Index, t: Array, h: Array) -> Array:
        nodes = self.at_nodes
        integrals = self.blocks.tableau.integrals(t)
        increments = (integrals[:, None, :] @ self.rates[element])[:, 0]
        x: Array = nodes[element] + h[:, None] * increments
        x[t == 1] = nodes[element[t == 1] + 1]
        return x
