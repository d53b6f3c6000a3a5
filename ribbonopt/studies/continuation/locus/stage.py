"""A stage that follows a locus: it begins at the special point where the stage before stopped."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import ConvergenceError
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.solution.solution import Solution

from ..recorded import Recorder
from ..walk.points import BUCKLING, Point
from ..walk.protocol import Trial
from .begun import begun
from .buckling import BucklingEquations
from .equations import LocusEquations
from .laid import Laid
from .records import LocusRecords
from .surface import Surface


@dataclass(frozen=True, eq=False)
class LocusStage:
    """One stage; `before` and `special` are the last point of the stage before, and where it ended.

    On the mesh of the former the locus begins: that of the latter is much finer.
    """

    prepared: Prepared
    surface: Surface
    recorder: Recorder
    before: Point[Solution] | None
    special: Point[Solution] | None

    @property
    def range(self) -> Surface:
        """Where it goes."""
        return self.surface

    @property
    def ways(self) -> tuple[Surface, ...]:
        """The same in each direction from where it begins."""
        return self.surface.ways

    @property
    def records(self) -> LocusRecords:
        """What is recorded of its points."""
        return LocusRecords(self.recorder, self.surface, self._beside)

    def _beside(self, solution: Solution, unknowns: Array) -> Solution:
        """Return a solution of unknowns (n + 2,) on the mesh and in the phases of another."""
        search = self.prepared.search(self.surface.posed_at(*map(float, unknowns[-2:])))
        attempt = search.on_mesh(solution.sheets, solution.mesh, solution.trajectory.ends[1:-1])
        return attempt.restored(unknowns[:-2])

    @property
    def switch(self) -> int:
        """No branches are followed from a locus."""
        return 0

    @property
    def kind(self) -> str:
        """Of the special points that the locus is of."""
        assert self.surface.stage.of is not None
        return self.surface.stage.of

    @property
    def missing(self) -> str:
        """Why there is nothing to begin with; "" where there is."""
        if self.special is not None and self.special.kind == self.kind:
            return ""
        if self.surface.stage.branch is not None:
            return ""  # which is read when it is wanted
        low, high = self.surface.between
        other = self.surface.other
        number = self.surface.stage.number
        which, found = f"no {self.kind}", "none was"
        if number > 1:
            which, found = f"no {self.kind} number {number}", "fewer were"
        return (
            f"{which} to begin the locus with: {found} found on the branch from {other} = {low:g} "
            f"to {high:g}; choose another range or kind, or follow the branch alone to see what it "
            "has"
        )

    def first(self) -> tuple[Solution, Array]:
        """Find where it begins: the special point, as a point of the locus.

        Raises
        ------
        ConvergenceError
            If it is not found so.
        SceneError
            If a saved branch is none to begin with.
        """
        special, before = self.special, self.before
        if self.surface.stage.branch is not None:
            before, special = begun(self.surface, self.prepared)
        assert special is not None and before is not None
        if self.kind == BUCKLING:
            return self._begun(self._buckling(special.solution), special)
        l2 = self.surface.begin
        l1 = float(special.row[self.surface.other])
        # On a branch by the logarithm of l1 its tangent is by that too.
        rate = 1.0 if l1 == special.position else l1 * np.log(10)
        positions = np.array([l1, l2])
        search = self.prepared.search(self.surface.posed_at(*map(float, positions)))
        like = before.solution
        attempt = search.on_mesh(like.sheets, like.mesh, like.trajectory.ends[1:-1])

        def moved(w: Array) -> Array:
            """Put unknowns of the special point on the mesh of the point before."""
            there = search.on_mesh(special.solution.sheets, special.solution.mesh)
            return attempt.unknowns(there.restored(w))

        w, tangent = special.unknowns[:-1], special.tangent
        h = 1e-4
        ahead = (moved(w + h * tangent[:-1]) - moved(w - h * tangent[:-1])) / (2 * h)
        guess = np.append(moved(w), positions)
        start = attempt.restored(guess[:-2])
        across = np.concatenate([ahead, [rate * tangent[-1], 0.0]])
        start.trajectory.found[Laid] = Laid(np.zeros_like(guess), across)
        equations = self._of_tests(start)
        trial = equations.correct_at(start, guess)
        if trial.converged:
            tangent = equations.laid(trial.solution).tangent
            point = Point(trial.solution, trial.unknowns, tangent, 0.0, 1.0)
            trial = equations.finished(point, trial)
        return self._told(trial, special)

    def equations(self, first: Solution) -> LocusEquations | BucklingEquations:
        """Return its equations, with the metric of a stage that begins at a solution."""
        if self.kind == BUCKLING:
            return self._buckling(first)
        return self._of_tests(first)

    def _of_tests(self, first: Solution) -> LocusEquations:
        unknowns = np.append(first.dense.w, self.surface.positions_of(first.scene))
        metric = self.surface.metric_at(first, unknowns)
        return LocusEquations(self.prepared, self.surface, self.kind, metric)

    def _buckling(self, first: Solution) -> BucklingEquations:
        return BucklingEquations(self.prepared, self.surface, first)

    def _begun(
        self, equations: BucklingEquations, special: Point[Solution]
    ) -> tuple[Solution, Array]:
        """Return the buckling load that the branch has found, with its mode."""
        place = np.array([special.position, self.surface.begin])
        guess = np.concatenate([special.unknowns[:-1], place])
        trial = equations.correct_at(special.solution, guess)
        return self._told(equations.verified(trial) if trial.converged else trial, special)

    def _told(self, trial: Trial[Solution], special: Point[Solution]) -> tuple[Solution, Array]:
        """Return what was found; ConvergenceError if nothing was."""
        if trial.converged:
            return trial.solution, trial.unknowns
        raise ConvergenceError(
            f"the {self.kind} at {self.surface.other} = {special.position:.6g} was not found "
            f"as a point of its locus: {trial.message}",
            "not_converged",
        )
