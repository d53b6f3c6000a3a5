"""The path: scene, boundary-value problem, NLP, start, solver, solution, phases, mesh, checks.

`solve(scene)` walks it once. `prepare(scene)` keeps what depends on the structure of a scene only,
so that other numbers (epsilon, loads, prescribed values, meshes) are solved without building again.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.attempt.structure import Built
from ribbonopt.errors import ConvergenceError
from ribbonopt.guess import Guess, guess_of, initial_unknowns, words
from ribbonopt.problem import BoundaryValueProblem, Ribbon, pose, theta_values
from ribbonopt.problem.wellposed.examine import examine, refuse_idle_settings, refuse_unreachable
from ribbonopt.scene import Scene, SolutionGuess, validate_scene
from ribbonopt.scene.units import in_special_units
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status
from ribbonopt.transcription import NLP

from .search import Search
from .skipped import skipped

if TYPE_CHECKING:
    from ribbonopt.solvers import Solver
    from ribbonopt.starts.automatic import Automatic


@dataclass(frozen=True, eq=False)
class Prepared:
    """A scene's structure, built: solves any scene that differs from it in numbers only.

    Scenes are in the user's units; what is built of them in units Dw = L = 1.
    """

    built: Built
    seconds: float
    _phased: dict[tuple[int, ...], Built] = field(default_factory=dict)

    @property
    def scene(self) -> Scene:
        """The scene it was built for."""
        return self.built.scene

    @property
    def ribbon(self) -> Ribbon:
        """Mechanics."""
        return self.built.ribbon

    @property
    def problem(self) -> BoundaryValueProblem:
        """Equations, in one phase."""
        return self.built.problem

    @property
    def nlp(self) -> NLP:
        """The program on the scene's own number of intervals."""
        return self.built.on((self.scene.transcription.intervals,))[0]

    @property
    def solver(self) -> Solver:
        """The solver of `nlp`."""
        return self.built.on((self.scene.transcription.intervals,))[1]

    def solve(
        self,
        scene: Scene | None = None,
        guess: Guess | None = None,
        *,
        fallback: bool = True,
        quick: bool = False,
    ) -> Solution:
        """Solve a scene of this structure (default: the prepared one).

        `guess` is where to start, instead of the scene's own guess; `fallback` whether to go on
        from the automatic start where that leads nowhere; `quick` whether to leave it at Newton's
        method from the guess, where that can be.

        Raises
        ------
        ModelError
            If the scene has another structure than the prepared one.
        ConvergenceError
            If the prescribed ends are further apart than the ribbon is long.
        """
        scene = scene or self.scene
        refuse_unreachable(scene)
        found = self._once(scene, guess, fallback, quick)
        if found.status is Status.TOLERANCE_MISSED and guess is None:
            from .refinement import on_finer_mesh  # after a failure only

            found = on_finer_mesh(found, lambda s: prepare(s)._once(s, None, True, False))
        return found

    def polish(self, guess: Guess, scene: Scene | None = None) -> Solution:
        """Solve a scene (default: the prepared one) from one guess that is thought to be near."""
        started = time.perf_counter()
        search = self.search(scene or self.scene)
        _ = search.run_smooth(guess) if isinstance(guess, Solution) else search.run(guess)
        return self._with_costs(search, time.perf_counter() - started)

    def search(self, scene: Scene) -> Search:
        """Return a search for solutions of a scene of this structure; nothing is solved yet."""
        return Search(scene, self.built, self._phased)

    def refined(
        self, solution: Solution, spare: float = 1.0, search: Search | None = None
    ) -> Solution:
        """Return a verified solution of this structure on a mesh that meets its tolerance.

        A new mesh is fine enough for `spare` times the usual aim. A search for the solution's
        scene, if given, remembers what it took.
        """
        scene = solution.scene
        if scene.tolerance is None or not solution.verified:
            return solution
        from .refinement import AIM, refine  # for scenes with a tolerance

        on_mesh = partial((search or self.search(scene)).on_mesh, solution.sheets)
        return refine(solution, scene.tolerance, self.ribbon, on_mesh, spare * AIM)

    def start(self, guess: Guess | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Return the unknowns w of a guess for the scene and its parameters p = [theta, widths]."""
        p = self.built.attempts(self.scene).p
        source = guess or self.guess()
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

    def _once(self, scene: Scene, guess: Guess | None, fallback: bool, quick: bool) -> Solution:
        started = time.perf_counter()
        search = self.search(scene)
        self._try_all(search, guess, fallback, quick)
        return self._with_costs(search, time.perf_counter() - started)

    def _try_all(self, search: Search, given: Guess | None, fallback: bool, quick: bool) -> None:
        """Try the guess given or the scene's, then the automatic ones, until one leads on."""
        scene = in_special_units(search.scene)
        started = time.perf_counter()
        own = given or self._own_guess(scene)
        if own is not None:
            step = "guess: given" if given else f"guess: {words(scene.guess)}"
            search.path.append({"step": step, "seconds": time.perf_counter() - started})
            if search.run(own, quick=quick) or not fallback:
                return
        first: Guess | None = None
        for guess in self.automatic.guesses(scene, search.path):
            if isinstance(guess, Solution):
                done = search.run_smooth(guess)
            else:
                done = search.run(guess, quick=True)
            if done:
                return
            first = first or guess
        if first is not None and not search.needs_phases:
            search.run(first)  # all that was spared to be quick

    def _finished(self, search: Search) -> Solution | None:
        """Return the best solution found, on a mesh that meets the scene's tolerance."""
        best = search.best
        if best is None:
            return None
        best = replace(best, path=tuple(search.path))
        wrong = not best.verified or (search.jumps(best) and not best.sheets)
        if wrong and search.needs_phases and search.smooth:
            return self._regularized(best, search.smooth[-1]) or best
        return self.refined(best)

    def _with_costs(self, search: Search, seconds: float) -> Solution:
        """Return the best solution found, with what it has cost."""
        best = self._finished(search)
        if best is None:
            raise ConvergenceError(Status.NO_START.value, Status.NO_START.name.lower())
        return replace(
            best,
            timings=search.timings(self.seconds, seconds),
            iterations=search.iterations,
            skipped=skipped(search.scene, self.problem, search.solvers, best.sheets),
        )

    def _regularized(self, best: Solution, smooth: Solution) -> Solution | None:
        """Return the equilibrium of the smooth law, labelled: none was found of the exact one."""
        scene = replace(best.scene, law=smooth.scene.law, switching="off", guess="auto", starts=1)
        found = prepare(scene).solve(guess=smooth, fallback=False)
        if not found.verified:
            return None
        path, status = (*best.path, *found.path), Status.REGULARIZED
        return replace(found, status=status, message=status.value, path=path)

    def _own_guess(self, scene: Scene) -> Guess | None:
        if isinstance(scene.guess, SolutionGuess):
            from ribbonopt.output.results import load_solution  # reading files costs imports

            return load_solution(scene.guess.solution)
        return guess_of(scene, self.ribbon)


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
    from ribbonopt.starts.equilibria import equilibria  # few scenes ask for it

    return equilibria(
        in_special_units(prepared.scene), solution, prepared.automatic, prepared.polish
    )


def prepare(scene: Scene) -> Prepared:
    """Build everything of a scene that does not depend on its numbers."""
    started = time.perf_counter()
    scene = validate_scene(scene)
    posed = in_special_units(scene)
    ribbon, problem = pose(posed)
    refuse_idle_settings(scene, ribbon, problem)
    examine(ribbon, problem, theta_values(posed))
    prepared = Prepared(Built(scene, ribbon, problem), time.perf_counter() - started)
    prepared.solver.build()
    return replace(prepared, seconds=time.perf_counter() - started)
