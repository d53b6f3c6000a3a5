"""One step along a curve: predict along the tangent, correct, accept or shorten.

While the position moves along the curve, points are met at given values of it (natural
continuation); where it turns, at given arclengths (pseudo-arclength continuation). Arclength is
measured anew at each point, so that steps follow the growth of the unknowns.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Generic

import numpy as np

from ribbonopt.arrays import Array

from .asked import Range
from .beside import strays
from .course import Course, joined, leaving
from .points import POINT, TURNING, Point, S, Special
from .protocol import Equations, Passage, Trial
from .strides import Prediction, Stride
from .tangents import headed, moved, renewed

NATURAL = 0.1  # least share of the position in the tangent for natural continuation
GROWTH, SHRINK = 2.0, 0.25  # of a step, after success and failure
LONGEST = 0.5  # arclength of a step where the position turns
DIGITS = 1e-12  # of a position, relative to the span
DOUBTS = 3  # times that a step is shortened because something on it was not resolved
JUMPED = "not where the branch was going: it may have changed to another equilibrium"
NOT_RESOLVED = "not resolved"
UNRESOLVED = NOT_RESOLVED + ": {} on the way from the point before"


class Stepper(Generic[S]):
    """Steps along one curve; `trouble` says why the last one failed."""

    def __init__(self, equations: Equations[S], range_: Range) -> None:
        """Take the equations, and the sizes of steps."""
        self.equations, self.range = equations, range_
        self.trouble = ""
        self._doubts = 0

    def step(self, point: Point[S], goal: float) -> Stride[S] | None:
        """Return the longest step towards a goal that succeeds; None where that is too short."""
        self.equations = self.equations.measured(point.solution)
        point = renewed(self.equations, point)
        length, self._doubts = point.step, 0
        while True:
            found = self._try(point, goal, length)
            if found is not None:
                return found
            length *= SHRINK
            if length * self._size < self.range.smallest:
                return self._elsewhere(point, goal)

    def _elsewhere(self, point: Point[S], goal: float) -> Stride[S] | None:
        """Return what is found by other means where a first step would lead."""
        prediction = self._predicted(point, goal, self.first_length(point.tangent))
        trial = self.equations.elsewhere(point, float(prediction.unknowns[-1]))
        if trial is None:
            return None
        placed = self._placed(point, prediction, trial)
        return self._arrived(point, trial, placed, Special([]), True)

    def first_length(self, tangent: Array) -> float:
        """Arclength of the first step along a tangent."""
        share = max(abs(self._share(tangent)), NATURAL)
        return self.range.first / self._size / share

    def _try(self, point: Point[S], goal: float, length: float) -> Stride[S] | None:
        prediction = self._predicted(point, goal, length)
        trial, prediction = self._corrected(point, goal, prediction)
        if not trial.converged and prediction.position is not None:
            # It may turn before that position.
            arc = min(prediction.arc, LONGEST)
            prediction = Prediction(point.unknowns + arc * point.tangent, arc, None)
            trial, prediction = self._corrected(point, goal, prediction)
        least = abs(prediction.arc) * self._size * SHRINK < self.range.smallest
        if trial.converged:
            placed = following, course = self._placed(point, prediction, trial)
            if not (course.same or least):
                self.trouble = course.trouble
                return None
        try:
            passed = self.equations.passed(point, trial, prediction.unknowns)
        except np.linalg.LinAlgError as impassable:
            self.trouble = str(impassable)
            return None
        if passed is not None:
            return self._passed(passed, prediction, goal)
        if not trial.converged:
            self.trouble = trial.message
            return None
        special = self._special(point, following, goal)
        if special.unresolved and not least and self._doubted():
            self.trouble = UNRESOLVED.format(" and ".join(special.unresolved))
            return None
        if course.sharp and not (special.changes or least) and self._strays(point, following):
            return None
        final = self.equations.finished(point, trial)
        self.trouble = final.message
        if not final.converged:
            return None
        if final.unknowns is following.unknowns:
            placed = replace(following, solution=final.solution), course
        else:
            placed = self._placed(point, prediction, final)
        return self._arrived(point, final, placed, special, least)

    def _passed(self, passed: Passage[S], prediction: Prediction, goal: float) -> Stride[S] | None:
        """Return the step up to the first point in another layout, or to the goal before that."""
        parts = [self._special(passed.begin, passed.event, goal)]
        special = list(parts[0].points)
        if self.range.special and passed.event.kind != POINT:
            special.append(passed.located or passed.event)
        if passed.stretch is not None:
            parts.append(self._special(*passed.stretch, goal))
            special += parts[1].points
        doubts = [name for part in parts for name in part.unresolved]
        notes = [passed.after.note, UNRESOLVED.format(" and ".join(doubts)) if doubts else ""]
        note = "; ".join(filter(None, notes))
        after = replace(passed.after, step=abs(prediction.arc), note=note)
        if (after.position - goal) * (passed.begin.position - goal) < 0:
            guess = np.append(after.unknowns[:-1], goal)
            trial = self.equations.correct_at(after.solution, guess)
            trial = self.equations.finished(after, trial) if trial.converged else trial
            self.trouble = trial.message
            if not trial.converged:
                return None
            after = moved(self.equations, after, trial)
        return Stride(after, special)

    def _strays(self, point: Point[S], following: Point[S]) -> bool:
        """Whether a step is to be shortened because no smooth curve seems to join its ends."""
        if not (self.range.special and strays(self.equations, point, following)):
            return False
        self.trouble = "another branch may cross on the way"
        return self._doubted()

    def _doubted(self) -> bool:
        """Whether a step in doubt is to be shortened once more."""
        self._doubts += 1
        return self._doubts <= DOUBTS

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

    def _placed(
        self, point: Point[S], prediction: Prediction, trial: Trial[S]
    ) -> tuple[Point[S], Course]:
        """Return a trial as the next point, in whatever layout it has, and how it lies."""
        equations, solution = self.equations, trial.solution
        left = leaving(equations, point, prediction.unknowns)
        there = equations.reduced(solution, trial.unknowns)
        sign, tangent = headed(equations, solution, trial.unknowns, there - left.here)
        course = joined(left, there, equations.reduced(solution, tangent), equations.metric)
        following = replace(
            point,
            solution=solution,
            unknowns=trial.unknowns,
            tangent=tangent,
            sign=sign,
            step=abs(prediction.arc) * float(np.clip(course.growth, SHRINK, GROWTH)),
        )
        return following, course

    def _special(self, point: Point[S], following: Point[S], goal: float) -> Special[S]:
        """Return what is special between two points of one layout, in the range."""
        if not self.range.special:
            return Special([])
        found = self.equations.special(point, following)
        heading = np.sign(goal - point.position)
        beyond = [p for p in found.points if heading * (p.position - goal) > 0]
        turning = next((p.kind for p in beyond if p.kind in TURNING), None)
        if turning is not None:
            # It turns there, and has passed the goal before.
            return Special([], (f"the goal, before a {turning},",))
        return replace(found, points=[p for p in found.points if p not in beyond])

    def _arrived(
        self,
        point: Point[S],
        final: Trial[S],
        placed: tuple[Point[S], Course],
        special: Special[S],
        least: bool,
    ) -> Stride[S] | None:
        """Return the step to a finished trial, if that is where the branch goes."""
        following, course = placed
        doubts = list(special.unresolved)
        points = list(special.points)
        if self.range.special:
            crossings = self.equations.crossings(point, following)
            points += crossings
            changes = special.changes + len(crossings)
            changed = self.equations.uncounted(point.solution, following.solution, changes)
            doubts += [changed] if changed else []
        if (not course.same or doubts) and not least and self._doubted():
            self.trouble = UNRESOLVED.format(" and ".join(doubts)) if doubts else course.trouble
            return None
        notes = [final.note, "" if course.same else JUMPED]
        notes += [UNRESOLVED.format(" and ".join(doubts))] if doubts else []
        return Stride(replace(following, note="; ".join(filter(None, notes))), points)

    def _share(self, tangent: Array) -> float:
        """Share of the position in a unit tangent, with its sign."""
        return float(tangent[-1] / self._size)

    @property
    def _size(self) -> float:
        """Change of the position that counts as one."""
        return float(self.equations.metric.sizes[-1])
