"""CasADi functions of one collocation stage and of the conditions, built once per problem.

A stage knows its own unknowns v = [x; z], the constants c, the parameters theta and its place
[sigma; k]: relative position in the phase and the known fields there. Multiplying the dynamics by
the phase's length L turns an unknown length into one more constant, so that an element of relative
width h always reads X_i = x_0 + h sum_j a_ij F_j with F = L f.
"""

from __future__ import annotations

from functools import cached_property

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from ribbonopt.classes import dataclass
from ribbonopt.problem.contract import BoundaryValueProblem, Phase

from .buffered import Buffered, Mapped


@dataclass(frozen=True, eq=False)
class StageFunctions:
    """Functions of one phase, all with the inputs (v, c, theta, place).

    `equations` is the column [F; g; h]: derivatives with respect to the relative position,
    algebraic equations, path inequalities.
    """

    inputs: tuple[ca.SX, ca.SX, ca.SX, ca.SX]
    equations: ca.SX
    cost: ca.SX | None

    @property
    def differential(self) -> ca.SX:
        """Variables of the derivatives: v and c."""
        return ca.vertcat(self.inputs[0], self.inputs[1])

    @cached_property
    def depends_on_position(self) -> bool:
        """Whether the equations change along the phase, by themselves or by known fields."""
        return bool(ca.depends_on(self.equations, self.inputs[3]))

    @property
    def known(self) -> int:
        """Number of known fields."""
        return int(self.inputs[3].numel()) - 1

    @cached_property
    def jacobian(self) -> ca.SX:
        """Sparse Jacobian of the equations with respect to [v; c]."""
        return ca.jacobian(self.equations, self.differential)

    @cached_property
    def contains(self) -> NDArray[np.bool_]:
        """Which equation contains which variable: the pattern (ne, nv + nc) of the Jacobian."""
        return np.asarray(np.array(ca.DM(self.jacobian.sparsity(), 1.0)) != 0)

    @cached_property
    def values(self) -> ca.Function:
        """The equations alone."""
        return ca.Function("stage", list(self.inputs), [self.equations])

    @cached_property
    def dense(self) -> ca.Function:
        """Equations and their dense Jacobian, for elimination element by element."""
        jacobian = ca.densify(self.jacobian)
        return ca.Function("stage_dense", list(self.inputs), [self.equations, jacobian])

    @cached_property
    def mapped_values(self) -> Mapped:
        """The equations at any number of stages."""
        return Mapped(self.values)

    @cached_property
    def mapped_dense(self) -> Mapped:
        """Equations and their dense Jacobians at any number of stages."""
        return Mapped(self.dense)

    @cached_property
    def sparse(self) -> ca.Function:
        """Equations and the nonzeros of their Jacobian, for the sparse NLP."""
        nonzeros = nonzeros_of(self.jacobian)
        return ca.Function("stage_sparse", list(self.inputs), [self.equations, nonzeros])

    @cached_property
    def cost_density(self) -> ca.Function:
        """Cost per unit of relative position."""
        return ca.Function(
            "stage_cost", list(self.inputs), [ca.SX(0) if self.cost is None else self.cost]
        )

    @cached_property
    def lagrangian_hessian(self) -> ca.SX:
        """Upper triangle of the Hessian of weights . [equations; cost] in [v; c]."""
        terms = self.equations if self.cost is None else ca.vertcat(self.equations, self.cost)
        return ca.triu(ca.hessian(ca.dot(self.weights, terms), self.differential)[0])

    @cached_property
    def weights(self) -> ca.SX:
        """Multipliers of the equations, then of the cost."""
        return ca.SX.sym("weights", self.equations.numel() + (self.cost is not None))

    @cached_property
    def hessian(self) -> ca.Function:
        """Nonzeros of `lagrangian_hessian`; the weights are a fifth input."""
        nonzeros = nonzeros_of(self.lagrangian_hessian)
        return ca.Function("stage_hessian", [*self.inputs, self.weights], [nonzeros])


@dataclass(frozen=True, eq=False)
class ConditionFunctions:
    """Functions of the conditions b, with the inputs (points (nx, P + 1), c, numbers).

    The numbers are theta, then the known fields at all points.
    """

    inputs: tuple[ca.SX, ca.SX, ca.SX]
    conditions: ca.SX

    @property
    def differential(self) -> ca.SX:
        """Variables of the derivatives: all points, one after the other, and c."""
        return ca.vertcat(ca.vec(self.inputs[0]), self.inputs[1])

    @cached_property
    def jacobian(self) -> ca.SX:
        """Sparse Jacobian of the conditions."""
        return ca.jacobian(self.conditions, self.differential)

    @cached_property
    def values(self) -> ca.Function:
        """The conditions alone."""
        return ca.Function("conditions", list(self.inputs), [self.conditions])

    @cached_property
    def dense(self) -> ca.Function:
        """Conditions and their dense Jacobian."""
        outputs = [self.conditions, ca.densify(self.jacobian)]
        return ca.Function("conditions_dense", list(self.inputs), outputs)

    @cached_property
    def buffered_values(self) -> Buffered:
        """The conditions on numpy arrays."""
        return Buffered(self.values)

    @cached_property
    def buffered_dense(self) -> Buffered:
        """Conditions and their dense Jacobian on numpy arrays."""
        return Buffered(self.dense)

    @cached_property
    def sparse(self) -> ca.Function:
        """Conditions and the nonzeros of their Jacobian."""
        nonzeros = nonzeros_of(self.jacobian)
        return ca.Function("conditions_sparse", list(self.inputs), [self.conditions, nonzeros])

    @cached_property
    def multipliers(self) -> ca.SX:
        """Symbols of the multipliers of the conditions."""
        return ca.SX.sym("multipliers", self.conditions.numel())

    @cached_property
    def lagrangian_hessian(self) -> ca.SX:
        """Upper triangle of the Hessian of multipliers . conditions."""
        total = ca.dot(self.multipliers, self.conditions)
        return ca.triu(ca.hessian(total, self.differential)[0])

    @cached_property
    def hessian(self) -> ca.Function:
        """Nonzeros of `lagrangian_hessian`; the multipliers are a fourth input."""
        nonzeros = nonzeros_of(self.lagrangian_hessian)
        return ca.Function("conditions_hessian", [*self.inputs, self.multipliers], [nonzeros])


def nonzeros_of(matrix: ca.SX) -> ca.SX:
    """Return the nonzeros of a sparse matrix as a dense column."""
    column: ca.SX = ca.vec(matrix.nz[:])  # those of a dense row are a row
    return column


def stage_functions(bvp: BoundaryValueProblem) -> tuple[StageFunctions, ...]:
    """Return the stage functions of every phase, made once for each problem."""
    return bvp.kept(_stage_functions)


def condition_functions(bvp: BoundaryValueProblem) -> ConditionFunctions:
    """Return the functions of the conditions, made once for each problem."""
    return bvp.kept(_condition_functions)


def _stage_functions(bvp: BoundaryValueProblem) -> tuple[StageFunctions, ...]:
    sigma = ca.SX.sym("sigma")
    place = ca.vertcat(sigma, bvp.known)
    v = ca.vertcat(bvp.state, bvp.algebraic)
    result, start = [], bvp.start
    for phase in bvp.phases:
        position = start + sigma * phase.length
        equations, cost = _at(bvp, phase, position)
        result.append(StageFunctions((v, bvp.constants, bvp.parameters, place), equations, cost))
        start = start + phase.length
    return tuple(result)


def _at(bvp: BoundaryValueProblem, phase: Phase, position: ca.SX) -> tuple[ca.SX, ca.SX | None]:
    equations = ca.densify(ca.vertcat(phase.length * phase.dynamics, phase.algebraic, phase.path))
    cost = None if phase.cost is None else phase.length * phase.cost
    if not ca.depends_on(ca.vertcat(equations, 0 if cost is None else cost), bvp.position):
        return equations, cost
    equations = ca.substitute(equations, bvp.position, position)
    return equations, None if cost is None else ca.substitute(cost, bvp.position, position)


def _condition_functions(bvp: BoundaryValueProblem) -> ConditionFunctions:
    points = ca.SX.sym("points", bvp.state.numel(), len(bvp.points))
    conditions = ca.vertcat(*bvp.conditions.values())
    conditions = ca.substitute(conditions, ca.horzcat(*bvp.points), points)
    unread = ca.SX.sym("known", bvp.known.numel() * len(bvp.points))
    numbers = ca.vertcat(bvp.parameters, *(bvp.known_at or (unread,)))
    return ConditionFunctions((points, bvp.constants, numbers), conditions)
