"""One step along a curve: predict along the tangent, correct, accept or shorten.

While the position moves along the curve, points are met at given values of it (natural
continuation); where it turns, at given arclengths (pseudo-arclength continuation).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Generic

import numpy as np

from ribbonopt.arrays import Array

from .points import POINT, Point, S
from .protocol import Equations, Passage, Range, Trial
from .special import special_points
from .tangents import near

NATURAL = 0.1  # least share of the position in the tangent for natural continuation
AIM = 0.02  # wanted distance of a prediction from the curve, in arclength
FARTHEST = 5.0  # times that: a point that is further off is none of this curve
JUMPED = "not where the branch was going: it may have changed to another equilibrium"
GROWTH, SHRINK = 2.0, 0.25  # of a step, after success and failure
LONGEST = 0.5  # arclength of a step where the position turns
COSINE = 0.7  # least one of the angle between tangents one step apart
DIGITS = 1e-12  # of a position, relative to the span


@dataclass(frozen=True, eq=False)
class Stride(Generic[S]):
    """An accepted step: the next point, and the special points before it."""

    following: Point[S]
    special: list[Point[S]]


@dataclass(frozen=True, eq=False)
class Prediction:
    """Unknowns at an arclength ahead; `position` is to be met exactly, unless the arclength is."""

    unknowns: Array
    arc: float
    position: float | None


class Stepper(Generic[S]):
    """Steps along one curve; `trouble` says why the last one failed."""

    def __init__(self, equations: Equations[S], range_: Range) -> None:
        """Take the equations, and the sizes of steps."""
        self.equations, self.range = equations, range_
        self.trouble = ""

    def step(self, point: Point[S], goal: float) -> Stride[S] | None:
        """Return the longest step towards a goal that succeeds; None where that is too short."""
        length = point.step
        while length * self._size >= self.range.smallest:
            found = self._try(point, goal, length)
            if found is not None:
                return found
            length *= SHRINK
        return self._elsewhere(point, goal)

    def _elsewhere(self, point: Point[S], goal: float) -> Stride[S] | None:
        """Return what is found, by other means, where the step would have led."""
        length = self.first_length(point.tangent)
        prediction = self._predicted(point, goal, length)
        trial = self.equations.elsewhere(point, float(prediction.unknowns[-1]))
        if trial is None:
            return None
        arrived = self._arrived(point, trial, self._told(point, prediction, trial))
        return Stride(replace(arrived, step=length), [])

    def first_length(self, tangent: Array) -> float:
        """Arclength of the first step along a tangent."""
        share = max(abs(self._share(tangent)), NATURAL)
        return self.range.first / self._size / share

    def _try(self, point: Point[S], goal: float, length: float) -> Stride[S] | None:
        prediction = self._predicted(point, goal, length)
        trial, prediction = self._corrected(point, goal, prediction)
        return self._accepted(point, trial, prediction)

    def _predicted(self, point: Point[S], goal: float, length: float) -> Prediction:
        """Go along the tangent, exactly onto the goal where that is in reach."""
        tangent, here = point.tangent, point.position
        share = self._share(tangent)
        longest = self.range.largest / self._size / max(abs(share), 1e-6)
        if not abs(share) > NATURAL:
            arc = min(length, longest, LONGEST)
            return Prediction(point.unknowns + arc * tangent, arc, None)
        arc = min(length, longest)
        change = arc * tangent[-1]
        lands = change * (goal - here) > 0 and abs(change) >= abs(goal - here) * (1 - DIGITS)
        if lands:
            arc, change = (goal - here) / tangent[-1], goal - here
        position = goal if lands else here + change
        return Prediction(point.unknowns + arc * tangent, arc, float(position))

    def _corrected(
        self, point: Point[S], goal: float, prediction: Prediction
    ) -> tuple[Trial[S], Prediction]:
        """Return to the curve: at the position, or at the arclength if that is before the goal."""
        here, equations = point.position, self.equations
        position = prediction.position
        if position is None:
            trial = equations.correct_along(
                point, point.tangent, prediction.arc, prediction.unknowns
            )
            there = float(trial.unknowns[-1])
            if not (there - goal) * (here - goal) < 0:
                return trial, prediction
            # Past the goal: from between the points onto it.
            part, position = (goal - here) / (there - here), goal
            between = point.unknowns + part * (trial.unknowns - point.unknowns)
            prediction = replace(prediction, unknowns=between)
        guess = np.append(prediction.unknowns[:-1], position)
        return equations.correct_at(point.solution, guess), prediction

    def _accepted(
        self, point: Point[S], trial: Trial[S], prediction: Prediction
    ) -> Stride[S] | None:
        """Return the step if it is not too long, its point in the layout that it needs."""
        equations = self.equations
        try:
            passed = equations.passed(point, trial, prediction.unknowns)
        except np.linalg.LinAlgError as impassable:
            self.trouble = str(impassable)
            return None
        if passed is not None:
            return self._passed(passed, prediction)
        if not trial.converged:
            self.trouble = trial.message
            return None
        metric, solution = equations.metric, trial.solution
        error = metric.length(equations.reduced(solution, trial.unknowns - prediction.unknowns))
        ahead = equations.reduced(solution, trial.unknowns - point.unknowns)
        found, tangent = near(equations, solution, trial.unknowns, ahead)
        cosine = metric.product(
            equations.reduced(solution, tangent), equations.reduced(solution, point.tangent)
        )
        if cosine < COSINE or error > FARTHEST * AIM:
            self.trouble = "the branch bends too sharply"
            if prediction.arc * self._size > self.range.smallest:
                return None
        following = replace(
            point,
            solution=solution,
            unknowns=trial.unknowns,
            tangent=tangent,
            sign=found.sign,
            step=abs(prediction.arc) * _growth(error),
        )
        special = []
        if self.range.special:
            special = special_points(equations, point, following)
            special += equations.crossings(point, following)
        final = equations.finished(point, trial)
        self.trouble = final.message
        if not final.converged:
            return None
        told = self._told(point, prediction, final)
        return Stride(self._arrived(following, final, told), special)

    def _passed(self, passed: Passage[S], prediction: Prediction) -> Stride[S]:
        """Return the step up to the first point in another layout."""
        special = []
        if self.range.special:
            special = special_points(self.equations, passed.begin, passed.event)
            special += [passed.event] if passed.event.kind != POINT else []
        return Stride(replace(passed.after, step=abs(prediction.arc)), special)

    def _told(self, point: Point[S], prediction: Prediction, final: Trial[S]) -> str:
        """Return the note of a trial; with a word on it where it is not what was predicted."""
        expected = self.equations.reduced(point.solution, prediction.unknowns)
        found = self.equations.reduced(final.solution, final.unknowns)
        off = self.equations.metric.length(found - expected)
        return "; ".join(filter(None, [final.note, JUMPED if off > FARTHEST * AIM else ""]))

    def _arrived(self, before: Point[S], trial: Trial[S], note: str) -> Point[S]:
        """Return a point for a trial, maybe in another layout, or of other numbers, than before."""
        before = replace(before, note=note)
        if trial.unknowns is before.unknowns:
            return replace(before, solution=trial.solution)
        ahead = self.equations.reduced(before.solution, before.tangent)
        found, tangent = near(self.equations, trial.solution, trial.unknowns, ahead)
        return replace(
            before,
            solution=trial.solution,
            unknowns=trial.unknowns,
            tangent=tangent,
            sign=found.sign,
        )

    def _share(self, tangent: Array) -> float:
        """Share of the position in a unit tangent, with its sign."""
        return float(tangent[-1] / self._size)

    @property
    def _size(self) -> float:
        """Change of the position that counts as one."""
        return float(self.equations.metric.sizes[-1])


def _growth(error: float) -> float:
    """Factor of the next step, for the error of a prediction."""
    return float(np.clip(np.sqrt(AIM / max(error, 1e-12)), SHRINK, GROWTH))
