"""Solvers: an NLP and a guess to numbers; they know nothing of what the unknowns mean.

IPOPT is imported when first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ribbonopt.transcription import NLP

from .auto import AutoSolver
from .newton import NewtonSolver
from .status import SolveReport, Status

if TYPE_CHECKING:
    from .ipopt import IpoptSolver

    Solver = AutoSolver | IpoptSolver | NewtonSolver

__all__ = [
    "AutoSolver",
    "IpoptSolver",
    "NewtonSolver",
    "SolveReport",
    "Solver",
    "Status",
    "solver_named",
]


def solver_named(name: str, nlp: NLP, settings: dict[str, Any], *, neutral: bool = False) -> Solver:
    """Return the solver of a name (auto, ipopt, newton) on an NLP, with its settings.

    `neutral` as `NewtonSolver` has it.
    """
    if name == "ipopt":
        from .ipopt import IpoptSolver

        return IpoptSolver(nlp, **settings)
    kind = NewtonSolver if name == "newton" else AutoSolver
    return kind(nlp, **settings, neutral=neutral)


def __getattr__(name: str) -> Any:
    if name == "IpoptSolver":
        from .ipopt import IpoptSolver

        return IpoptSolver
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
