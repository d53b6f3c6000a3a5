"""How a solve ended; the value of each member is the message a user reads, remedy included."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

if TYPE_CHECKING:
    from .protocols import Factors


class Status(Enum):
    """End of a solve: name for programs, value for people."""

    CONVERGED = "converged"
    MAX_ITERATIONS = (
        "the iterations ran out before convergence: start from a nearer guess (a saved solution "
        "at an easier parameter), or raise solver.max_iterations"
    )
    STALLED = (
        "the steps became too small to reduce the residual: start from a nearer guess, refine the "
        "mesh (transcription.intervals), or use solver: {type: ipopt}"
    )
    SINGULAR = (
        "the linearised equations are singular: the conditions leave the ribbon free to move, or "
        "the guess sits where the law is not differentiable (m = 0); prescribe what is free, or "
        "change the guess"
    )
    INFEASIBLE = (
        "no point satisfies all the equations near the last iterate: check that the conditions can "
        "be met together, or start from another guess"
    )
    INVALID_NUMBER = (
        "the equations gave a number that is not finite: start from another guess, or regularise "
        "the law"
    )
    NOT_SQUARE = (
        "Newton's method solves equations only: use solver: {type: ipopt} for costs, bounds and "
        "inequalities"
    )
    WRONG_SOLUTION = (
        "the equations are solved, but not the problem the scene states: start from another guess, "
        "or refine the mesh"
    )
    NO_START = (
        "no equilibrium was found to start from, from any shape that fits the ends: give a guess, "
        "or bring the ends to an easier place first"
    )
    REGULARIZED = (
        "no equilibrium of the law asked for was found that is valid everywhere; this is one of "
        "the smooth law (variational), near which it should be"
    )
    TOLERANCE_MISSED = (
        "the equations are solved, but the error of the answer is larger than the tolerance: start "
        "on more intervals or a higher degree (transcription), or raise the tolerance; where the "
        "law is nearly Sadowsky's and m2 changes sign, law: sadowsky itself is easier"
    )
    ROUNDED = (
        "the equations are solved, but rounding leaves the answer an error larger than the "
        "tolerance, and finer meshes do not help: raise the tolerance"
    )
    UNREACHABLE = "the ends are further apart than the ribbon is long: bring them together"

    @property
    def converged(self) -> bool:
        """Whether the nonlinear equations are solved."""
        return self in (
            Status.CONVERGED,
            Status.WRONG_SOLUTION,
            Status.REGULARIZED,
            Status.TOLERANCE_MISSED,
            Status.ROUNDED,
        )

    @property
    def failure(self) -> str:
        """What a solve gave instead of a solution, in a word; nothing where it gave one."""
        words = {
            Status.CONVERGED: "",
            Status.WRONG_SOLUTION: "wrong-solution",
            Status.REGULARIZED: "regularized",
            Status.TOLERANCE_MISSED: "tolerance-missed",
            Status.ROUNDED: "tolerance-missed",
        }
        return words.get(self, "not-converged")


@dataclass(frozen=True, eq=False)
class SolveReport:
    """What a solver returns.

    Attributes
    ----------
    status : Status
        How it ended.
    w : (nw,) array
        Last iterate, converged or not.
    multipliers : (ng,) array
        Lagrange multipliers of the constraints (zeros where the solver has none).
    residuals : (ng,) array
        Constraint values at w.
    iterations, factorizations : int
        Iterations, and matrices factored.
    evaluate, linear, total : float
        Seconds spent in function evaluation, in linear algebra (for IPOPT: everything of its own,
        mostly linear algebra), and in all.
    solver : str
        Name of the solver.
    earlier : tuple of SolveReport
        Reports of solvers that were tried before this one and failed.
    factors : Factors or None
        Last factors of the Jacobian, where the solver keeps them.
    """

    status: Status
    w: Array
    multipliers: Array
    residuals: Array
    iterations: int
    factorizations: int
    evaluate: float
    linear: float
    total: float
    solver: str
    earlier: tuple[SolveReport, ...] = ()
    factors: Factors | None = None

    @property
    def tried(self) -> tuple[SolveReport, ...]:
        """Reports of all solvers that were tried, in order."""
        return (*self.earlier, self)
