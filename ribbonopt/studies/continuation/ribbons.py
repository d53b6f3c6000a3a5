"""Branches of equilibria as equations to be followed: one parameter of a scene is the position.

Each point is brought to the scene's tolerance on its own mesh; phases appear and vanish as sign
changes of m2 do. So a layout is a mesh and its phases.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ribbonopt.accuracy.estimate import relative_error
from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt, verified
from ribbonopt.checks.arcs import changed_phases
from ribbonopt.checks.stability import negative_directions, negative_range
from ribbonopt.checks.zero_moment import unbent_share
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import SolveReport, Status
from ribbonopt.solvers.extended import ExtendedSystem, Local, local
from ribbonopt.solvers.newton import NewtonSolver
from ribbonopt.studies.buckling.twin import has_twin, twin_of, twin_scene
from ribbonopt.studies.spare import SPARE
from ribbonopt.transcription import Mesh

from .along import NEXT_TO_FOLD, error_along
from .buckled import StageBuckling
from .curve import Curve
from .walk.metric import Metric
from .walk.points import BUCKLING, POINT, Point
from .walk.protocol import Trial

GENTLE = 0.3  # share of the position in the tangent, from where on no fold is near
STEEP = 0.1  # of the error at a given position: one along the branch that tells of a fold
NEXT_TO_CROSSING = "next to where branches cross: the error is above the tolerance"


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

    def measured(self, solution: Solution) -> RibbonEquations:
        """Return the same with the metric that fits a solution."""
        return replace(self, metric=metric_at(solution, self.curve))

    def reduced(self, solution: Solution, vector: Array) -> Array:
        """States at both ends, constants of the rod and position, of a vector [w, l]."""
        return reduced(solution, vector)

    def linearise(self, solution: Solution, unknowns: Array, ahead: Array) -> Local:
        """Linearise at a solution with a row along the branch."""
        row = row_of(solution, self.metric.dual(ahead))
        there, unbent = (solution.dense.w, float(unknowns[-1])), self._unbent(solution)
        try:
            found = local(self.curve.line(solution), row, *there)
        except np.linalg.LinAlgError:
            if not (unbent and self._rod):
                raise
            line = self._rod.curve.line(self._rod.restored(solution, unknowns))
            found = local(line, row, *there)
        if solution.problem.slack:
            # Conditions with slack keep a ribbon in its phases: their zeros are no branch points.
            return replace(found, sign=1.0)
        # Its determinant would be that of the law's guard.
        return replace(found, sign=0.0) if unbent else found

    def correct_at(self, origin: Solution, guess: Array) -> Trial[Solution]:
        """Correct at a position (natural continuation)."""
        attempt = self._beside(origin, float(guess[-1]))
        attempt.run_from(guess[:-1], quick=True, check=False)
        trial = _trial(attempt, guess[-1:])
        if trial.converged or not (self._unbent(origin) and self._rod):
            return trial
        straight = self._rod.correct_at(origin, guess)
        found = attempt.restored(straight.unknowns[:-1])
        same = straight.converged and self._unbent(found)
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
        system = ExtendedSystem(line, row, value)
        nlp = self._beside(solution, origin.position).nlp
        report = NewtonSolver(nlp).solve(guess, line.parameters(guess[-1]), None, enough, system)
        attempt = self._beside(solution, float(report.w[-1]))
        attempt.take(_without_last(report), check=False)
        return _trial(attempt, report.w[-1:])

    def crossings(self, a: Point[Solution], b: Point[Solution]) -> list[Point[Solution]]:
        """Return the buckling points between two points where m2 = m3 = 0 along the ribbon."""
        if not (self._unbent(a.solution) and self._unbent(b.solution)):
            return []
        return self.buckling.between(self, a, b)

    def uncounted(self, a: Solution, b: Solution, changes: int) -> str:
        """Say what change of the count of negative directions no special point explains."""
        if not self.curve.stage.stability:
            return ""
        before, after = negative_directions(a), negative_directions(b)
        if before is None or after is None:
            return ""
        if _explained(abs(after - before), changes):
            return ""
        # Next to special points one direction is nearly neutral: it may be counted or not.
        ranges = [negative_range(solution) for solution in (a, b)]
        first, second = (range(r[0], r[1] + 1) if r else range(0) for r in ranges)
        if any(_explained(abs(m - n), changes) for m in first for n in second):
            return ""
        return f"a change of the count of negative directions from {before} to {after}"

    def departure(self, point: Point[Solution]) -> Array | None:
        """Return the infinitesimal deflection at a buckling point, None at others."""
        if point.kind != BUCKLING:
            return None
        attempt = self._beside(point.solution, point.position)
        direction = self.buckling.direction(attempt, point)
        return np.asarray(direction / self.metric.length(reduced(point.solution, direction)))

    @cached_property
    def buckling(self) -> StageBuckling:
        """Buckling loads of straight states, found when they are first asked for."""
        return StageBuckling(self.prepared, self.curve)

    @cached_property
    def _rod(self) -> RibbonEquations | None:
        """The same with a linear law, where straight states have a linearisation."""
        if not has_twin(self.prepared.ribbon.law, self.curve.name):
            return None
        curve = Curve(twin_scene(self.curve.scene), self.curve.stage)
        return RibbonEquations(twin_of(curve.scene_at(curve.start)), curve, self.metric)

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
        return _checked(trial, verified(trial.solution, self.prepared.ribbon))

    def finished(self, origin: Point[Solution], trial: Trial[Solution]) -> Trial[Solution]:
        """Return a solution verified, to tolerance, in the phases it needs."""
        found, note = trial.solution, ""
        tolerance = found.scene.tolerance
        if not found.sheets and self._needs_phases(found):
            found = self.prepared.solve(found.posed, guess=found, fallback=False)
        elif self._unbent(found):  # no error can be told of it
            found = verified(found, self.prepared.ribbon)
        elif tolerance is not None and relative_error(found)[0] > tolerance:
            found, note = self._refined(origin, trial, tolerance)
        else:
            found = verified(found, self.prepared.ribbon)
        note = "; ".join(filter(None, [note, changed_phases(origin.solution.sheets, found.sheets)]))
        if origin.kind != POINT and found.status in (Status.ROUNDED, Status.TOLERANCE_MISSED):
            # Where branches cross rounding is magnified: the row says how exact it is.
            found = replace(found, status=Status.CONVERGED, message=Status.CONVERGED.value)
            note = "; ".join(filter(None, [note, NEXT_TO_CROSSING]))
        done = replace(_checked(trial, found), note=note)
        if not done.converged and self.prepared.ribbon.law.kinked:
            # Phases may have changed on the way.
            return self._anew(origin.solution, float(trial.unknowns[-1])) or done
        return done

    def _refined(
        self, origin: Point[Solution], trial: Trial[Solution], tolerance: float
    ) -> tuple[Solution, str]:
        """Return a solution verified, as exact as asked for; next to a fold, along the branch."""
        solution, position = trial.solution, float(trial.unknowns[-1])
        ahead = self.metric.dual(self.reduced(origin.solution, origin.tangent))
        if abs(origin.tangent[-1]) > GENTLE * self.metric.sizes[-1]:
            return self.prepared.refined(solution, SPARE), ""
        for _ in range(2):
            error = error_along(solution, self.curve, position, row_of(solution, ahead))
            if error <= min(tolerance, STEEP * relative_error(solution)[0]):
                return verified(solution, self.prepared.ribbon), NEXT_TO_FOLD
            solution = self.prepared.refined(solution, SPARE)
            if solution.verified:
                break
        return solution, ""

    def elsewhere(self, origin: Point[Solution], position: float) -> Trial[Solution] | None:
        """Solve at a position in other phases: one may have lost its length on the way."""
        return self._anew(origin.solution, position) if origin.solution.sheets else None

    def _anew(self, solution: Solution, position: float) -> Trial[Solution] | None:
        """Solve at a position with all that a single scene may need, from a solution near by."""
        found = self.prepared.solve(self.curve.posed_at(position), guess=solution, fallback=False)
        unknowns = np.append(found.dense.w, position)
        note = changed_phases(solution.sheets, found.sheets)
        return Trial(found, unknowns, True, found.message, note) if found.verified else None

    def _unbent(self, solution: Solution) -> bool:
        return unbent_share(solution, self.prepared.ribbon.law) > 0

    def _beside(self, solution: Solution, position: float) -> Attempt:
        """Return the means to solve at a position, on the mesh and in the phases of a solution."""
        search = self.prepared.search(self.curve.posed_at(position))
        return search.on_mesh(solution.sheets, solution.mesh, solution.trajectory.ends[1:-1])

    def _needs_phases(self, solution: Solution) -> bool:
        search = self.prepared.search(solution.posed)
        return search.phases_help and search.changes_sign(solution)


def _explained(change: int, changes: int) -> bool:
    """Whether so many changes of test functions can change a count by so much."""
    return change <= changes and (change - changes) % 2 == 0


def reduced(solution: Solution, extended: Array) -> Array:
    """Return states at both ends, constants of the rod and position, of a vector [w, l].

    They determine the whole solution, and are the same in any layout.
    """
    layout = solution.dense.blocks.layout
    nodes, _, c = layout.unpack(extended[:-1])
    rod = layout.nc - len(layout.elements) + 1 - solution.problem.slack
    return np.concatenate([nodes[0], nodes[-1], c[:rod], extended[-1:]])


def row_of(solution: Solution, part: Array) -> Array:
    """Put a vector of the form of `reduced` in the place of its entries among all points and c."""
    layout = solution.dense.blocks.layout
    nx, points = layout.nx, len(layout.point_elements)
    row = np.zeros(points * nx + layout.nc + 1)
    row[:nx], row[(points - 1) * nx : points * nx] = part[:nx], part[nx : 2 * nx]
    rod = part[2 * nx : -1]
    row[points * nx : points * nx + len(rod)] = rod
    row[-1] = part[-1]
    return row


def metric_at(solution: Solution, curve: Curve) -> Metric:
    """Return the metric of a stage that begins at a solution.

    Loads and states count relative to their size there, the position relative to its span.
    """
    sizes = 1 + np.abs(reduced(solution, np.append(solution.dense.w, curve.start)))
    # Loads together: one that vanishes by symmetry is as large as the others.
    nx = solution.dense.blocks.layout.nx
    sizes[2 * nx :] = sizes[2 * nx :].max(initial=1.0)
    sizes[-1] = curve.span
    return Metric(sizes)


def _trial(attempt: Attempt, position: Array) -> Trial[Solution]:
    """Return what attempt at a position (1,) have come to."""
    found = attempt.best
    assert found is not None
    unknowns = np.concatenate([found.dense.w, position])
    return Trial(found, unknowns, found.verified, found.message)


def _checked(trial: Trial[Solution], found: Solution) -> Trial[Solution]:
    """Return a trial with another solution at its position; the same unknowns where these are."""
    unknowns = trial.unknowns
    if found.trajectory is not trial.solution.trajectory:
        unknowns = np.append(found.dense.w, unknowns[-1])
    return Trial(found, unknowns, found.verified, found.message)


def _without_last(report: SolveReport) -> SolveReport:
    """Return the report without the position and its equation."""
    return replace(
        report,
        w=report.w[:-1],
        residuals=report.residuals[:-1],
        multipliers=report.multipliers[:-1],
    )
