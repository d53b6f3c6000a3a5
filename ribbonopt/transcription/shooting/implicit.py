"""ImplicitStep one-step methods: collocation over one step, its stage equations solved inside.

The stages V = [X; Z] of a step solve R(V, x, c) = 0; the derivatives of the step follow from the
implicit function theorem, d Phi = d(after) - d(after)/dV (dR/dV)^-1 dR. Algebraic variables z are
inner unknowns too: index-1 problems need no others than their nodes. (On the half Moebius ribbon,
degree 3, CasADi's own integrators were tried: "collocation" takes four to six times as long for a
step and its derivatives, "idas" over forty times.)
"""

from __future__ import annotations

import casadi as ca
import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.transcription.functions import StageFunctions
from ribbonopt.transcription.tableaus import Tableau

from .steps import Step, shifted, stage_inputs

ACCEPTED = 1e-9  # residual of inner equations, relative to 1 + |V|, below which they are solved
LINEAR_SOLVER = "lapackqr"  # as quick as any, and singular matrices raise nothing: they give nan


@dataclass(frozen=True, eq=False)
class ImplicitStep:
    """ImplicitStep Runge-Kutta steps by collocation."""

    tableau: Tableau
    explicit: bool = False

    @property
    def name(self) -> str:
        """Name of the tableau."""
        return self.tableau.name

    @property
    def degree(self) -> int:
        """Number of stages."""
        return self.tableau.degree

    @property
    def order(self) -> int:
        """Declared order."""
        return self.tableau.order

    @property
    def symplectic(self) -> bool:
        """Whether quadratic invariants are kept to rounding."""
        return self.tableau.symplectic

    @property
    def places(self) -> tuple[float, ...]:
        """The start, from which the stages are guessed, and the positions of the stages."""
        return (0.0, *self.tableau.nodes.tolist())

    def step(self, stage: StageFunctions, nx: int, start: ca.SX) -> Step:
        """Return one step of nx states; `start` is where inner equations for z start."""
        count = len(self.places)
        x, c, theta, place, h = inputs = stage_inputs(stage, nx, count)
        first = shifted(place, ca.MX(0), 0, count)
        z = algebraic_function(stage, nx, start)(x, c, theta, first)
        rate = stage.values(ca.vertcat(x, z), c, theta, first)[:nx]
        guess = [ca.vertcat(x + node * h * rate, z) for node in self.tableau.nodes.tolist()]
        equations, linear = self._equations(stage, nx)
        V = _root(equations)(ca.vertcat(*guess), *inputs)[0]
        residual, after = equations(V, *inputs)
        plain = after + _unsolved(residual, V)
        _, _, R_V, R_y, after_V, after_y = linear(V, *inputs)
        slope = after_y - after_V @ ca.solve(R_V, R_y, LINEAR_SOLVER)
        return Step(
            ca.Function("step", inputs, [plain]),
            ca.Function("step_dense", inputs, [plain, ca.densify(slope)]),
        )

    def _equations(self, stage: StageFunctions, nx: int) -> tuple[ca.Function, ca.Function]:
        """Functions (V, x, c, theta, place, h) -> R, after; and with derivatives in V, [x; c]."""
        t = self.tableau
        count = len(self.places)
        inputs = [ca.SX.sym("input", *s.shape) for s in stage_inputs(stage, nx, count)]
        x, c, theta, place, h = inputs
        V = ca.SX.sym("V", stage.inputs[0].numel(), t.degree)
        columns = [
            stage.values(V[:, j], c, theta, shifted(place, node * h, j + 1, count))
            for j, node in enumerate(t.nodes.tolist())
        ]
        values = ca.horzcat(*columns)
        defects = V[:nx, :] - ca.repmat(x, 1, t.degree) - h * values[:nx, :] @ ca.DM(t.matrix).T
        residual = ca.vec(ca.vertcat(defects, values[nx:, :]))
        after = x + h * values[:nx, :] @ ca.DM(t.weights)
        outputs, all_inputs, y = [residual, after], [ca.vec(V), *inputs], ca.vertcat(x, c)
        slopes = [ca.jacobian(e, v) for e in outputs for v in (all_inputs[0], y)]
        return (
            ca.Function("equations", all_inputs, outputs),
            ca.Function("linear", all_inputs, outputs + slopes),
        )


def algebraic_function(stage: StageFunctions, nx: int, start: ca.SX) -> ca.Function:
    """Return the function (x, c, theta, place) of the z that solve 0 = g, from `start`."""
    v, c, theta, place = stage.inputs
    x, z = ca.vertsplit(v, [0, nx, v.numel()])
    equations = ca.Function("g", [z, x, c, theta, place], [stage.equations[nx:]])
    first = ca.Function("start", [x, c, theta, place], [start])
    inputs = stage_inputs(stage, nx, 1)[:4]
    found = first(*inputs)
    if z.numel():
        found = _root(equations)(found, *inputs)
        found = found + _unsolved(equations(found, *inputs), found)
    return ca.Function("z", inputs, [found])


def _root(equations: ca.Function) -> ca.Function:
    """Newton's method on the first output, in the first input."""
    options = {"error_on_fail": False, "abstol": 1e-13, "max_iter": 30}
    return ca.rootfinder("root", "fast_newton", equations, options)


def _unsolved(residual: ca.MX, found: ca.MX) -> ca.MX:
    """Zero, or not a number where inner equations are not solved: outer solvers then step back."""
    good = ca.mmax(ca.fabs(residual)) <= ACCEPTED * (1 + ca.mmax(ca.fabs(found)))
    return ca.if_else(good, 0, np.nan)
