"""Continuation: branches of equilibria as a parameter of the scene moves, stage after stage.

    for point in Continuation(scene):
        print(point.row["value"], point.row["energy"])

One structure is built; every point is a verified solution. Where a stage ends short of its goal,
the iterator ends and `endings` says why.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Protocol

import numpy as np

from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.pipeline import Prepared, prepare
from ribbonopt.scene import Scene
from ribbonopt.scene.continuation_checks import stages_of
from ribbonopt.solution import Solution

from .curve import Curve
from .points import BRANCH_POINT, FOLD, POINT, Metric, Point, near, reduced
from .recorded import Recorder, stopped
from .special import null_direction
from .walk import Ending, Walk

AWAY, LEAST_AWAY = 0.05, 1e-4  # arclength of the first step onto a branch that crosses

Key = tuple[int, int]


class History(Protocol):
    """Points that are known already, of each stage and branch."""

    endings: dict[Key, Ending]

    def points(self, stage: int, branch: int, kind: str) -> list[Point]:
        """Points of a kind, in order."""


class _Nothing:
    """No history."""

    endings: dict[Key, Ending] = {}

    def points(self, stage: int, branch: int, kind: str) -> list[Point]:
        return []


class Continuation:
    """The points of all stages of a scene, in order.

    Attributes
    ----------
    scene : Scene
        The scene, whose `continuation` says what is followed.
    endings : mapping of (stage, branch) to Ending
        How each stage, and each branch switched to, has ended so far.
    """

    def __init__(self, scene: Scene) -> None:
        """Prepare; nothing is solved yet.

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
        first = Curve(scene, self.stages[0])
        self.prepared: Prepared = prepare(first.scene_at(first.start))
        if not self.prepared.problem.square:
            raise ModelError(
                f"formulation: {self.scene.formulation} is not a square system of equations, which "
                "continuation needs; use inverted, differentiated, or algebraic without bounds",
                "formulation",
            )
        self.endings: dict[Key, Ending] = {}
        self.recorder = Recorder(scene)
        self._number = 0

    def __iter__(self) -> Iterator[Point]:
        """Follow all stages from the start."""
        return self.resume(_Nothing())

    def resume(self, history: History) -> Iterator[Point]:
        """Go on where a history ends, as if there had been no break."""
        scene, before = self.scene, None
        for i, stage in enumerate(self.stages):
            curve = Curve(scene, stage)
            _refuse_idle(curve)
            known = history.points(i, 0, POINT)
            first = known[0].solution if known else self._first(curve, before)
            metric = Metric.at(first, curve.start, curve.span)
            direction = 1 if curve.goals[-1] > curve.start else -1
            walk = Walk(self.prepared, curve, metric, direction)

            def begin(walk: Walk = walk, first: Solution = first, stage: int = i) -> Point:
                return walk.begin(first, stage)

            branch = _Branch(self, walk, (i, 0), history, begin)
            yield from branch.points()
            if stage.switch:
                yield from self._crossing(branch, history)
            if not self.endings[i, 0].reached or branch.last is None:
                return
            before, scene = branch.last.solution, branch.last.solution.scene

    @property
    def ending(self) -> Ending:
        """How the whole has ended: as the first stage that did not reach its goal, or the last."""
        mains = [ending for (_, branch), ending in self.endings.items() if branch == 0]
        return next((ending for ending in mains if not ending.reached), mains[-1])

    def recorded(self, point: Point, walk: Walk, key: Key) -> Point:
        """Number a point and note what is recorded of it."""
        point = replace(point, number=self._number, stage=key[0], branch=key[1])
        self._number += 1
        return replace(point, row=self.recorder.row(point, walk.curve))

    def count(self, point: Point) -> None:
        """Take a point that is known already into account."""
        self._number = max(self._number, point.number + 1)

    def _first(self, curve: Curve, before: Solution | None) -> Solution:
        """Solve where a stage begins."""
        scene = curve.scene_at(curve.start)
        fallback = before is None
        found = self.prepared.solve(scene, guess=before, fallback=fallback)
        if not found.verified:
            raise ConvergenceError(
                f"no solution to begin with, at {curve.stage.parameter} = {curve.stage.from_:g}: "
                f"{found.message}",
                found.status.name.lower(),
            )
        return found

    def _crossing(self, main: _Branch, history: History) -> Iterator[Point]:
        """Follow the branches that cross at the branch points of a stage, in both directions."""
        number = 0
        for point in main.branch_points:
            for sign in (1, -1):
                number += 1
                walk = Walk(self.prepared, main.walk.curve, main.walk.metric, 0)

                def begin(walk: Walk = walk, point: Point = point, sign: int = sign) -> Point:
                    return _switched(walk, point, sign)

                key = main.key[0], number
                yield from _Branch(self, walk, key, history, begin).points()


class _Branch:
    """One branch of one stage: from its begin, or from where a history ends."""

    def __init__(
        self,
        whole: Continuation,
        walk: Walk,
        key: Key,
        history: History,
        begin: Callable[[], Point],
    ) -> None:
        self.whole, self.walk, self.key, self.begin = whole, walk, key, begin
        known = history.points(*key, POINT)
        self.last = known[-1] if known else None
        self.count = len(known)
        self.branch_points = history.points(*key, BRANCH_POINT)
        folds = history.points(*key, FOLD)
        walk.turned += [walk.curve.value(point.position) for point in folds]
        for point in (*known, *self.branch_points, *folds):
            whole.count(point)
        self.ended = history.endings.get(key)

    def points(self) -> Iterator[Point]:
        """Points that are not known yet; notes how the branch ends."""
        if self.ended is None:
            yield from self._followed()
            self.ended = self.walk.ending
        self.whole.endings[self.key] = self.ended

    def _followed(self) -> Iterator[Point]:
        whole, walk = self.whole, self.walk
        if self.last is None:
            try:
                self.last = whole.recorded(self.begin(), walk, self.key)
            except np.linalg.LinAlgError as error:
                walk.ending = Ending(False, str(error))
                return
            self.count = 1
            yield self.last
        if self._finished(self.last):
            return
        for point in walk.points(self.last):
            point = whole.recorded(point, walk, self.key)
            if point.kind == POINT:
                self.last, self.count = point, self.count + 1
            elif point.kind == BRANCH_POINT:
                self.branch_points.append(point)
            yield point
            if point.kind == POINT and self._finished(point):
                return

    def _finished(self, point: Point) -> bool:
        """Whether the scene wants no more points of this branch; sets the ending."""
        stage = self.walk.curve.stage
        condition = stopped(point.row, stage)
        if condition:
            self.walk.ending = Ending(True, f"stopped, as asked: {condition}")
        elif self.count >= stage.points:
            self.walk.ending = Ending(False, f"there are {self.count} points, as many as allowed")
        return bool(condition) or self.count >= stage.points


def _switched(walk: Walk, point: Point, sign: int) -> Point:
    """Return the first point on a branch that crosses at a branch point."""
    direction = sign * null_direction(walk.corrector, point)
    away = AWAY
    while away > LEAST_AWAY:
        guess = point.unknowns + away * direction
        attempts, position = walk.corrector.along(point, direction, away, guess)
        found = attempts.best
        if found is not None and found.verified:
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


def _refuse_idle(curve: Curve) -> None:
    """Raise a ModelError where the parameter changes nothing."""
    if not curve.moves:
        raise ModelError(
            f"continuation.parameter: {curve.stage.parameter} changes nothing in this scene; "
            "continue a number that its equations contain",
            "continuation.parameter",
        )
