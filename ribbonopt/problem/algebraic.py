"""The differential-algebraic formulation, eq. (3.1): u2 and u3 are unknowns along the ribbon.

The law is the algebraic equation, with |eta| <= 1 as a path inequality where it is needed to keep
the solution on the allowed branch; `formulation: {type: algebraic, bounds: false}` leaves it out
(a square system, which Newton solves, and which may converge to forbidden solutions).
"""

from __future__ import annotations

import casadi as ca

from ribbonopt.scene import Algebraic, Scene

from .contract import BoundaryValueProblem
from .equilibrium import Unknowns, equilibrium
from .ribbon import Ribbon


def algebraic(ribbon: Ribbon, scene: Scene) -> BoundaryValueProblem:
    """Return the semi-explicit DAE x' = f(x, u), 0 = g(x, u) of a ribbon."""
    unknowns = Unknowns.of(ribbon)
    law = ribbon.law.implicit(unknowns.m2, unknowns.m3)
    local = ca.SX.sym("m", 2)
    bounded = not isinstance(scene.formulation, Algebraic) or scene.formulation.bounds
    u2, u3 = law.unknowns[0], law.unknowns[1]
    return equilibrium(
        ribbon,
        unknowns,
        (u2, u3),
        ribbon.model.rates(unknowns.x, unknowns.section.rod, ca.vertcat(0, u2, u3)),
        algebraic=law.unknowns,
        equations=law.equations,
        path=law.bounds if bounded else None,
        algebraic_start=law.estimate,
        estimate=(local, ribbon.law.implicit(local[0], local[1]).estimate),
    )
