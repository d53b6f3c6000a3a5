"""An attempt at one scene on one mesh: from one guess after another, the best is kept."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ribbonopt.arrays import Array
from ribbonopt.checks.verify import verify
from ribbonopt.classes import dataclass
from ribbonopt.guess import Guess, initial_unknowns
from ribbonopt.problem import BoundaryValueProblem, Posed, Ribbon
from ribbonopt.solution.made import solution_at, solution_of
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import SolveReport, Status
from ribbonopt.solvers.auto import AutoSolver
from ribbonopt.solvers.newton import NewtonSolver
from ribbonopt.transcription import NLP, Mesh

from .ledger import Ledger

if TYPE_CHECKING:
    from ribbonopt.solvers import Solver
    from ribbonopt.solvers.protocols import Factors


UNSEEN = 1e-2  # of the tolerance
LEAST = 1e-10  # what verification asks of the conditions is a hundred times that


@dataclass(eq=False)
class Attempt:
    """The means to solve one posed scene, and what has come of them.

    Attributes
    ----------
    posed, p : Posed, (np,) array
        What is asked, and its parameters [theta, widths].
    ribbon, problem, nlp, solver
        The structure that was built for it.
    sheets : tuple of int
        Kinds of the phases; empty for the law as it is.
    switches : (k,) array or None
        Fractions of the length where phases meet in the guesses.
    ledger : Ledger
        Where costs are entered.
    best : Solution or None
        The one nearest to what is asked.
    """

    posed: Posed
    p: Array
    ribbon: Ribbon
    problem: BoundaryValueProblem
    nlp: NLP
    solver: Solver
    sheets: tuple[int, ...]
    switches: Array | None
    ledger: Ledger
    best: Solution | None = None
    _unchecked: bool = False
    _last: SolveReport | None = None

    def run(self, guess: Guess, *, quick: bool = False, check: bool = True) -> bool:
        """Solve from one guess; return whether there is a verified solution now.

        `quick` leaves it at Newton's method where the solver is `auto` and the equations square.
        Without `check`, what converges counts as verified: for steps on the way to a solution.
        """
        return self.run_from(self.unknowns(guess), quick=quick, check=check)

    def unknowns(self, guess: Guess) -> Array:
        """Unknowns (nw,) of the program that stand for a guess."""
        parts = self.ribbon, self.problem, self.nlp.blocks, self.p, self.switches
        return initial_unknowns(guess, *parts)

    def run_from(
        self,
        w: Array,
        *,
        quick: bool = False,
        check: bool = True,
        factors: Factors | None = None,
        most: int | None = None,
        loose: float = 0.0,
    ) -> bool:
        """Solve from unknowns w (nw,); see `run`.

        Newton's method may begin with given `factors`, take `most` iterations, and stop at a last
        step that is `loose`, relative.
        """
        solver, enough = self.solver, max(self.enough, loose)
        if quick and isinstance(solver, AutoSolver) and self.nlp.square:
            solver = solver.newton
        if isinstance(solver, NewtonSolver):
            report = solver.solve(w, self.p, enough=enough, factors=factors, most=most)
        else:
            report = solver.solve(w, self.p, enough=self.enough)
        return self.take(report, check=check)

    def run_slowly(self, guess: Guess, *, check: bool = True) -> bool:
        """Solve by what a solver has beside Newton's method, which led nowhere from a guess.

        False at once where it has nothing else.
        """
        if not (isinstance(self.solver, AutoSolver) and self.nlp.square):
            return False
        return self.take(self.solver.ipopt.solve(self.unknowns(guess), self.p), check=check)

    def take(self, report: SolveReport, *, check: bool = True) -> bool:
        """Take what a solver found; return whether there is a verified solution now."""
        name, count = self.nlp.blocks.name, self.nlp.layout.element_count
        phases = f" in {len(self.sheets)} phases" if self.sheets else ""
        self.ledger.enter(report, f"{name} on {count} intervals{phases}")
        self._last = report
        solution = self._solution(report, check)
        if self.best is None or _merit(solution) > _merit(self.best):
            self.best, self._unchecked = solution, not check
        return self.best.verified

    def restored(self, w: Array) -> Solution:
        """Return a solution from its unknowns w (nw,), which were verified when they were found."""
        parts = self.posed, self.problem, self.nlp
        return solution_at(*parts, w, self.p, sheets=self.sheets)

    def check(self) -> bool:
        """Verify the best solution, if that was left out; return whether it is verified now."""
        if self.best is not None and self.best.verified and self._unchecked:
            self.best, self._unchecked = verified(self.best, self.ribbon), False
        return self.best is not None and self.best.verified

    @property
    def mesh(self) -> Mesh:
        """The mesh that this is on."""
        widths = self.nlp.blocks.widths(self.p)
        return Mesh(tuple(widths[part] for part in self.nlp.layout.phase_slices))

    @property
    def enough(self) -> float:
        """Last step of Newton's method, relative, that does not show in the answer."""
        tolerance = self.posed.scene.tolerance
        return 0.0 if tolerance is None else min(UNSEEN * tolerance, LEAST)

    @property
    def factors(self) -> Factors | None:
        """Factors of the Jacobian at the last solution, or near it; None if they were not kept."""
        return None if self._last is None else self._last.factors

    @property
    def factorizations(self) -> int:
        """Matrices factored by the last solver."""
        return 0 if self._last is None else sum(r.factorizations for r in self._last.tried)

    @property
    def iterations(self) -> int:
        """Iterations of the last solver."""
        return 0 if self._last is None else sum(r.iterations for r in self._last.tried)

    def _solution(self, report: SolveReport, check: bool) -> Solution:
        parts = self.posed, self.problem, self.nlp, report, self.p, self.sheets
        solution = solution_of(*parts)
        if not report.status.converged:
            from .resistance import where_it_resists  # only a failure pays for it

            where = where_it_resists(report.residuals, self.nlp.layout, solution)
            return replace(solution, message=f"{report.status.value}. {where}")
        return verified(solution, self.ribbon) if check else solution


def verified(solution: Solution, ribbon: Ribbon) -> Solution:
    """Return a converged solution after verification, with a status that says how it went."""
    verification = verify(solution, ribbon)
    solution = replace(solution, verification=verification)
    if not verification.problems:
        return solution
    message = f"{Status.WRONG_SOLUTION.value}. " + "; ".join(verification.problems)
    return replace(solution, status=Status.WRONG_SOLUTION, message=message)


def _merit(solution: Solution) -> int:
    """How near to a solution: verified, of other equations, or none."""
    return 2 * solution.verified + solution.status.converged
