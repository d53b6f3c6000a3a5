"""Following one branch: predict along the tangent, correct, choose the next step.

While the parameter moves along the branch, points are met at given values of it (natural
continuation); where it turns, at given arclengths (pseudo-arclength continuation). Each point is
brought to the scene's tolerance on its own mesh; phases appear and vanish as sign changes of m2 do.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from ribbonopt.accuracy.estimate import relative_error
from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempts
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.pipeline.refinement import SAFE
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.batch.neighbour import SPARE

from .corrector import Corrector
from .curve import Curve
from .points import BRANCH_POINT, Metric, Point, near, reduced
from .special import special_points

NATURAL = 0.1  # least share of the position in the tangent for natural continuation
AIM = 0.02  # wanted distance of a prediction from the branch, in arclength
GROWTH, SHRINK = 2.0, 0.25  # of a step, after success and failure
LONGEST = 0.5  # arclength of a step where the parameter turns
STRAIGHT = 0.7  # least cosine of the angle between tangents one step apart
DIGITS = 1e-12  # of a position, relative to the span


@dataclass(frozen=True)
class Ending:
    """How a stage or a branch ended: whether it reached its goal, and in words."""

    reached: bool
    reason: str


class Walk:
    """One branch of one stage, point after point; `ending` says why there are no more."""

    def __init__(self, prepared: Prepared, curve: Curve, metric: Metric, direction: int) -> None:
        """Follow a curve; `direction` is +1 or -1, or 0 where either end of it will do."""
        self.prepared, self.curve, self.metric = prepared, curve, metric
        self.corrector = Corrector(prepared, curve, metric)
        self.direction = direction
        self.ending = Ending(False, "not begun")
        self.turned: list[float] = []
        self._trouble = ""

    def begin(self, solution: Solution, stage: int) -> Point:
        """Return the point that a stage begins with, facing its goal."""
        position = self.curve.start
        ahead = np.zeros_like(reduced(solution, np.append(solution.dense.w, position)))
        ahead[-1] = self.direction or 1
        found, tangent = near(self.curve, self.metric, solution, position, ahead)
        share = max(abs(self._share(tangent)), NATURAL)
        step = self.curve.first / self.curve.span / share
        return Point(solution, position, tangent, found.sign, step, stage=stage)

    def points(self, point: Point) -> Iterator[Point]:
        """Points after a given one, special points among them."""
        while True:
            goal = self._goal(point)
            if goal is None:
                return
            following, special = self._step(point, goal)
            if following is None:
                return
            for found in special:
                yield found
                if found.kind != BRANCH_POINT:
                    self.turned.append(self.curve.value(found.position))
            yield following
            point = following

    def _goal(self, point: Point) -> float | None:
        """Return the position to land on next, None at the end; sets `ending`."""
        curve, here = self.curve, point.position
        heading = np.sign(point.tangent[-1]) or 1.0
        if self.direction == 0:
            ends = sorted((curve.start, curve.goals[-1]))
            if not ends[0] < here < ends[1]:
                self.ending = Ending(True, f"reached {self._named(here)}")
                return None
            return ends[1] if heading > 0 else ends[0]
        left = [goal for goal in curve.goals if self.direction * (goal - here) > 0]
        if not left:
            self.ending = Ending(True, f"reached {self._named(here)}")
            return None
        if self.direction * (here - curve.start) < -DIGITS * curve.span:
            folds = ", ".join(f"{value:.8g}" for value in self.turned)
            where = f" (folds at {self.curve.stage.parameter} = {folds})" if folds else ""
            self.ending = Ending(False, f"the branch turned back and left the range{where}")
            return None
        return left[0] if heading == self.direction else curve.start - self.direction * curve.span

    def _step(self, point: Point, goal: float) -> tuple[Point | None, list[Point]]:
        """Return the next point and the special points before it; None where none is found."""
        step = point.step
        while True:
            found = self._try(point, goal, step)
            if found is not None:
                return found
            step *= SHRINK
            if step * self.curve.span < self.curve.smallest:
                self.ending = Ending(
                    False,
                    f"the step fell below {self.curve.smallest:.3g} beyond "
                    f"{self._named(point.position)}: {self._trouble}",
                )
                return None, []

    def _try(self, point: Point, goal: float, step: float) -> tuple[Point, list[Point]] | None:
        """Try one step; None where it has to be shorter."""
        tangent, here = point.tangent, point.position
        share = self._share(tangent)
        longest = self.curve.largest / self.curve.span / max(abs(share), 1e-6)
        natural = abs(share) > NATURAL
        arc = min(step, longest) if natural else min(step, longest, LONGEST)
        change = arc * tangent[-1]
        lands = change * (goal - here) > 0 and abs(change) >= abs(goal - here) * (1 - DIGITS)
        if natural and lands:
            arc, change = (goal - here) / tangent[-1], goal - here
        predicted = point.unknowns + arc * tangent
        if natural:
            position = goal if lands else here + change
            attempts = self.corrector.at(point, predicted[:-1], position)
        else:
            attempts, position = self.corrector.along(point, tangent, arc, predicted)
            if attempts.best is not None and (position - goal) * (here - goal) < 0:
                # Past the goal: from between the points onto it.
                ahead = np.append(attempts.best.dense.w, position)
                part = (goal - here) / (position - here)
                predicted = point.unknowns + part * (ahead - point.unknowns)
                attempts, position = self.corrector.at(point, predicted[:-1], goal), goal
        return self._accepted(point, attempts, position, predicted, arc)

    def _accepted(
        self, point: Point, attempts: Attempts, position: float, predicted: Array, arc: float
    ) -> tuple[Point, list[Point]] | None:
        trial = attempts.best
        assert trial is not None
        if not trial.verified:
            self._trouble = trial.message
            # A phase may have lost its length on the way.
            again = self.corrector.anew(point.solution, position) if point.solution.sheets else None
            return None if again is None else (self._arrived(point, again, position), [])
        unknowns = np.append(trial.dense.w, position)
        error = self.metric.length(reduced(trial, unknowns - predicted))
        ahead = reduced(trial, unknowns - point.unknowns)
        found, tangent = near(self.curve, self.metric, trial, position, ahead)
        cosine = self.metric.product(reduced(trial, tangent), reduced(trial, point.tangent))
        if cosine < STRAIGHT or error > 5 * AIM:
            self._trouble = "the branch bends too sharply"
            if arc * self.curve.span > self.curve.smallest:
                return None
        factor = float(np.clip(np.sqrt(AIM / max(error, 1e-12)), SHRINK, GROWTH))
        following = replace(
            point,
            solution=trial,
            position=position,
            tangent=tangent,
            sign=found.sign,
            step=abs(arc) * factor,
        )
        special = (
            special_points(self.corrector, point, following) if self.curve.stage.special else []
        )
        solution = self._finished(point, attempts, position)
        if solution is None:
            return None
        if solution is not trial:
            following = self._arrived(following, solution, position)
        return following, special

    def _arrived(self, before: Point, solution: Solution, position: float) -> Point:
        """Return a point for a solution in another layout, or with other numbers, than a trial."""
        if solution.trajectory is before.solution.trajectory and before.position == position:
            return replace(before, solution=solution)
        ahead = reduced(before.solution, before.tangent)
        found, tangent = near(self.curve, self.metric, solution, position, ahead)
        return replace(
            before, solution=solution, position=position, tangent=tangent, sign=found.sign
        )

    def _finished(self, point: Point, attempts: Attempts, position: float) -> Solution | None:
        """Return the solution verified, to tolerance, in the phases it needs; None for none."""
        trial = attempts.best
        assert trial is not None
        tolerance = trial.scene.tolerance
        if not trial.sheets and self._needs_phases(trial):
            trial = self.prepared.solve(trial.scene, guess=trial, fallback=False)
        elif tolerance is not None and relative_error(trial)[0] > SAFE * tolerance:
            trial = self.prepared.refined(trial, SPARE)
        else:
            attempts.check()
            trial = attempts.best
            assert trial is not None
        if not trial.verified and self.prepared.ribbon.law.kinked:
            # Phases may have changed on the way.
            again = self.corrector.anew(point.solution, position)
            trial = trial if again is None else again
        self._trouble = trial.message
        return trial if trial.verified else None

    def _needs_phases(self, trial: Solution) -> bool:
        search = self.prepared.search(trial.scene)
        return search.phases_help and search.changes_sign(trial)

    def _share(self, tangent: Array) -> float:
        """Share of the position in a unit tangent, with its sign."""
        return float(tangent[-1] / self.metric.sizes[-1])

    def _named(self, position: float) -> str:
        return f"{self.curve.stage.parameter} = {self.curve.value(position):.6g}"
