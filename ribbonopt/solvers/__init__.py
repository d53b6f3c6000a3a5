"""Solvers: an NLP and a guess to numbers; they know nothing of what the unknowns mean."""

from .auto import Auto
from .ipopt import Ipopt
from .newton import Newton
from .status import SolveReport, Status

Solver = Auto | Ipopt | Newton

#: solvers by the name a scene gives them; their settings are those of the scene's classes
SOLVERS: dict[str, type[Auto] | type[Ipopt] | type[Newton]] = {
    "auto": Auto,
    "ipopt": Ipopt,
    "newton": Newton,
}

__all__ = ["SOLVERS", "Auto", "Ipopt", "Newton", "SolveReport", "Solver", "Status"]
