"""Collocation: residuals and derivative blocks as numbers, all stages in one mapped call.

`ribbonopt.transcription.structure` has the interface and the shapes.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.buffered import Mapped
from ribbonopt.transcription.functions import StageFunctions
from ribbonopt.transcription.layout import Layout
from ribbonopt.transcription.points import Conditions, Parts
from ribbonopt.transcription.residuals import Derivatives, Residuals
from ribbonopt.transcription.tableaus import Tableau, next_tableau

from .compiled import CompiledChain, compiled_chain
from .elimination import StageElimination
from .phase_equations import rates_of
from .splitting import Splitting

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Output


@dataclass(frozen=True, eq=False)
class ElementBlocks:
    """Evaluates a collocation system element by element; see the module for shapes."""

    layout: Layout
    tableau: Tableau
    phases: tuple[StageFunctions, ...]
    conditions: Conditions

    @property
    def name(self) -> str:
        """Name of the tableau."""
        return self.tableau.name

    @property
    def degree(self) -> int:
        """Number of stages K."""
        return self.tableau.degree

    @property
    def order(self) -> int:
        """Order of the error at the nodes."""
        return self.tableau.order

    @property
    def symplectic(self) -> bool:
        """Whether quadratic invariants are kept to rounding."""
        return self.tableau.symplectic

    def build(self) -> None:
        """Build all functions now rather than at the first evaluation."""
        _ = self._values, self._dense, self.compiled
        self.conditions.build()

    @cached_property
    def compiled(self) -> CompiledChain | None:
        """The same in the compiled kernel, where that is there and takes it."""
        return compiled_chain(self.layout, self.tableau, self.phases, self.conditions)

    @cached_property
    def finer(self) -> tuple[ElementBlocks, int]:
        """The same equations on the next better scheme, and the parts of each element.

        Path inequalities are left out: a solution inside them is refined by its equations.
        """
        tableau, split = next_tableau(self.tableau)
        elements = tuple(split * n for n in self.layout.elements)
        places = tuple(tableau.nodes.tolist())
        layout = replace(self.layout, nh=0, stages=tableau.degree, places=places, elements=elements)
        conditions = replace(self.conditions, layout=layout)
        phases = self.phases
        if self.layout.nh:
            kept = layout.nx + layout.ng
            phases = tuple(StageFunctions(f.inputs, f.equations[:kept], None) for f in phases)
        return ElementBlocks(layout, tableau, phases, conditions), split

    @cached_property
    def bordered(self) -> ElementBlocks:
        """The same with one more constant and one more condition: to eliminate, not to evaluate."""
        lay = self.layout
        return replace(self, layout=replace(lay, nc=lay.nc + 1, conditions=lay.conditions + 1))

    def values(self, w: Array, p: Array) -> tuple[Array, Array]:
        """Equations (N, K, ne) at the stages, and conditions (nb,), which `linearize` derives."""
        lay = self.layout
        parts = lay.unpack(w)
        values = self._evaluate(self._values, parts, p)[0]
        stages = values.reshape(lay.element_count, lay.stages, lay.stage_equations)
        return stages, self.conditions.values(parts, p)

    def residuals(self, w: Array, p: Array) -> Residuals:
        """Residuals at the unknowns w for the parameters p."""
        if self.compiled is not None:
            return self.compiled.residuals(w, p)
        parts = self.layout.unpack(w)
        values = self._evaluate(self._values, parts, p)
        return self._residuals(parts, p, values[0], self.conditions.values(parts, p))

    def linearize(self, w: Array, p: Array) -> tuple[Residuals, Derivatives]:
        """Residuals and derivative blocks at w for p."""
        if self.compiled is not None:
            return self.compiled.linearize(w, p)
        lay = self.layout
        parts = lay.unpack(w)
        values, jacobians = self._evaluate(self._dense, parts, p)
        # CasADi stores columns first.
        jacobians = jacobians.reshape(
            lay.element_count, lay.stages, lay.nv + lay.nc, lay.stage_equations
        ).swapaxes(2, 3)
        b, jb = self.conditions.linearize(parts, p)
        return self._residuals(parts, p, values, b), Derivatives(jacobians, jb)

    def eliminate(
        self, derivatives: Derivatives, p: Array, only: Residuals | None = None
    ) -> StageElimination:
        """Solve every element's stage equations for its stages, maybe for some residuals only."""
        return StageElimination(self._splitting, derivatives.stages, self.widths(p), only)

    def growth(self, derivatives: Derivatives, p: Array) -> Array:
        """Exponents (N,) by which neighbouring solutions part in each element, or meet."""
        middle = derivatives.stages[:, self.layout.stages // 2]
        return np.asarray(self.widths(p) * rates_of(middle, self.layout))

    def rates(self, w: Array, p: Array) -> Array:
        """Return the derivatives F (N, K, nx) at the stages, per relative position."""
        lay = self.layout
        values = self._evaluate(self._values, lay.unpack(w), p)[0]
        return values.reshape(lay.element_count, lay.stages, -1)[:, :, : lay.nx]

    def sampled(self, output: Output, p: Array) -> Array:
        """Unknowns w that stand for an output of the same problem, on any elements."""
        lay = self.layout
        t = np.append(0.0, self.tableau.nodes)
        sigma = lay.starts(p)[:, None] + self.widths(p)[:, None] * t
        v = np.empty((*sigma.shape, lay.nv))
        for phase, s in enumerate(lay.phase_slices):
            v[s] = output.approximate(phase, sigma[s].ravel()).reshape(v[s].shape)
        nodes = np.vstack([v[:, 0, : lay.nx], output.at_nodes[-1:]])
        return lay.pack(nodes, v[:, 1:], output.constants)

    def of_finer(self, w: Array) -> Array:
        """Unknowns (nw,) that stand for such of `finer`: the polynomials through its stages."""
        finer, split = self.finer
        nodes, stages, c = finer.layout.unpack(w)
        part, basis = self._of_finer
        if split == 1:
            return self.layout.pack(nodes, basis @ stages, c)
        own = [basis[i] @ stages[part[i] :: split] for i in range(len(basis))]
        return self.layout.pack(nodes[::split], np.stack(own, axis=1), c)

    def widths(self, p: Array) -> Array:
        """Relative widths (N,) of the elements."""
        return self.layout.widths(p)

    def stage_positions(self, p: Array) -> Array:
        """Relative position (N, K) of every stage in its phase."""
        return np.asarray(
            self.layout.starts(p)[:, None] + self.widths(p)[:, None] * self.tableau.nodes
        )

    def _residuals(self, parts: Parts, p: Array, values: Array, b: Array) -> Residuals:
        lay = self.layout
        nodes, stages, _ = parts
        values = values.reshape(lay.element_count, lay.stages, lay.stage_equations)
        rates = self.widths(p)[:, None, None] * values[:, :, : lay.nx]
        integrals = self.tableau.coefficients @ rates
        integrals += nodes[:-1, None]
        ends = nodes[1:] - integrals[:, -1]
        if lay.nx == lay.stage_equations:
            return Residuals(stages[:, :, : lay.nx] - integrals[:, :-1], ends, b)
        result = values.copy()
        result[:, :, : lay.nx] = stages[:, :, : lay.nx] - integrals[:, :-1]
        return Residuals(result, ends, b)

    @cached_property
    def _nowhere(self) -> Array:
        """Positions (N, K) of stages where none are read."""
        return np.zeros((self.layout.element_count, self.layout.stages))

    @cached_property
    def _splitting(self) -> Splitting:
        return Splitting(self.layout, self.tableau, self.phases)

    @cached_property
    def _of_finer(self) -> tuple[NDArray[np.intp], Array]:
        """The part of a split element that each stage is in (K,), and the basis there (K, K')."""
        finer, split = self.finer
        t = split * self.tableau.nodes
        part = np.minimum(t.astype(np.intp), split - 1)
        return part, finer.tableau.basis(t - part)

    @cached_property
    def _depends_on_position(self) -> bool:
        return any(f.depends_on_position for f in self.phases)

    def _evaluate(self, calls: tuple[Mapped, ...], parts: Parts, p: Array) -> list[Array]:
        """Return outputs of functions at the stages of all phases."""
        lay = self.layout
        _, stages, c = parts
        theta = lay.theta(p)
        positions = self.stage_positions(p) if self._depends_on_position else self._nowhere
        places = lay.with_known(positions, p)
        if len(calls) == 1:
            return calls[0](stages, c, theta, places)
        groups = [
            call(stages[s], c, theta, places[s])
            for call, s in zip(calls, lay.phase_slices, strict=True)
        ]
        return [np.concatenate(group) for group in zip(*groups, strict=True)]

    @cached_property
    def _values(self) -> tuple[Mapped, ...]:
        return tuple(f.mapped_values for f in self.phases)

    @cached_property
    def _dense(self) -> tuple[Mapped, ...]:
        return tuple(f.mapped_dense for f in self.phases)
