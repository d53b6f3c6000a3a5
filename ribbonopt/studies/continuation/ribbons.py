"""Branches of equilibria as equations to be followed: one parameter of a scene is the position.

Each point is brought to the scene's tolerance on its own mesh; phases appear and vanish as sign
changes of m2 do. So a layout is a mesh and its phases.
"""

from __future__ import annotations

from dataclasses import field, replace
from typing import Any, NamedTuple

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt, verified
from ribbonopt.checks.zero_moment import unbent_share
from ribbonopt.classes import dataclass
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.trajectory import Trajectory
from ribbonopt.solvers.extended import ExtendedSystem
from ribbonopt.solvers.local import Local
from ribbonopt.solvers.newton import NewtonSolver
from ribbonopt.studies.buckling.twin import has_twin, twin_of, twin_scene
from ribbonopt.transcription import Mesh

from .buckled import StageBuckling
from .coordinates import metric_at, reduced, row_of
from .curve import Curve
from .finishing import elsewhere, finished
from .leaving import leaving
from .linearising import heading, linearised
from .passage import passage
from .trials import checked, trial_of, without_last
from .walk.departure import Departure
from .walk.linearised import Heading
from .walk.metric import Metric
from .walk.points import BUCKLING, POINT, Point, Special
from .walk.protocol import Passage, Trial
from .walk.special import special_points

RECENT = 4  # solutions whose metric is remembered
MOST = 20  # iterations of Newton's method: a step that needs more is too long


class Unbent(NamedTuple):
    """Whether m2 = m3 = 0 along a part of a trajectory."""

    there: bool


@dataclass(frozen=True, eq=False)
class RibbonEquations:
    """Equations of the equilibria along one curve; Newton's method on the mesh of the point before.

    Attributes
    ----------
    prepared : Prepared
        The structure.
    curve : Curve
        The scenes by position, and their equations.
    metric : Metric
        Arclength.
    """

    prepared: Prepared
    curve: Curve
    metric: Metric
    _kept: dict[str, Any] = field(default_factory=dict)  # the same for all metrics

    def measured(self, solution: Solution) -> RibbonEquations:
        """Return the same with the metric that fits a solution."""
        known: dict[Trajectory, RibbonEquations] = self._kept.setdefault("measured", {})
        if solution.trajectory not in known:
            if len(known) >= RECENT:
                known.pop(next(iter(known)))
            metric = metric_at(solution, self.curve)
            known[solution.trajectory] = replace(self, metric=metric)
        return known[solution.trajectory]

    def reduced(self, solution: Solution, vector: Array) -> Array:
        """States at both ends, constants of the rod and position, of a vector [w, l]."""
        return reduced(solution, vector)

    def linearise(self, solution: Solution, unknowns: Array, ahead: Array) -> Local:
        """Linearise at a solution with a row along the branch."""
        return linearised(self, solution, unknowns, ahead)

    def heading(self, solution: Solution, unknowns: Array, ahead: Array) -> Heading:
        """Return where the branch goes at a solution, from what estimates its error if possible."""
        return heading(self, solution, unknowns, ahead)

    def correct_at(self, origin: Solution, guess: Array) -> Trial[Solution]:
        """Correct at a position (natural continuation)."""
        attempt = self._beside(origin, float(guess[-1]))
        attempt.run_from(guess[:-1], quick=True, check=False)
        trial = trial_of(attempt, guess[-1:])
        if trial.converged or not (self.unbent(origin) and self.rod):
            return trial
        straight = self.rod.correct_at(origin, guess)
        found = attempt.restored(straight.unknowns[:-1])
        same = straight.converged and self.unbent(found)
        return replace(straight, solution=found) if same else trial

    def correct_along(
        self,
        origin: Point[Solution],
        direction: Array,
        arc: float,
        guess: Array,
        enough: float = 0.0,
    ) -> Trial[Solution]:
        """Correct where the projection on a direction is `arc` (pseudo-arclength continuation)."""
        solution = origin.solution
        line = self.curve.line(solution)
        row = row_of(solution, self.metric.dual(reduced(solution, direction)))
        value = float(row @ line.reduced(origin.unknowns)) + arc
        return self.correct_with(solution, row, value, guess, enough)

    def correct_with(
        self, solution: Solution, row: Array, value: float, guess: Array, enough: float = 0.0
    ) -> Trial[Solution]:
        """Correct where a row of states at the points, constants and position has a value."""
        line = self.curve.line(solution)
        system = ExtendedSystem(line, row, value)
        nlp = self._beside(solution, float(guess[-1])).nlp
        p, most = line.parameters(guess[-1]), MOST
        report = NewtonSolver(nlp).solve(guess, p, None, enough, system, most=most)
        attempt = self._beside(solution, float(report.w[-1]))
        attempt.take(without_last(report), check=False)
        return trial_of(attempt, report.w[-1:])

    def passed(
        self, point: Point[Solution], trial: Trial[Solution], expected: Array
    ) -> Passage[Solution] | None:
        """Return where phases must change before a trial; LinAlgError if no others lead on."""
        search = self.prepared.search(trial.solution.posed)
        if not search.phases_help or self.unbent(point.solution):
            return None
        return passage(self, point, trial, expected)

    def leaving(self, point: Point[Solution]) -> list[Point[Solution]]:
        """Return the first points on the branches that leave a kink, the main branch's first."""
        return [way.first for way in leaving(self, replace(point, kind=POINT))]

    def special(self, a: Point[Solution], b: Point[Solution]) -> Special[Solution]:
        """Return folds and branch points between two points of one layout."""
        return special_points(self, a, b)

    def crossings(self, a: Point[Solution], b: Point[Solution]) -> list[Point[Solution]]:
        """Return the buckling points between two points where m2 = m3 = 0 along the ribbon."""
        if not (self.unbent(a.solution) and self.unbent(b.solution)):
            return []
        return self.buckling.between(self, a, b)

    def uncounted(self, a: Solution, b: Solution, changes: int) -> str:
        """Say what change of the count of negative directions no special point explains."""
        if not self.curve.stage.stability:
            return ""
        from .counts import unexplained  # builds second derivatives

        return unexplained(a, b, changes)

    def departure(self, point: Point[Solution]) -> Departure[Solution] | None:
        """Return the infinitesimal deflection at a buckling point, None at others."""
        return self.buckling.departure(self, point) if point.kind == BUCKLING else None

    @property
    def buckling(self) -> StageBuckling:
        """Buckling loads of straight states, found when they are first asked for."""
        if "buckling" not in self._kept:
            self._kept["buckling"] = StageBuckling(self.prepared, self.curve)
        found: StageBuckling = self._kept["buckling"]
        return found

    @property
    def rod(self) -> RibbonEquations | None:
        """The same with a linear law, where straight states have a linearisation."""
        if "rod" not in self._kept:
            self._kept["rod"] = None
            if has_twin(self.prepared.ribbon.law, self.curve.scene, self.curve.name):
                curve = Curve(twin_scene(self.curve.scene), self.curve.stage)
                twin = twin_of(curve.scene_at(curve.start))
                self._kept["rod"] = RibbonEquations(twin, curve, self.metric)
        found: RibbonEquations | None = self._kept["rod"]
        return found

    def finer(self, origin: Solution, unknowns: Array) -> tuple[Solution, Array] | None:
        """Return a solution of known unknowns on halved elements, None without a tolerance."""
        if self.curve.scene.tolerance is None:
            return None
        mesh = Mesh(tuple(np.repeat(widths / 2, 2) for widths in origin.mesh.phases))
        search = self.prepared.search(self.curve.posed_at(float(unknowns[-1])))
        found = self.restored(origin, unknowns)
        attempt = search.on_mesh(origin.sheets, mesh, found.trajectory.ends[1:-1])
        w = attempt.unknowns(found)
        return attempt.restored(w), np.append(w, unknowns[-1])

    def enough(self, error: float, position: float) -> bool:
        """Whether the position of a special point is as exact as asked."""
        tolerance = self.curve.scene.tolerance
        return tolerance is None or self.curve.relative(error, position) <= tolerance

    def restored(self, origin: Solution, unknowns: Array) -> Solution:
        """Return a solution of known unknowns on the mesh and in the phases of another."""
        return self._beside(origin, float(unknowns[-1])).restored(unknowns[:-1])

    def verified(self, trial: Trial[Solution]) -> Trial[Solution]:
        """Return a trial that converged, after the checks of a solution."""
        return checked(trial, verified(trial.solution, self.prepared.ribbon))

    def finished(self, origin: Point[Solution], trial: Trial[Solution]) -> Trial[Solution]:
        """Return a solution verified, to tolerance, in the phases it needs."""
        return finished(self, origin, trial)

    def elsewhere(self, origin: Point[Solution], position: float) -> Trial[Solution] | None:
        """Solve at a position with all that a single scene may need, from a solution near by."""
        return elsewhere(self, origin.solution, position)

    def unbent(self, solution: Solution) -> bool:
        """Whether m2 = m3 = 0 along a part of a solution."""
        known = solution.trajectory.found
        if Unbent not in known:
            known[Unbent] = Unbent(unbent_share(solution, self.prepared.ribbon.law) > 0)
        return bool(known[Unbent].there)

    def _beside(self, solution: Solution, position: float) -> Attempt:
        """Return the means to solve at a position, on the mesh and in the phases of a solution."""
        search = self.prepared.search(self.curve.posed_at(position))
        return search.on_mesh(solution.sheets, solution.mesh, solution.trajectory.ends[1:-1])
