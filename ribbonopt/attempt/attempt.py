"""Attempts at one scene, one guess after another: the best so far, and what all have cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from ribbonopt.arrays import Array
from ribbonopt.checks.verify import verify
from ribbonopt.guess import Guess, initial_unknowns
from ribbonopt.problem import BoundaryValueProblem, Ribbon
from ribbonopt.scene import Scene
from ribbonopt.solution.from_report import solution_of
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.trajectory import Trajectory
from ribbonopt.solution.verification import unverified
from ribbonopt.solvers import SolveReport, Status
from ribbonopt.solvers.auto import AutoSolver
from ribbonopt.solvers.newton import NewtonSolver
from ribbonopt.transcription import NLP

from .resistance import where_it_resists

if TYPE_CHECKING:
    from ribbonopt.solvers import Solver
    from ribbonopt.solvers.protocols import Factors


UNSEEN = 1e-2  # of the tolerance
LEAST = 1e-10  # what verification asks of the conditions is a hundred times that


@dataclass(eq=False)
class Attempts:
    """What has been tried on one scene.

    Attributes
    ----------
    scene, p : Scene, (np,) array
        What is asked, and its parameters [theta, widths].
    ribbon, problem, nlp, solver
        The structure that was built for it.
    sheets : tuple of int
        Kinds of the phases; empty for the law as it is.
    switches : (k,) array or None
        Fractions of the length where phases meet in the guesses.
    path : list of mappings
        Steps so far, with their cost.
    best : Solution or None
        The one nearest to what is asked.
    """

    scene: Scene
    p: Array
    ribbon: Ribbon
    problem: BoundaryValueProblem
    nlp: NLP
    solver: Solver
    sheets: tuple[int, ...] = ()
    switches: Array | None = None
    path: list[Mapping[str, Any]] = field(default_factory=list)
    best: Solution | None = None
    _unchecked: bool = False
    _reports: list[SolveReport] = field(default_factory=list)

    def run(self, guess: Guess, *, quick: bool = False, check: bool = True) -> bool:
        """Solve from one guess; return whether there is a verified solution now.

        `quick` leaves it at Newton's method where the solver is `auto` and the equations square.
        Without `check`, what converges counts as verified: for steps on the way to a solution.
        """
        parts = self.ribbon, self.problem, self.nlp.blocks, self.p, self.switches
        return self.run_from(initial_unknowns(guess, *parts), quick=quick, check=check)

    def run_from(
        self,
        w: Array,
        *,
        quick: bool = False,
        check: bool = True,
        factors: Factors | None = None,
    ) -> bool:
        """Solve from unknowns w (nw,); see `run`. Newton's method may begin with given factors."""
        solver = self.solver
        if quick and isinstance(solver, AutoSolver) and self.nlp.square:
            solver = solver.newton
        if factors is not None and isinstance(solver, NewtonSolver):
            report = solver.solve(w, self.p, enough=self.enough, factors=factors)
        else:
            report = solver.solve(w, self.p, enough=self.enough)
        return self.take(report, check=check)

    def take(self, report: SolveReport, *, check: bool = True) -> bool:
        """Take what a solver found; return whether there is a verified solution now."""
        self.path += [self._step(attempt) for attempt in report.attempts]
        self._reports += report.attempts
        solution = self._solution(report, check)
        if self.best is None or _merit(solution) > _merit(self.best):
            self.best, self._unchecked = solution, not check
        return self.best.verified

    def restored(self, w: Array) -> Solution:
        """Return a solution from its unknowns w (nw,), which were verified when they were found."""
        return Solution(
            scene=self.scene,
            trajectory=Trajectory(self.problem, self.nlp.output(w, self.p)),
            status=Status.CONVERGED,
            message=Status.CONVERGED.value,
            iterations=0,
            verification=unverified(),
            sheets=self.sheets,
        )

    def check(self) -> bool:
        """Verify the best solution, if that was left out; return whether it is verified now."""
        if self.best is not None and self.best.verified and self._unchecked:
            self.best, self._unchecked = verified(self.best, self.ribbon), False
        return self.best is not None and self.best.verified

    @property
    def enough(self) -> float:
        """Last step of Newton's method, relative, that does not show in the answer."""
        tolerance = self.scene.tolerance
        return 0.0 if tolerance is None else min(UNSEEN * tolerance, LEAST)

    @property
    def factors(self) -> Factors | None:
        """Factors of the Jacobian at the last solution, or near it; None if they were not kept."""
        return self._reports[-1].factors if self._reports else None

    @property
    def factorizations(self) -> int:
        """Matrices factored by all attempts."""
        return sum(report.factorizations for report in self._reports)

    @property
    def iterations(self) -> int:
        """Iterations of all attempts."""
        return sum(report.iterations for report in self._reports)

    @property
    def solvers(self) -> tuple[str, ...]:
        """Names of the solvers used."""
        return tuple(report.solver for report in self._reports)

    @property
    def seconds(self) -> tuple[float, float]:
        """Seconds of function evaluation and of linear algebra."""
        reports = self._reports
        return sum(r.evaluate for r in reports), sum(r.linear for r in reports)

    def _solution(self, report: SolveReport, check: bool) -> Solution:
        parts = self.scene, self.problem, self.nlp, report, self.p, self.sheets
        solution = solution_of(*parts)
        if not report.status.converged:
            where = where_it_resists(report.residuals, self.nlp.layout, solution)
            return replace(solution, message=f"{report.status.value}. {where}")
        return verified(solution, self.ribbon) if check else solution

    def _step(self, attempt: SolveReport) -> dict[str, Any]:
        name, count = self.nlp.blocks.name, self.nlp.layout.element_count
        outcome = "" if attempt.status.converged else f" ({attempt.status.name.lower()})"
        phases = f" in {len(self.sheets)} phases" if self.sheets else ""
        return {
            "step": f"{attempt.solver}, {name} on {count} intervals{phases}{outcome}",
            "iterations": attempt.iterations,
            "seconds": attempt.total,
        }


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
