"""Continuation: branches of equilibria as a parameter of the scene moves, stage after stage.

    for point in Continuation(scene):
        print(point.row["value"], point.row["energy"])

One structure is built; every point is a verified solution. Where a stage ends short of its goal,
the iterator ends and `endings` says why.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.scene import Scene
from ribbonopt.scene.lens import value_at
from ribbonopt.scene.stages import stages_of
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

from .branches import Branch, History, Key, Ledger, Nothing
from .curve import Curve
from .points import POINT, Metric, Point, near, reduced
from .recorded import Recorder
from .special import null_direction
from .walk import Ending, Walk

STRAIGHT = 1e-9  # largest moment of a straight ribbon, in units Dw = L = 1
AWAY, LEAST_AWAY = 0.05, 1e-4  # arclength of the first step onto a branch that crosses


class Continuation:
    """The points of all stages of a scene, in order.

    Attributes
    ----------
    scene : Scene
        The scene, whose `continuation` says what is followed.
    """

    def __init__(self, scene: Scene, prepared: Prepared | None = None) -> None:
        """Prepare; nothing is solved yet. `prepared` is the same structure, built before.

        Raises
        ------
        ModelError
            If the scene has no `continuation`, or cannot be continued.
        """
        self.scene, self.stages = scene, stages_of(scene)
        if not self.stages:
            raise ModelError(
                "continuation: the scene has none; add for example "
                "'continuation: {parameter: law.epsilon, to: 1e-4, scale: log}'"
            )
        first, before = Curve(scene, self.stages[0]), scene
        self.prepared = prepared or prepare(first.scene_at(first.start))
        for stage in self.stages:
            curve = Curve(before, stage)
            _refuse_idle(curve, self.prepared.problem)
            before = curve.scene_at(curve.goals[-1])
        if not self.prepared.problem.square:
            raise ModelError(
                f"formulation: {self.scene.formulation} is not a square system of equations, which "
                "continuation needs; use inverted, differentiated, or algebraic without bounds",
                "formulation",
            )
        self.ledger = Ledger(Recorder(scene))

    def __iter__(self) -> Iterator[Point]:
        """Follow all stages from the start."""
        return self.resume(Nothing())

    def curve(self, stage: int, scene: Scene) -> Curve:
        """Return the curve of a stage that begins at a scene.

        Where the stage does not say from where, that is where the stages before have ended.
        """
        found, given = self.stages[stage], self.scene.continuation
        given = given[stage] if isinstance(given, tuple) else given
        if given is not None and given.from_ is None and given.values is None:
            found = replace(found, from_=value_at(scene, found.parameter))
        return Curve(scene, found)

    def resume(self, history: History) -> Iterator[Point]:
        """Go on where a history ends, as if there had been no break."""
        scene, before = self.scene, None
        for i, stage in enumerate(self.stages):
            curve = self.curve(i, scene)
            if curve.span == 0:
                self.ledger.endings[i, 0] = Ending(True, "its goal is where it begins")
                continue
            known = history.points(i, 0, POINT)
            first = known[0].solution if known else self._first(curve, before)
            metric = Metric.at(first, curve.start, curve.span)
            direction = 1 if curve.goals[-1] > curve.start else -1
            walk = Walk(self.prepared, curve, metric, direction)

            def begin(walk: Walk = walk, first: Solution = first, stage: int = i) -> Point:
                return walk.begin(first, stage)

            branch = Branch(self.ledger, walk, (i, 0), history, begin)
            yield from branch.points()
            if stage.switch:
                yield from self._crossing(branch, history)
            if not self.endings[i, 0].reached or branch.last is None:
                return
            before, scene = branch.last.solution, branch.last.solution.scene

    @property
    def endings(self) -> dict[Key, Ending]:
        """How each stage, and each branch switched to, has ended so far, by (stage, branch)."""
        return self.ledger.endings

    @property
    def ending(self) -> Ending:
        """How the whole has ended: as the first stage that did not reach its goal, or the last."""
        mains = [ending for (_, branch), ending in self.endings.items() if branch == 0]
        return next((ending for ending in mains if not ending.reached), mains[-1])

    def _first(self, curve: Curve, before: Solution | None) -> Solution:
        """Solve where a stage begins."""
        scene = curve.scene_at(curve.start)
        fallback = before is None
        found = self.prepared.solve(scene, guess=before, fallback=fallback)
        if curve.stage.special and found.status is not Status.NO_START:
            _refuse_straight(found, self.prepared)
        if not found.verified:
            raise ConvergenceError(
                f"no solution to begin with, at {curve.stage.parameter} = {curve.stage.from_:g}: "
                f"{found.message}",
                found.status.name.lower(),
            )
        return found

    def _crossing(self, main: Branch, history: History) -> Iterator[Point]:
        """Follow the branches that cross at the branch points of a stage, in both directions."""
        number = 0
        for point in main.branch_points:
            for sign in (1, -1):
                number += 1
                walk = Walk(self.prepared, main.walk.curve, main.walk.metric, 0)

                def begin(walk: Walk = walk, point: Point = point, sign: int = sign) -> Point:
                    return _switched(walk, point, sign)

                key = main.key[0], number
                yield from Branch(self.ledger, walk, key, history, begin).points()


def _switched(walk: Walk, point: Point, sign: int) -> Point:
    """Return the first point on a branch that crosses at a branch point."""
    direction = sign * null_direction(walk.corrector, point)
    away = AWAY
    while away > LEAST_AWAY:
        guess = point.unknowns + away * direction
        attempts, position = walk.corrector.along(point, direction, away, guess)
        found = attempts.best
        if found is not None and attempts.check():
            ahead = reduced(found, np.append(found.dense.w, position) - point.unknowns)
            linear, tangent = near(walk.curve, walk.metric, found, position, ahead)
            return replace(
                point,
                solution=found,
                position=position,
                tangent=tangent,
                sign=linear.sign,
                step=away,
                kind=POINT,
            )
        away /= 2
    raise np.linalg.LinAlgError("no point was found on the branch that crosses")


def _refuse_straight(found: Solution, prepared: Prepared) -> None:
    """Raise a ModelError where branch points are asked of a law without a derivative."""
    moments = np.abs(found.trajectory.at_stages["m"]).max()
    if prepared.ribbon.law.kinked and moments < STRAIGHT:
        raise ModelError(
            f"law: {found.scene.law.type} has no derivative at m = 0, so that a straight ribbon of "
            "it has no branch points to be found; use law: kirchhoff, whose buckling loads they "
            "are, or 'special: false' in the continuation",
            "law",
        )


def _refuse_idle(curve: Curve, problem: BoundaryValueProblem) -> None:
    """Raise a ModelError where the parameter changes nothing."""
    if not curve.moves(problem):
        raise ModelError(
            f"continuation.parameter: {curve.stage.parameter} changes nothing in this scene; "
            "continue a number that its equations contain",
            "continuation.parameter",
        )
