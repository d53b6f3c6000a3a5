"""Solvers: an NLP and a guess to numbers; they know nothing of what the unknowns mean.

IPOPT is imported when first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ribbonopt.transcription import NLP

from .auto import Auto
from .newton import Newton
from .status import SolveReport, Status

if TYPE_CHECKING:
    from .ipopt import Ipopt

    Solver = Auto | Ipopt | Newton

__all__ = ["Auto", "Ipopt", "Newton", "SolveReport", "Solver", "Status", "solver_named"]


def solver_named(name: str, nlp: NLP, settings: dict[str, Any]) -> Solver:
    """Return the solver of a name (auto, ipopt, newton) on an NLP, with its settings."""
    if name == "ipopt":
        from .ipopt import Ipopt

        return Ipopt(nlp, **settings)
    return Newton(nlp, **settings) if name == "newton" else Auto(nlp, **settings)


def __getattr__(name: str) -> Any:
    if name == "Ipopt":
        from .ipopt import Ipopt

        return Ipopt
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
