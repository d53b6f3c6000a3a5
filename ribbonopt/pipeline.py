"""The path: scene, boundary-value problem, NLP, start, solver, solution, checks.

`solve(scene)` walks it once. `prepare(scene)` keeps what depends on the structure of a scene only,
so that other numbers (epsilon, loads, prescribed values, meshes) are solved without building again.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempts import Attempts
from ribbonopt.discretize import discretize
from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.guess import Guess, guess_of, initial_unknowns, words
from ribbonopt.mechanics.boundary import gap_between_ends
from ribbonopt.problem import BoundaryValueProblem, Ribbon, pose, theta_of
from ribbonopt.problem.examine import examine
from ribbonopt.scene import Scene, SolutionGuess, validate_scene
from ribbonopt.scene.units import in_special_units
from ribbonopt.skipped import skipped
from ribbonopt.solution import Solution
from ribbonopt.solvers import Status, solver_named
from ribbonopt.transcription import NLP, Mesh

if TYPE_CHECKING:
    from ribbonopt.solvers import Solver
    from ribbonopt.starts.automatic import Automatic


@dataclass(frozen=True, eq=False)
class Prepared:
    """A scene's structure, built: solves any scene that differs from it in numbers only.

    Scenes are in the user's units here; what is built of them is in units Dw = L = 1.
    """

    scene: Scene
    ribbon: Ribbon
    problem: BoundaryValueProblem
    nlp: NLP
    solver: Solver
    seconds: float

    def solve(
        self, scene: Scene | None = None, guess: Guess | None = None, *, fallback: bool = True
    ) -> Solution:
        """Solve a scene of this structure (default: the prepared one).

        Parameters
        ----------
        scene
            Numbers; must agree with the prepared scene in everything else.
        guess
            Where to start, instead of the scene's own guess.
        fallback
            Whether to go on from the automatic start where that leads nowhere.

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
        attempts = self._attempts(scene)
        self._try_all(attempts, guess, fallback)
        best = attempts.best
        if best is None:
            raise ConvergenceError(Status.NO_START.value, Status.NO_START.name.lower())
        best = self._refined(replace(best, path=tuple(attempts.path)))
        total = time.perf_counter() - started + self.seconds
        evaluate, linear = attempts.seconds
        timings = {
            "build": self.seconds,
            "evaluate": evaluate,
            "linear": linear,
            "rest": total - self.seconds - evaluate - linear,
            "total": total,
        }
        return replace(
            best,
            timings=timings,
            iterations=attempts.iterations,
            skipped=skipped(scene, self.problem, attempts.solvers),
        )

    def polish(self, guess: Guess) -> Solution:
        """Solve the prepared scene from one guess that is thought to be near."""
        attempts = self._attempts(self.scene)
        attempts.run(guess, quick=True)
        assert attempts.best is not None
        return self._refined(attempts.best)

    def _refined(self, solution: Solution) -> Solution:
        """Return a solution as accurate as its scene asks, if it asks."""
        tolerance = solution.scene.tolerance
        if tolerance is None or not solution.verified:
            return solution
        from ribbonopt.refinement import refine  # for scenes with a tolerance

        return refine(solution, tolerance, lambda widths: self._attempts(solution.scene, widths))

    def start(
        self, scene: Scene | None = None, guess: Guess | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the unknowns w of the guess and the parameters p = [theta, widths] of a scene."""
        scene = scene or self.scene
        p = self._parameters(scene)
        source = guess or self.guess(scene)
        return initial_unknowns(source, self.ribbon, self.problem, self.nlp.blocks, p), p

    def guess(self, scene: Scene | None = None) -> Guess:
        """Return the first guess for a scene: its own, or the first of the automatic start."""
        scene = in_special_units(scene or self.scene)
        own = self._own_guess(scene) or next(self.automatic.guesses(scene, []), None)
        if own is None:
            raise ConvergenceError(Status.NO_START.value, Status.NO_START.name.lower())
        return own

    @cached_property
    def automatic(self) -> Automatic:
        """What is built for the automatic start, when it is first needed."""
        from ribbonopt.starts.automatic import Automatic  # IPOPT, which many scenes do without

        return Automatic(in_special_units(self.scene))

    def _try_all(self, attempts: Attempts, given: Guess | None, fallback: bool) -> None:
        """Try the guess that is given or the scene's, then the automatic ones, until one leads on."""
        scene, path = in_special_units(attempts.scene), attempts.path
        started = time.perf_counter()
        own = given or self._own_guess(scene)
        if own is not None:
            step = "guess: given" if given else f"guess: {words(scene.guess)}"
            path.append({"step": step, "seconds": time.perf_counter() - started})
            if attempts.run(own) or not fallback:
                return
        first: Guess | None = None
        for guess in self.automatic.guesses(scene, path):
            if attempts.run(guess, quick=True):
                return
            first = first or guess
        if first is not None:
            attempts.run(first)  # all that was spared to be quick

    def _own_guess(self, scene: Scene) -> Guess | None:
        if isinstance(scene.guess, SolutionGuess):
            from ribbonopt.results import load_solution  # reading files costs imports

            return load_solution(scene.guess.solution)
        return guess_of(scene, self.ribbon)

    def _attempts(self, scene: Scene, widths: Array | None = None) -> Attempts:
        """Return the means to solve a scene, on its own mesh unless relative widths are given."""
        p = self._parameters(scene)
        if widths is None:
            return Attempts(scene, p, self.ribbon, self.problem, self.nlp, self.solver)
        theta = p[: len(p) - self.nlp.layout.element_count]
        nlp, solver = self._on(len(widths))
        return Attempts(scene, np.append(theta, widths), self.ribbon, self.problem, nlp, solver)

    def _on(self, count: int) -> tuple[NLP, Solver]:
        """Return NLP and solver on a number of elements, built once."""
        if count not in self._sizes:
            nlp = discretize(self.scene, self.problem, count)
            self._sizes[count] = nlp, _solver(self.scene, nlp)
        return self._sizes[count]

    @cached_property
    def _sizes(self) -> dict[int, tuple[NLP, Solver]]:
        return {self.nlp.layout.element_count: (self.nlp, self.solver)}

    def _parameters(self, scene: Scene) -> np.ndarray:
        """Parameters p = [theta, widths] of a scene of this structure."""
        values = theta_of(in_special_units(scene))
        same = tuple(values) == self.problem.parameter_names and all(
            getattr(scene, f.name) == getattr(self.scene, f.name)
            for f in fields(Scene)
            if f.name in ("formulation", "states", "transcription", "solver")
        )
        if not same or scene.law.type != self.scene.law.type:
            raise ModelError("this scene differs from the prepared one in more than its numbers")
        return np.append(list(values.values()), Mesh.uniform(scene.transcription.intervals).widths)


def solve(scene: Scene) -> Solution:
    """Solve a scene: the whole path once, or from as many `starts` as the scene says.

    Of several distinct equilibria the one of least energy is returned, with `others`.

    Raises
    ------
    ModelError
        If the conditions do not fit the unknowns.
    ConvergenceError
        If the prescribed ends cannot be reached. A solve that merely fails to converge returns a
        Solution whose status and message say so.
    """
    prepared = prepare(scene)
    solution = prepared.solve()
    if prepared.scene.starts == 1:
        return solution
    from ribbonopt.starts.several import equilibria  # few scenes ask for it

    posed = in_special_units(prepared.scene)
    return equilibria(posed, solution, prepared.automatic, prepared.polish)


def prepare(scene: Scene) -> Prepared:
    """Build everything of a scene that does not depend on its numbers."""
    started = time.perf_counter()
    scene = validate_scene(scene)
    posed = in_special_units(scene)
    ribbon, problem = pose(posed)
    examine(ribbon, problem, np.array(list(theta_of(posed).values())))
    nlp = discretize(scene, problem)
    solver = _solver(scene, nlp)
    solver.build()
    seconds = time.perf_counter() - started
    return Prepared(scene, ribbon, problem, nlp, solver, seconds)


def _solver(scene: Scene, nlp: NLP) -> Solver:
    options = {f.name: getattr(scene.solver, f.name) for f in fields(scene.solver)}
    return solver_named(options.pop("type"), nlp, options)


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
