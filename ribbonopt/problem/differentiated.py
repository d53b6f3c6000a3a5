"""The differentiated formulation of section 3: u2 and u3 are states, g = 0 replaced by g' = 0.

(dg/du) u' = -(dg/dx) x', solved for u' symbolically, and g = 0 imposed at the start only; how far g
drifts along s is the named output `law_residual`. g is dW/du - m where the law has that in closed
form, else u - u*(m).
"""

from __future__ import annotations

import casadi as ca

from ribbonopt.scene import Scene

from .contract import BoundaryValueProblem
from .equilibrium import Unknowns, equilibrium
from .ribbon import Ribbon


def differentiated(ribbon: Ribbon, scene: Scene) -> BoundaryValueProblem:
    """Return the ODE of the states of the rod, u2 and u3 (20 unknowns with the full states)."""
    unknowns = Unknowns.of(ribbon)
    section, law = unknowns.section, ribbon.law
    u = ca.SX.sym("u", 2)
    if law.closed_moment:
        moment = law.implicit(unknowns.m2, unknowns.m3)
        g = ca.substitute(moment.equations, moment.unknowns, u)
    else:
        g = u - ca.vertcat(section.u2, section.u3)
    rates = ribbon.model.rates(unknowns.x, section.rod, ca.vertcat(0, u))
    (a, b), (c, d) = (ca.horzsplit(row) for row in ca.vertsplit(ca.jacobian(g, u)))
    right = -ca.jtimes(g, unknowns.x, rates)
    determinant = a * d - b * c
    slope = ca.vertcat(d * right[0] - b * right[1], a * right[1] - c * right[0]) / determinant
    local = ca.SX.sym("m", 2)
    return equilibrium(
        ribbon,
        unknowns,
        (u[0], u[1]),
        ca.vertcat(rates, slope),
        more_states=u,
        estimate=(local, ca.vertcat(*law.strain(local[0], local[1]))),
        start_conditions={"start: law along d2": g[0], "start: law along d3": g[1]},
    )
