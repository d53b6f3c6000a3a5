"""From a solved ribbon to one whose numbers differ little: everything that is near enough is kept.

Mesh and phases, the unknowns (continued along the last step from ribbon to ribbon), and the factors
of the Jacobian, which serve as long as Newton's method contracts with them: a ribbon then costs a
few evaluations of its equations.
"""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from ribbonopt.accuracy.compared import mesh_to_begin
from ribbonopt.accuracy.estimate import analyse
from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.classes import dataclass
from ribbonopt.problem import Posed
from ribbonopt.scene import Scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.protocols import Factors

from .means import Means
from .search import Search
from .spare import SPARE
from .told import with_costs

FARTHEST = 2.0  # times the step before, that it is continued


@dataclass(frozen=True, eq=False)
class Neighbour:
    """A solved ribbon that others of its structure start from.

    Attributes
    ----------
    prepared : Means
        The structure, built.
    solution : Solution
        The ribbon, verified.
    factors, finer : factors or None
        Of its equations, and of those that estimate the error; of a ribbon near by at least.
    before : Solution or None
        The ribbon that it was solved from, if that is on the same mesh.
    """

    prepared: Means
    solution: Solution
    factors: Factors | None = None
    finer: Factors | None = None
    before: Solution | None = None

    def solve(self, scene: Scene | Posed) -> Neighbour | None:
        """Return a verified solution of another scene of this structure; None if none is near.

        Where the mesh or the phases do not do, they are made anew from the shape.
        """
        posed = self.prepared.posed(scene)
        beside = self.beside(self.prepared.search(posed))
        if beside is not None:
            return beside
        anew = self.prepared.solve(posed, self.solution, fallback=False, quick=True)
        return Neighbour(self.prepared, anew) if anew.verified else None

    def beside(self, search: Search) -> Neighbour | None:
        """Return what a search for another scene of this structure finds in these phases.

        On this mesh, or from it on a finer one; None if there is none so near.
        """
        old = self.solution
        attempts = search.on_mesh(old.sheets, mesh_to_begin(old), old.trajectory.ends[1:-1])
        if not self._run(attempts) or attempts.best is None or not _in_order(attempts.best):
            return None
        found = attempts.best
        if not found.sheets and search.phases_help and search.better_in_phases(found):
            return None
        steps = tuple(search.ledger.steps)
        finer = self._finer(found, served=attempts.factorizations == 0)
        refined = self.prepared.refined(found, SPARE, search)
        if refined.verified and refined.trajectory is not found.trajectory:
            factors = None if search.last is None else search.last.factors
            told = replace(refined, steps=(*steps, *refined.steps))
            return Neighbour(self.prepared, told, factors)
        if refined.verified and attempts.check():
            told = replace(attempts.best, steps=steps)
            return Neighbour(self.prepared, told, attempts.factors, finer, old)
        return None

    def solve_at_any_cost(self, scene: Scene | Posed) -> Solution:
        """Return a solution of another scene of this structure, by all that a guess may lead to."""
        return self.prepared.solve(scene, guess=self.solution, fallback=False)

    def _run(self, attempts: Attempt) -> bool:
        old = self.solution
        if not _same_meaning(attempts, old):
            return attempts.run(old, quick=True, check=False)
        w = self._continued(attempts.p)
        return attempts.run_from(w, quick=True, check=False, factors=self.factors)

    def _continued(self, p: Array) -> Array:
        """Unknowns (nw,) for other parameters on this mesh: what the last step was, once more."""
        here = self.solution.dense
        if self.before is None:
            return here.w
        there = self.before.dense
        step, wanted = here.theta - there.theta, p[: len(here.theta)] - here.theta
        length = float(step @ step)
        share = float(wanted @ step) / length if length > 0 else 0.0
        if not abs(share) <= FARTHEST:
            return here.w
        continued: Array = here.w + share * (here.w - there.w)
        return continued

    def _finer(self, found: Solution, served: bool) -> Factors | None:
        """Analyse a solution; return the factors of that, if they are worth to be kept."""
        if found.problem.recovered:
            return None
        try:
            # Where the factors of the equations had to be made anew, those are not near either.
            return analyse(found, self.finer if served else None, keep=served).factors
        except np.linalg.LinAlgError:
            return None


class Latest:
    """The solution found last and the one that it was found from: of these alone factors are kept.

    For whoever goes on from either, from one to the next or from one to many.
    """

    def __init__(self) -> None:
        """Begin without any."""
        self._kept: tuple[Neighbour, ...] = ()

    def keep(self, found: Neighbour, origin: Neighbour | None = None) -> Solution:
        """Keep what was found, if it is a solution, and what it was found from; return that."""
        if origin is not None and found.before is not None:  # on the same mesh: they serve both
            origin = replace(origin, factors=found.factors, finer=found.finer)
        kept = (found, origin) if found.solution.verified else ()
        self._kept = tuple(each for each in kept if each is not None)
        return found.solution

    def beside(self, guess: Solution, posed: Posed, prepared: Means, step: str) -> Solution | None:
        """Return a scene's solution beside one that is kept, or that has a mesh; None if none is.

        Nor without a tolerance: the answer is to be on the mesh that is asked for then. `step` is
        what to call the guess.
        """
        if posed.scene.tolerance is None:
            return None
        kept = (each for each in self._kept if each.solution is guess)
        origin = next(kept, None) or _of_mesh(guess, posed, prepared)
        if origin is None:
            return None
        started, search = time.perf_counter(), origin.prepared.search(posed)
        search.ledger.note(step, 0.0)
        found = origin.beside(search)
        if found is None:
            return None
        search.ledger.spare("a pass on the scene's own mesh (the guess has one for its tolerance)")
        if search.ledger.reports and not search.ledger.reports[0].factorizations:
            search.ledger.spare("factors of the equations (those of the guess serve)")
        told = with_costs(found.solution, search, origin.prepared, started)
        return self.keep(replace(found, solution=told), origin)


def _of_mesh(guess: Solution, posed: Posed, prepared: Means) -> Neighbour | None:
    """Return a solution to begin with on its own mesh, if that is one for a tolerance."""
    same = guess.verified and guess.posed.structure == posed.structure
    met = same and guess.scene.tolerance is not None
    return Neighbour(prepared, guess) if met else None


def _in_order(found: Solution) -> bool:
    """Whether all phases have a length: where one has not, others are needed, and no bar is."""
    return bool((np.diff(found.trajectory.ends) > 0).all())


def _same_meaning(attempts: Attempt, old: Solution) -> bool:
    """Whether unknowns can be taken as they are: moments are about a point of reference."""
    names = attempts.problem.parameter_names
    where = [names.index(f"reference.{axis}") for axis in "xyz"]
    same = attempts.nlp.blocks is old.dense.blocks
    return same and bool((attempts.p[where] == old.dense.theta[where]).all())
