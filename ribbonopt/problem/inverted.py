"""The inverted formulation, eq. (4.5): strains from moments, an ordinary differential equation."""

from __future__ import annotations

import casadi as ca

from ribbonopt.scene import Scene

from .contract import BoundaryValueProblem
from .equilibrium import Unknowns, equilibrium
from .ribbon import Ribbon


def inverted(ribbon: Ribbon, scene: Scene) -> BoundaryValueProblem:
    """Return the boundary-value problem x' = f*(x) of a ribbon: no algebraic variable, no cost."""
    unknowns = Unknowns.of(ribbon)
    u2, u3 = unknowns.section.u2, unknowns.section.u3
    rates = ribbon.model.rates(unknowns.x, unknowns.section.rod, ca.vertcat(0, u2, u3))
    return equilibrium(ribbon, unknowns, (u2, u3), rates)
