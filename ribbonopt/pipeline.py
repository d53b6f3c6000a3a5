"""The path: scene, boundary-value problem, NLP, solver, solution, checks.

`solve(scene)` walks it once. `prepare(scene)` keeps what depends on the structure of a scene only,
so that other numbers (epsilon, loads, prescribed values, meshes) are solved without building again.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import casadi as ca
import numpy as np

from ribbonopt.accuracy.resistance import where_it_resists
from ribbonopt.accuracy.verify import unverified, verify
from ribbonopt.discretize import discretize
from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.guess import ConstantStrains, Guess, IntegratedLoads, initial_unknowns
from ribbonopt.mechanics.boundary import gap_between_ends
from ribbonopt.problem import BoundaryValueProblem, Ribbon, pose, theta_of
from ribbonopt.problem.examine import examine
from ribbonopt.scene import LoadGuess, Scene, StrainGuess, validate_scene
from ribbonopt.solution import Solution
from ribbonopt.solvers import SolveReport, Status, solver_named
from ribbonopt.transcription import NLP, Mesh

if TYPE_CHECKING:
    from ribbonopt.solvers import Solver


@dataclass(frozen=True, eq=False)
class Prepared:
    """A scene's structure, built: solves any scene that differs from it in numbers only."""

    scene: Scene
    ribbon: Ribbon
    problem: BoundaryValueProblem
    nlp: NLP
    solver: Solver
    seconds: float

    def solve(self, scene: Scene | None = None, guess: Guess | None = None) -> Solution:
        """Solve a scene of this structure (default: the prepared one).

        Parameters
        ----------
        scene
            Numbers; must agree with the prepared scene in everything else.
        guess
            Where to start, instead of the scene's own guess.

        Raises
        ------
        ModelError
            If the scene has another structure.
        ConvergenceError
            If the prescribed ends are further apart than the ribbon is long.
        """
        started = time.perf_counter()
        scene = scene or self.scene
        refuse_unreachable(scene)
        w, p = self.start(scene, guess)
        guessed = time.perf_counter()
        report = self.solver.solve(w, p)
        if report.status.converged and self.problem.recovered:
            p = self._with_recovered(report, p)
        solution = Solution(
            scene=scene,
            problem=self.problem,
            dense=self.nlp.blocks.dense(report.w, p),
            status=report.status,
            message=report.status.value,
            iterations=sum(attempt.iterations for attempt in report.attempts),
            verification=unverified(),
            multipliers=report.multipliers,
            path=(
                {"step": f"guess: {_words(scene.guess)}", "seconds": guessed - started},
                *(self._step(attempt) for attempt in report.attempts),
            ),
            skipped=skipped(
                scene, self.problem, tuple(attempt.solver for attempt in report.attempts)
            ),
        )
        if report.status.converged:
            solution = _verified(solution, self.ribbon)
        else:
            where = where_it_resists(report.residuals, self.nlp.layout, solution)
            solution = replace(solution, message=f"{report.status.value}. {where}")
        total = time.perf_counter() - started + self.seconds
        evaluate = sum(attempt.evaluate for attempt in report.attempts)
        linear = sum(attempt.linear for attempt in report.attempts)
        timings = {
            "build": self.seconds,
            "evaluate": evaluate,
            "linear": linear,
            "rest": total - self.seconds - evaluate - linear,
            "total": total,
        }
        return replace(solution, timings=timings)

    def start(
        self, scene: Scene | None = None, guess: Guess | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the unknowns w of the guess and the parameters p = [theta, widths] of a scene."""
        scene = scene or self.scene
        mesh = Mesh.uniform(scene.transcription.intervals)
        p = np.concatenate([self._theta(scene), mesh.widths])
        source = guess or _guess(scene, self.ribbon)
        return initial_unknowns(source, self.ribbon, self.problem, self.nlp.blocks, p), p

    def _with_recovered(self, report: SolveReport, p: np.ndarray) -> np.ndarray:
        """Parameters with those put in that follow from the costates."""
        problem, layout = self.problem, self.nlp.layout
        inputs = [problem.points[0], problem.costate, problem.parameters]
        function = ca.Function("recover", inputs, [ca.vertcat(*problem.recovered.values())])
        nodes, _, _ = layout.unpack(report.w)
        theta = p[: problem.parameters.numel()]
        values = function(nodes[0], layout.start_costate(report.multipliers), theta)
        where = [problem.parameter_names.index(name) for name in problem.recovered]
        result: np.ndarray = p.copy()
        result[where] = np.array(values).ravel()
        return result

    def _step(self, attempt: SolveReport) -> dict[str, Any]:
        name, count = self.nlp.blocks.name, self.nlp.layout.element_count
        outcome = "" if attempt.status.converged else f" ({attempt.status.name.lower()})"
        return {
            "step": f"{attempt.solver}, {name} on {count} intervals{outcome}",
            "iterations": attempt.iterations,
            "seconds": attempt.total,
        }

    def _theta(self, scene: Scene) -> np.ndarray:
        values = theta_of(scene)
        same = tuple(values) == self.problem.parameter_names and all(
            getattr(scene, f.name) == getattr(self.scene, f.name)
            for f in fields(Scene)
            if f.name in ("formulation", "states", "transcription", "solver")
        )
        if not same or scene.law.type != self.scene.law.type:
            raise ModelError("this scene differs from the prepared one in more than its numbers")
        return np.array(list(values.values()))


def solve(scene: Scene) -> Solution:
    """Solve a scene: the whole path once.

    Raises
    ------
    ModelError
        If the conditions do not fit the unknowns.
    ConvergenceError
        If the prescribed ends cannot be reached. A solve that merely fails to converge returns a
        Solution whose status and message say so.
    """
    return prepare(scene).solve()


def prepare(scene: Scene) -> Prepared:
    """Build everything of a scene that does not depend on its numbers."""
    started = time.perf_counter()
    scene = validate_scene(scene)
    ribbon, problem = pose(scene)
    examine(ribbon, problem, np.array(list(theta_of(scene).values())))
    nlp = discretize(scene, problem)
    options = {f.name: getattr(scene.solver, f.name) for f in fields(scene.solver)}
    solver = solver_named(options.pop("type"), nlp, options)
    solver.build()
    seconds = time.perf_counter() - started
    return Prepared(scene, ribbon, problem, nlp, solver, seconds)


def skipped(
    scene: Scene, problem: BoundaryValueProblem, solvers: tuple[str, ...] = ()
) -> tuple[str, ...]:
    """Say what a scene does not need and what is therefore not made, each with its reason.

    `solvers` are those that were used; before a solve, none.
    """
    result = []
    if scene.states == "reduced":
        result.append("force and moment as states (no loads: n is constant, m follows from r)")
        result.append("nine director components (a unit quaternion carries the frame)")
    if all(phase.cost is None for phase in problem.phases):
        result.append("second derivatives (nothing is minimised)")
    if problem.square and scene.solver.type != "ipopt" and "ipopt" not in solvers:
        result.append("IPOPT and the sparse Jacobian (Newton condenses element by element)")
    result.append("mesh refinement and further formulations (not asked for)")
    return tuple(result)


def _verified(solution: Solution, ribbon: Ribbon) -> Solution:
    verification = verify(solution, ribbon)
    solution = replace(solution, verification=verification)
    if not verification.problems:
        return solution
    message = f"{Status.WRONG_SOLUTION.value}. " + "; ".join(verification.problems)
    return replace(solution, status=Status.WRONG_SOLUTION, message=message)


def _guess(scene: Scene, ribbon: Ribbon) -> Guess:
    if isinstance(scene.guess, LoadGuess):
        return IntegratedLoads(ribbon, scene, scene.guess)
    if isinstance(scene.guess, StrainGuess):
        return ConstantStrains(ribbon, scene, scene.guess.strains)
    from ribbonopt.results import load_solution  # reading files costs imports

    return load_solution(scene.guess.solution)


def _words(guess: Any) -> str:
    if isinstance(guess, LoadGuess):
        return "force and moment integrated from the start"
    if isinstance(guess, StrainGuess):
        return "constant strains"
    return f"saved solution {guess.solution}"


def refuse_unreachable(scene: Scene) -> None:
    """Raise ConvergenceError if the prescribed ends are further apart than the ribbon is long."""
    gap, length = gap_between_ends(scene), scene.interval[1] - scene.interval[0]
    if gap > length * (1 + 1e-12):
        raise ConvergenceError(
            f"unreachable: the prescribed positions of the ends are {gap:.6g} apart "
            f"(boundary.start.position, boundary.end.position), the ribbon is {length:.6g} long "
            "(interval); bring them together or lengthen the ribbon",
            status=Status.UNREACHABLE.name.lower(),
        )
