"""The path: scene, boundary-value problem, NLP, start, solver, solution, phases, mesh, checks.

`solve(scene)` walks it once. `prepare(scene)` keeps what depends on the structure of a scene only,
so that other numbers (epsilon, loads, prescribed values, meshes) are solved without building again.
"""

from __future__ import annotations

import time
from dataclasses import field
from functools import cached_property, partial
from typing import TYPE_CHECKING

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import verified
from ribbonopt.attempt.structure import Structure
from ribbonopt.checks.zero_moment import unbent_share
from ribbonopt.classes import dataclass
from ribbonopt.errors import ConvergenceError
from ribbonopt.guess import Guess
from ribbonopt.problem import BoundaryValueProblem, Posed, Ribbon, formulation_name
from ribbonopt.problem.wellposed.examine import examine, refuse_idle_settings, refuse_unreachable
from ribbonopt.scene import Scene, validate_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status
from ribbonopt.text import one_line, shortened
from ribbonopt.transcription import NLP

from .given import own_guess, saved, step_of
from .neighbour import Latest, Neighbour
from .once import completed, no_start, solve_posed
from .search import Search
from .told import of_finer_mesh, of_starts

if TYPE_CHECKING:
    from ribbonopt.solvers import Solver
    from ribbonopt.starts.automatic import Automatic


@dataclass(frozen=True, eq=False)
class Prepared:
    """A scene's structure, built: solves any scene that differs from it in numbers only.

    Scenes are in the user's units here; `posed` of them may be given in their place, so that one is
    posed once. What is built is in units Dw = L = 1.
    """

    structure: Structure
    seconds: float
    _latest: Latest = field(default_factory=Latest)

    @property
    def scene(self) -> Scene:
        """The scene it was built for."""
        return self.structure.posed.given

    def __repr__(self) -> str:
        """Say what it is in one line."""
        scene = self.scene
        name, law = (shortened(one_line(text), 40) for text in (scene.name, scene.law.type))
        return f"<Prepared {name}: law {law}, {formulation_name(scene)} formulation, built>"

    @property
    def ribbon(self) -> Ribbon:
        """Mechanics."""
        return self.structure.ribbon

    @property
    def problem(self) -> BoundaryValueProblem:
        """Equations, in one phase."""
        return self.structure.problem

    @property
    def nlp(self) -> NLP:
        """The program on the scene's own number of intervals."""
        return self.structure.on(self.structure.mesh(None).elements)[0]

    @property
    def solver(self) -> Solver:
        """The solver of `nlp`."""
        return self.structure.on(self.structure.mesh(None).elements)[1]

    def posed(self, scene: Scene | Posed | None = None) -> Posed:
        """Return a scene (default: the prepared one) posed."""
        if scene is None or scene is self.scene:
            return self.structure.posed
        return scene if isinstance(scene, Posed) else self.structure.posed.moved(scene)

    def solve(
        self,
        scene: Scene | Posed | None = None,
        guess: Guess | None = None,
        *,
        fallback: bool = True,
        quick: bool = False,
    ) -> Solution:
        """Solve a scene of this structure (default: the prepared one).

        `guess` is where to start, instead of the scene's own guess; `fallback` whether to go on
        from the automatic start where that leads nowhere; `quick` whether to leave it at Newton's
        method from the guess, where that can be. Where a scene has a tolerance, mesh and phases
        of a solution near by are kept as in a batch, and the factors of the one found last or of
        that which it was found from.

        Raises
        ------
        ModelError
            If the scene has another structure than the prepared one.
        ConvergenceError
            If the prescribed ends are further apart than the ribbon is long.
        """
        posed = self.posed(scene)
        refuse_unreachable(posed)
        if not quick and isinstance(known := guess or saved(posed), Solution):
            near = self._latest.beside(known, posed, self, step_of(guess, posed))
            if near is not None:
                return near
        found = solve_posed(self, prepare, posed, guess, fallback=fallback, quick=quick)
        if found.status is Status.TOLERANCE_MISSED and guess is None:
            from ribbonopt.pipeline.refinement import on_finer_mesh  # after a failure only

            found = of_finer_mesh(found, on_finer_mesh(found, lambda s: prepare(s).solve_once()))
        return self._latest.keep(Neighbour(self, found))

    def solve_once(self) -> Solution:
        """Solve the prepared scene on its own number of intervals, and on no finer mesh anew."""
        posed = self.structure.posed
        return solve_posed(self, prepare, posed, None, fallback=True, quick=False)

    def polish(self, guess: Guess, scene: Scene | Posed | None = None) -> Solution:
        """Solve a scene (default: the prepared one) from one guess that is thought to be near."""
        started = time.perf_counter()
        search = self.search(scene)
        done = search.run_smooth(guess) if isinstance(guess, Solution) else search.run(guess)
        return completed(search, self, prepare, started, done=done)

    def search(self, scene: Scene | Posed | None = None) -> Search:
        """Return a search for solutions of a scene of this structure; nothing is solved."""
        return Search(self.posed(scene), self.structure)

    def refined(
        self, solution: Solution, spare: float = 1.0, search: Search | None = None
    ) -> Solution:
        """Return a verified solution of this structure on a mesh that meets its tolerance.

        A new mesh is fine enough for `spare` times the usual aim. A search for the solution's
        scene, if given, remembers what it took.
        """
        tolerance = solution.scene.tolerance
        if tolerance is None or not solution.verified:
            return solution
        if unbent_share(solution, self.ribbon.law):
            return solution if solution.verification.known else verified(solution, self.ribbon)
        from ribbonopt.pipeline.refinement import AIM, refine  # for scenes with a tolerance

        on_mesh = partial((search or self.search(solution.posed)).on_mesh, solution.sheets)
        return refine(solution, tolerance, self.ribbon, on_mesh, spare * AIM)

    def start(self, guess: Guess | None = None) -> tuple[Array, Array]:
        """Return the unknowns w of a guess for the prepared scene, and its parameters p."""
        attempt = self.structure.attempt(self.structure.posed)
        return attempt.unknowns(guess or self.guess()), attempt.p

    def guess(self, scene: Scene | Posed | None = None) -> Guess:
        """Return the first guess for a scene: its own, or the first of the automatic start."""
        search = self.search(scene)
        own = own_guess(search.posed, self.ribbon)
        own = own or next(self.automatic.guesses(search.posed, search.ledger), None)
        if own is None:
            raise no_start()
        return own

    @cached_property
    def automatic(self) -> Automatic:
        """What is built for the automatic start, when it is first needed."""
        from ribbonopt.starts.automatic import Automatic  # IPOPT, which many scenes do without

        return Automatic(self.structure.posed, self.structure)


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
    if prepared.scene.starts == 1:
        return prepared.solve()
    from ribbonopt.starts.equilibria import equilibria  # few scenes ask for it

    refuse_unreachable(prepared.posed())
    first, failed = None, no_start()
    try:
        first = prepared.solve()
    except ConvergenceError as error:  # other starts may lead somewhere
        failed = error
    found = equilibria(prepared.posed(), first, prepared.automatic, prepared.polish)
    if found is None:
        raise failed
    return of_starts(first, found)


def prepare(scene: Scene | Posed) -> Prepared:
    """Build what any solve of a scene needs and its numbers do not change.

    One that is posed already is valid: in units Dw = L = 1 it may be none that a user could write.
    """
    started = time.perf_counter()
    posed = scene if isinstance(scene, Posed) else Posed.of(validate_scene(scene))
    structure = Structure.of(posed)
    refuse_idle_settings(posed, structure.ribbon)
    examine(structure.ribbon, structure.problem, posed)
    # In phases nothing may be solved without them: what a search needs it builds.
    structure.build(now=not Search(posed, structure).phases_help)
    return Prepared(structure, time.perf_counter() - started)
