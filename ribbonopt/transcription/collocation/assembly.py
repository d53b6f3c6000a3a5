"""The sparse collocation NLP as CasADi functions, its Jacobian and Hessian laid out by hand.

Automatic differentiation of the whole program costs ten times as much to build as this and is no
faster to evaluate: the structure is known, since the equations are linear in the stage functions F
with coefficients of the tableau. Each element's Jacobian is S J + k, with J the nonzeros of its
stages' Jacobians (rows of F scaled by the element's width), S and k constant; one permutation then
sorts all nonzeros by columns. The Hessian is the sum of the stages' Hessians under the multipliers
that each F collects from the equations it enters.
"""

from __future__ import annotations

from collections.abc import Sequence

import casadi as ca
import numpy as np

from ribbonopt.transcription.buffered import shared_map
from ribbonopt.transcription.functions import ConditionFunctions, StageFunctions
from ribbonopt.transcription.layout import Layout
from ribbonopt.transcription.nlp import NLPFunctions
from ribbonopt.transcription.sparse import Index, parts_of, scatter, sparse, triplets_of
from ribbonopt.transcription.tableaus import Tableau

from .element_pattern import element_pattern


class Assembler:
    """Builds the functions of one NLP; `functions` is its product."""

    def __init__(
        self,
        layout: Layout,
        tableau: Tableau,
        phases: Sequence[StageFunctions],
        conditions: ConditionFunctions,
        n_theta: int,
    ) -> None:
        self.layout, self.tableau = layout, tableau
        self.phases, self.conditions = phases, conditions
        self.w = ca.MX.sym("w", layout.unknowns)
        self.p = ca.MX.sym("p", n_theta + sum(layout.parameter_sizes))
        self.theta, self.numbers, known, widths = parts_of(self.p, layout, n_theta)
        self.known = ca.reshape(known, layout.known, -1) if layout.known else None
        ends = [0, layout.element_count * layout.element_unknowns]
        body, last, c = ca.vertsplit(self.w, [*ends, layout.constants_at, layout.unknowns])
        body = ca.reshape(body, layout.element_unknowns, layout.element_count)
        self.widths, self.c = widths.T, c
        self.nodes = ca.horzcat(body[: layout.nx, :], last)
        self.stages = body[layout.nx :, :]

    def functions(self) -> NLPFunctions:
        """Cost, constraints, Jacobian and Hessian."""
        w, p = self.w, self.p
        sigma_f = ca.MX.sym("sigma_f")
        multipliers = ca.MX.sym("lambda", self.layout.equations)
        return NLPFunctions(
            ca.Function("cost", [w, p], [self._cost()]),
            ca.Function("constraints", [w, p], [self._constraints()]),
            ca.Function("jacobian", [w, p], list(self._constraints_and_jacobian())),
            ca.Function(
                "hessian", [w, p, sigma_f, multipliers], [self._hessian(sigma_f, multipliers)]
            ),
        )

    def _stage_inputs(self, elements: slice) -> list[ca.MX]:
        """Return the inputs of a mapped stage function over the elements of one phase."""
        lay = self.layout
        count = elements.stop - elements.start
        widths = self.widths[0, elements.start : elements.stop]
        # Position in the phase: widths before the element, then the node's share of its width.
        before = ca.DM(np.triu(np.ones((count, count)), 1))
        positions = ca.DM.ones(lay.stages, 1) @ (widths @ before)
        positions += ca.DM(self.tableau.nodes) @ widths
        v = ca.reshape(self.stages[:, elements.start : elements.stop], lay.nv, -1)
        places = ca.reshape(positions, 1, -1)
        if self.known is not None:
            stages = slice(elements.start * lay.stages, elements.stop * lay.stages)
            places = ca.vertcat(places, self.known[:, stages])
        return [v, self.c, self.theta, places]

    def _each(self, name: str, extra: Sequence[list[ca.MX]] = ()) -> list[list[ca.MX]]:
        """Return the outputs of stage function `name` of every phase, mapped over its stages."""
        result = []
        for i, (functions, s) in enumerate(zip(self.phases, self.layout.phase_slices, strict=True)):
            count = (s.stop - s.start) * self.layout.stages
            inputs = self._stage_inputs(s) + (extra[i] if extra else [])
            outputs = shared_map(getattr(functions, name), count)(*inputs)
            result.append(list(outputs) if isinstance(outputs, tuple | list) else [outputs])
        return result

    def _condition_inputs(self) -> list[ca.MX]:
        points = ca.horzcat(*(self.nodes[:, i] for i in self.layout.point_elements))
        return [points, self.c, self.numbers]

    def _repeated_widths(self, elements: slice) -> ca.MX:
        """Width of the element of every stage, a row."""
        widths = self.widths[0, elements.start : elements.stop]
        return ca.reshape(ca.DM.ones(self.layout.stages, 1) @ widths, 1, -1)

    def _cost(self) -> ca.MX:
        total = ca.MX(0)
        if all(f.cost is None for f in self.phases):
            return total
        weights = ca.DM(self.tableau.weights).T
        slices = self.layout.phase_slices
        for (density,), s in zip(self._each("cost_density"), slices, strict=True):
            per_element = weights @ ca.reshape(density, self.layout.stages, -1)
            total += ca.dot(per_element.T, self.widths[0, s.start : s.stop].T)
        return total

    def _constraints(self) -> ca.MX:
        values = [v for (v,) in self._each("values")]
        return self._residuals(values, self.conditions.values(*self._condition_inputs()))

    def _residuals(self, values: list[ca.MX], conditions: ca.MX) -> ca.MX:
        lay = self.layout
        equations = ca.horzcat(*values)
        widths = self._repeated_widths(slice(0, lay.element_count))
        rates = equations[: lay.nx, :] * ca.repmat(widths, lay.nx, 1)
        rates = ca.reshape(rates, lay.stages * lay.nx, -1)
        identity = np.eye(lay.nx)
        integral = sparse(np.kron(self.tableau.matrix, identity)) @ rates
        starts = ca.repmat(self.nodes[:, :-1], lay.stages, 1)
        x = ca.reshape(self.stages, lay.nv, -1)[: lay.nx, :]
        defects = ca.reshape(x, lay.stages * lay.nx, -1) - starts - integral
        stages = ca.vertcat(ca.reshape(defects, lay.nx, -1), equations[lay.nx :, :])
        stages = ca.reshape(stages, lay.stages * lay.stage_equations, -1)
        step = sparse(np.kron(self.tableau.weights[None], identity)) @ rates
        ends = self.nodes[:, 1:] - self.nodes[:, :-1] - step
        return ca.vertcat(ca.vec(ca.vertcat(stages, ends)), conditions)

    def _constraints_and_jacobian(self) -> tuple[ca.MX, ca.MX]:
        lay = self.layout
        stage_outputs = self._each("sparse")
        conditions, condition_nonzeros = self.conditions.sparse(*self._condition_inputs())
        nonzeros, rows, columns = [], [], []
        slices = lay.phase_slices
        for functions, (_, jac), s in zip(self.phases, stage_outputs, slices, strict=True):
            row, col = triplets_of(functions.jacobian.sparsity())
            scaled = (row < lay.nx).astype(float)[:, None]
            widths = self._repeated_widths(s)
            scale = ca.DM(scaled) @ widths + ca.DM(1 - scaled) @ ca.DM.ones(1, widths.shape[1])
            stacked = ca.reshape(jac * scale, lay.stages * len(row), s.stop - s.start)
            S, k, local_row, local_col = element_pattern(lay, self.tableau, row, col)
            nonzeros.append(ca.vec(S @ stacked + ca.repmat(k, 1, s.stop - s.start)))
            elements = np.arange(s.start, s.stop)[:, None]
            rows.append((elements * lay.element_equations + local_row).ravel())
            is_constant = local_col >= lay.element_unknowns + lay.nx
            shift = np.where(
                is_constant,
                lay.constants_at - lay.element_unknowns - lay.nx,
                elements * lay.element_unknowns,
            )
            columns.append((shift + local_col).ravel())
        row, col = triplets_of(self.conditions.jacobian.sparsity())
        nonzeros.append(condition_nonzeros)
        rows.append(row + lay.conditions_at)
        columns.append(lay.condition_columns[col])
        shape = (lay.equations, lay.unknowns)
        jacobian = scatter(nonzeros, np.concatenate(rows), np.concatenate(columns), shape)
        return self._residuals([e for e, _ in stage_outputs], conditions), jacobian

    def _hessian(self, sigma_f: ca.MX, multipliers: ca.MX) -> ca.MX:
        lay, t = self.layout, self.tableau
        shape = (lay.unknowns, lay.unknowns)
        if all(f.cost is None for f in self.phases):
            # Nothing to minimise: IPOPT needs no second derivatives to solve equations.
            return ca.MX(*shape)
        body, rest = ca.vertsplit(multipliers, [0, lay.conditions_at, lay.equations])
        body = ca.reshape(body, lay.element_equations, -1)
        stages = ca.reshape(body[: lay.stages * lay.stage_equations, :], lay.stage_equations, -1)
        defects = ca.reshape(stages[: lay.nx, :], lay.stages * lay.nx, -1)
        widths = self._repeated_widths(slice(0, lay.element_count))
        identity = np.eye(lay.nx)
        collected = sparse(np.kron(t.matrix.T, identity)) @ defects
        collected += sparse(np.kron(t.weights[:, None], identity)) @ body[-lay.nx :, :]
        rates = -ca.reshape(collected, lay.nx, -1) * ca.repmat(widths, lay.nx, 1)
        cost = sigma_f * widths * ca.DM(np.tile(t.weights, lay.element_count)).T
        slices = lay.phase_slices
        extra = []
        for f, s in zip(self.phases, slices, strict=True):
            columns = slice(s.start * lay.stages, s.stop * lay.stages)
            parts = [rates[:, columns], stages[lay.nx :, columns]]
            extra.append([ca.vertcat(*parts, *([] if f.cost is None else [cost[:, columns]]))])
        nonzeros: list[ca.MX] = []
        rows: list[Index] = []
        columns_of: list[Index] = []
        for f, (values,), s in zip(self.phases, self._each("hessian", extra), slices, strict=True):
            row, col = triplets_of(f.lagrangian_hessian.sparsity())
            stage = np.arange(s.start * lay.stages, s.stop * lay.stages)[:, None]
            element, j = np.divmod(stage, lay.stages)
            base = element * lay.element_unknowns + lay.nx + j * lay.nv
            nonzeros.append(ca.vec(values))
            for index, out in ((row, rows), (col, columns_of)):
                constant = lay.constants_at + index - lay.nv
                out.append(np.where(index < lay.nv, base + index, constant).ravel())
        row, col = triplets_of(self.conditions.lagrangian_hessian.sparsity())
        nonzeros.append(self.conditions.hessian(*self._condition_inputs(), rest))
        where = lay.condition_columns
        rows.append(where[row])
        columns_of.append(where[col])
        return scatter(nonzeros, np.concatenate(rows), np.concatenate(columns_of), shape)
