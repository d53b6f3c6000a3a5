"""The default: Newton where it is enough, IPOPT where it is not.

Square systems are tried by Newton's method first, which costs neither IPOPT's libraries nor the
sparse functions; what it cannot solve, and everything that is not square, goes to IPOPT.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription import NLP

from .newton import NewtonSolver
from .status import SolveReport

if TYPE_CHECKING:
    from .ipopt import IpoptSolver


@dataclass(frozen=True, eq=False)
class AutoSolver:
    """Newton, then IPOPT from the same guess if Newton did not converge; `neutral` as Newton's."""

    nlp: NLP
    neutral: bool = False

    @cached_property
    def newton(self) -> NewtonSolver:
        """First choice for square programs."""
        return NewtonSolver(self.nlp, neutral=self.neutral)

    @cached_property
    def ipopt(self) -> IpoptSolver:
        """For everything else."""
        from .ipopt import IpoptSolver  # often never needed

        return IpoptSolver(self.nlp)

    def build(self) -> None:
        """Build the first choice now rather than at the first solve."""
        (self.newton if self.nlp.square else self.ipopt).build()

    def solve(self, w: Array, p: Array, *, enough: float = 0.0) -> SolveReport:
        """Solve from the guess w (nw,) for the parameters p (np,), as far as is `enough`."""
        if not self.nlp.square:
            return self.ipopt.solve(w, p)
        first = self.newton.solve(w, p, enough=enough)
        if first.status.converged:
            return first
        return replace(self.ipopt.solve(w, p), earlier=(first,))
