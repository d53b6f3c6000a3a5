"""Numeric evaluation of residuals and derivative blocks, all stages in one mapped call.

Shapes: N elements, K stages, nx states, nv = nx + nz unknowns of a stage, ne =
nx + ng + nh equations of a stage, nc constants, P + 1 points.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array

from .buffered import Buffered, shared_map
from .functions import ConditionFunctions, StageFunctions
from .layout import Layout
from .tableaus import Tableau, next_tableau


@dataclass(frozen=True, eq=False)
class Residuals:
    """Residuals of one iterate.

    `stages` (N, K, ne): defects X_i - x_0 - h sum a_ij F_j, then algebraic equations; `nodes`
    (N, nx): x_{e+1} - x_e - h sum b_j F_j; `conditions` (nb,).
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
    """Derivative blocks: `stages` (N, K, ne, nv + nc) and `conditions` (nb, (P+1) nx + nc)."""

    stages: Array
    conditions: Array


@dataclass(frozen=True, eq=False)
class ElementBlocks:
    """Evaluates a collocation system element by element; see the module for shapes."""

    layout: Layout
    tableau: Tableau
    phases: tuple[StageFunctions, ...]
    conditions: ConditionFunctions

    def build(self) -> None:
        """Build all functions now rather than at the first evaluation."""
        _ = self._values, self._dense, self._condition_values, self._condition_dense

    def finer(self) -> tuple[ElementBlocks, int]:
        """Return the same equations on the next better scheme, and the parts of each element."""
        tableau, split = next_tableau(self.tableau)
        elements = tuple(split * n for n in self.layout.elements)
        layout = replace(self.layout, stages=tableau.degree, elements=elements)
        return replace(self, layout=layout, tableau=tableau), split

    def residuals(self, w: Array, p: Array) -> Residuals:
        """Residuals at the unknowns w for the parameters p = [theta, widths]."""
        values = self._evaluate(self._values, w, p)
        b = self._condition_values(*self._at_points(w, p))[0].copy()
        return self._residuals(w, p, values[0], b)

    def linearize(self, w: Array, p: Array) -> tuple[Residuals, Derivatives]:
        """Residuals and derivative blocks at w for p."""
        lay = self.layout
        values, jacobians = self._evaluate(self._dense, w, p)
        # CasADi stores columns first.
        jacobians = jacobians.reshape(
            lay.element_count, lay.stages, lay.nv + lay.nc, lay.stage_equations
        ).swapaxes(2, 3)
        b, jb = self._condition_dense(*self._at_points(w, p))
        jb = jb.reshape(-1, lay.conditions).T.copy()
        return self._residuals(w, p, values, b.copy()), Derivatives(jacobians, jb)

    def rates(self, w: Array, p: Array) -> Array:
        """Return the derivatives F (N, K, nx) at the stages, per relative position."""
        lay = self.layout
        values = self._evaluate(self._values, w, p)[0]
        return values.reshape(lay.element_count, lay.stages, -1)[:, :, : lay.nx]

    def widths(self, p: Array) -> Array:
        """Relative widths (N,) of the elements."""
        return p[len(p) - self.layout.element_count :]

    def stage_positions(self, p: Array) -> Array:
        """Relative position (N, K) of every stage in its phase."""
        widths = self.widths(p)
        starts = np.concatenate(
            [np.cumsum(widths[s]) - widths[s] for s in self.layout.phase_slices()]
        )
        return np.asarray(starts[:, None] + widths[:, None] * self.tableau.nodes)

    def _residuals(self, w: Array, p: Array, values: Array, b: Array) -> Residuals:
        lay, t = self.layout, self.tableau
        nodes, stages, _ = lay.unpack(w)
        values = values.reshape(lay.element_count, lay.stages, lay.stage_equations)
        rates = self.widths(p)[:, None, None] * values[:, :, : lay.nx]
        result = np.empty_like(values)
        result[:, :, : lay.nx] = stages[:, :, : lay.nx] - nodes[:-1, None] - t.matrix @ rates
        result[:, :, lay.nx :] = values[:, :, lay.nx :]
        ends = nodes[1:] - nodes[:-1] - t.weights @ rates
        return Residuals(result, ends, b)

    def _evaluate(self, mapped: tuple[Buffered, ...], w: Array, p: Array) -> list[Array]:
        lay = self.layout
        _, stages, c = lay.unpack(w)
        theta = p[: len(p) - lay.element_count]
        if any(f.depends_on_position for f in self.phases):
            positions = self.stage_positions(p)
        else:
            positions = np.zeros((lay.element_count, lay.stages))
        parts = [
            [a.copy() for a in call(stages[s], c, theta, positions[s])]
            for call, s in zip(mapped, lay.phase_slices(), strict=True)
        ]
        return [np.concatenate(group) for group in zip(*parts, strict=True)]

    def _at_points(self, w: Array, p: Array) -> tuple[Array, Array, Array]:
        nodes, _, c = self.layout.unpack(w)
        theta = p[: len(p) - self.layout.element_count]
        return nodes[list(self.layout.point_elements)], c, theta

    @cached_property
    def _values(self) -> tuple[Buffered, ...]:
        return self._mapped([f.values for f in self.phases])

    @cached_property
    def _dense(self) -> tuple[Buffered, ...]:
        return self._mapped([f.dense for f in self.phases])

    @cached_property
    def _condition_values(self) -> Buffered:
        return Buffered(self.conditions.values)

    @cached_property
    def _condition_dense(self) -> Buffered:
        return Buffered(self.conditions.dense)

    def _mapped(self, functions: list[ca.Function]) -> tuple[Buffered, ...]:
        count = self.layout.stages
        return tuple(
            Buffered(shared_map(f, n * count))
            for f, n in zip(functions, self.layout.elements, strict=True)
        )
