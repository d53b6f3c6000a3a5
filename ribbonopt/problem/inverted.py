"""The inverted formulation, eq. (4.5): strains from moments, an ordinary differential equation."""

from __future__ import annotations

from .contract import BoundaryValueProblem
from .equilibrium import Unknowns, equilibrium
from .posed import Posed
from .ribbon import Ribbon


def inverted(ribbon: Ribbon, posed: Posed) -> BoundaryValueProblem:
    """Return the boundary-value problem x' = f*(x) of a ribbon: no algebraic variable, no cost."""
    unknowns = Unknowns.of(ribbon)
    return equilibrium(ribbon, unknowns, unknowns.section.u)
