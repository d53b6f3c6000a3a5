"""Solvers: an NLP and a guess to numbers; they know nothing of what the unknowns mean."""

from .ipopt import Ipopt
from .newton import Newton
from .status import SolveReport, Status

Solver = Ipopt | Newton

#: solvers by the name a scene gives them; their settings are those of the scene's classes
SOLVERS: dict[str, type[Ipopt] | type[Newton]] = {"ipopt": Ipopt, "newton": Newton}

__all__ = ["SOLVERS", "Ipopt", "Newton", "SolveReport", "Solver", "Status"]
