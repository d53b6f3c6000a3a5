"""The differentiated formulation of section 3: strains are states, g = 0 replaced by g' = 0.

(dg/du) u' = -(dg/dx) x' - dg/ds, solved for u' symbolically, and g = 0 imposed at the start only;
how far g drifts along s is the named output `law_residual`. g is dW/du - m where the law has that
in closed form, else u - u*(m).
"""

from __future__ import annotations

import casadi as ca

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.laws.law import Stress

from .contract import BoundaryValueProblem
from .equilibrium import Unknowns, equilibrium
from .posed import Posed
from .ribbon import Ribbon


def differentiated(ribbon: Ribbon, posed: Posed) -> BoundaryValueProblem:
    """Return the ODE of the states of the rod and the strains that the law leaves free."""
    _refuse_couples(ribbon)
    unknowns, law = Unknowns.of(ribbon), ribbon.law
    free = list(law.components)
    names = [f"u{i + 1}" for i in free]
    u = ca.SX.sym("u", len(free))
    if law.closed_moment:
        moment = law.implicit(unknowns.stress)
        g = ca.substitute(moment.equations, moment.unknowns, u)
    else:
        g = u - unknowns.section.u[free]
    rates = unknowns.rates(law.whole(u))
    change = ca.jtimes(g, unknowns.x, rates) + ca.jacobian(g, ribbon.position)
    slope = _solved(ca.jacobian(g, u), -change)

    def estimate(stress: Stress) -> ca.SX:
        return law.strain(stress)[free]

    return equilibrium(
        ribbon,
        unknowns,
        law.whole(u),
        more_states=dict(zip(names, ca.vertsplit(u), strict=True)),
        more_rates=slope,
        estimate=estimate,
        start_conditions={f"start: law along d{i + 1}": g[k] for k, i in enumerate(free)},
    )


def _refuse_couples(ribbon: Ribbon) -> None:
    """Raise ModelError where a moment acts at a single place: strains, states here, leap there."""
    for station in ribbon.stations:
        for action in station.actions:
            if action.leaps:
                raise ModelError(
                    f"formulation differentiated: {action.path}.moment makes the strains leap, "
                    "which are continuous states here; use formulation: inverted or algebraic",
                    f"{action.path}.moment",
                )


def _solved(matrix: ca.SX, right: ca.SX) -> ca.SX:
    """Solve two equations by Cramer's rule, more of them by elimination."""
    if right.numel() != 2:
        return ca.solve(matrix, right)
    (a, b), (c, d) = (ca.horzsplit(row) for row in ca.vertsplit(matrix))
    determinant = a * d - b * c
    return ca.vertcat(d * right[0] - b * right[1], a * right[1] - c * right[0]) / determinant
