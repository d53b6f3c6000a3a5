"""The inverted formulation, eq. (4.5): strains from moments, an ordinary differential equation."""

from __future__ import annotations

import casadi as ca

from ribbonopt.mechanics.invariants import outputs

from .contract import BoundaryValueProblem, Phase
from .ribbon import Ribbon


def inverted(ribbon: Ribbon) -> BoundaryValueProblem:
    """Return the boundary-value problem x' = f*(x) of a ribbon: no algebraic variable, no cost."""
    model, theta = ribbon.model, ribbon.theta
    x = ca.SX.sym("x", len(model.states))
    c = ca.SX.sym("c", len(model.constants))
    section = ribbon.section(x, c)
    u = ca.vertcat(0, section.u2, section.u3)
    phase = Phase(
        dynamics=model.rates(x, section.rod, u),
        length=theta["interval.end"] - theta["interval.start"],
        outputs=outputs(section.rod, ribbon.law, section.u2, section.u3),
    )
    points = ca.SX.sym("start", x.numel()), ca.SX.sym("end", x.numel())
    return BoundaryValueProblem(
        position=ca.SX.sym("s"),
        state=x,
        algebraic=ca.SX(0, 1),
        constants=c,
        parameters=ca.vertcat(*theta.values()),
        start=theta["interval.start"],
        phases=(phase,),
        points=points,
        conditions=ribbon.residuals(*points, c),
        state_names=model.states,
        constant_names=model.constants,
        parameter_names=tuple(theta),
    )
