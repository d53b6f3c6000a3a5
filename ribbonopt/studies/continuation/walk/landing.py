"""The last step of a branch, shortened until it ends where a condition begins to be met."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Generic

import numpy as np

from ribbonopt.arrays import Array

from .points import Point, S
from .protocol import Equations
from .strides import Stride
from .tangents import near, renewed

EXACT = 1e-9  # of the change of a margin over the step: most that the end is beyond zero
CLOSEST = 1e-11  # of the step: lengths nearer than this are one
MOST_TRIALS = 60
MOST_FAILURES = 5

Margins = Callable[[Point[S]], Mapping[str, float]]


def landed(
    equations: Equations[S], point: Point[S], stride: Stride[S], margins: Margins[S]
) -> Stride[S]:
    """Return a step that ends just beyond the place where a margin first passes zero.

    Parameters
    ----------
    equations
        Of the branch.
    point
        Where the step begins.
    stride
        The step in its full length, which is returned where no margin passes zero.
    margins
        Of a point, by name: negative before the place that is wanted, positive beyond it. What
        has no margin at both ends of the step, or jumps on the way, is met as exactly as can be.
    """
    before, after = margins(point), margins(stride.following)
    changes = {
        name: value - before[name]
        for name, value in after.items()
        if value > 0 and name in before and before[name] <= 0
    }
    if not changes:
        return stride

    def excess(found: Mapping[str, float]) -> float:
        """Return how far the first is beyond, relative to its change, less half of what may be."""
        shares = [found.get(name, 0.0) / change for name, change in changes.items()]
        return max(shares) - EXACT / 2

    step = _Step(equations, point, stride.following)
    end, failures, side = stride.following, 0, 0
    # False position with halved weights (Illinois).
    low, high, f_low, f_high = 0.0, step.whole, excess(before), excess(after)
    for _ in range(MOST_TRIALS):
        if f_high <= EXACT / 2 or high - low <= CLOSEST * step.whole:
            break
        arc = (low * f_high - high * f_low) / (f_high - f_low)
        trial = step.shortened(arc + (high - arc) * failures / (MOST_FAILURES + 1))
        if trial is None:
            failures += 1
            if failures > MOST_FAILURES:
                break
            continue
        arc, f, failures = step.arc(trial), excess(margins(trial)), 0
        if f > -EXACT / 2:
            f_low = f_low / 2 if side > 0 else f_low
            high, f_high, end, side = arc, f, trial, 1
        else:
            f_high = f_high / 2 if side < 0 else f_high
            low, f_low, side = arc, f, -1
    return Stride(end, [one for one in stride.special if step.arc(one) <= high])


class _Step(Generic[S]):
    """A step by the arclength along its first tangent."""

    def __init__(self, equations: Equations[S], point: Point[S], following: Point[S]) -> None:
        """Measure arclength at the first point."""
        self.equations = equations.measured(point.solution)
        self.point, self.following = renewed(self.equations, point), following

    @property
    def whole(self) -> float:
        """Arclength of the whole step."""
        return self.arc(self.following)

    def arc(self, there: Point[S]) -> float:
        """Arclength of a point."""
        equations, point = self.equations, self.point
        along = equations.reduced(point.solution, point.tangent)
        return equations.metric.product(self._gap(there.solution, there.unknowns), along)

    def shortened(self, arc: float) -> Point[S] | None:
        """Return the point at an arclength, finished; None where none is found."""
        equations, point = self.equations, self.point
        guess = point.unknowns + arc * point.tangent
        try:
            trial = equations.correct_along(point, point.tangent, arc, guess)
            if not trial.converged:
                return None
            trial = equations.finished(point, trial)
            if not trial.converged:
                return None
            ahead = self._gap(trial.solution, trial.unknowns)
            found, tangent = near(equations, trial.solution, trial.unknowns, ahead)
        except np.linalg.LinAlgError:
            return None
        return replace(
            self.following,
            solution=trial.solution,
            unknowns=trial.unknowns,
            tangent=tangent,
            sign=found.sign,
            note=trial.note,
        )

    def _gap(self, solution: S, unknowns: Array) -> Array:
        """Coordinates (m,) of the way from the first point."""
        here = self.equations.reduced(self.point.solution, self.point.unknowns)
        return self.equations.reduced(solution, unknowns) - here
