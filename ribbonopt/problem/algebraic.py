"""The differential-algebraic formulation, eq. (3.1): the strains are unknowns along the ribbon.

The law is the algebraic equation, with |eta| <= 1 as a path inequality where it is needed to keep
the solution on the allowed branch; `formulation: {type: algebraic, bounds: false}` leaves it out
(a square system, which Newton solves, and which may converge to forbidden solutions).
"""

from __future__ import annotations

import casadi as ca

from ribbonopt.mechanics.laws.law import Stress
from ribbonopt.scene import Algebraic

from .contract import BoundaryValueProblem
from .equilibrium import Unknowns, equilibrium
from .posed import Posed
from .ribbon import Ribbon


def algebraic(ribbon: Ribbon, posed: Posed) -> BoundaryValueProblem:
    """Return the semi-explicit DAE x' = f(x, u), 0 = g(x, u) of a ribbon."""
    unknowns, formulation = Unknowns.of(ribbon), posed.scene.formulation
    law = ribbon.law.implicit(unknowns.stress)
    bounded = not isinstance(formulation, Algebraic) or formulation.bounds

    def estimate(stress: Stress) -> ca.SX:
        return ribbon.law.implicit(stress).estimate

    return equilibrium(
        ribbon,
        unknowns,
        ribbon.law.whole(law.unknowns[: len(ribbon.law.components)]),
        algebraic=law.unknowns,
        equations=law.equations,
        path=law.bounds if bounded else None,
        algebraic_start=law.estimate,
        estimate=estimate,
    )
