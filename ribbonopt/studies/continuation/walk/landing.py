"""The last step of a branch, shortened until it ends where a condition begins to be met."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from .points import Point, S
from .steps import NATURAL, Stepper, Stride

EXACT = 1e-9  # of the change of a margin over the step: most that the end is beyond zero
CLOSEST = 1e-11  # of the length of the step: lengths nearer than this are one
MOST_TRIALS = 60

Margins = Callable[[Point[S]], Mapping[str, float]]


def landed(
    stepper: Stepper[S], point: Point[S], goal: float, stride: Stride[S], margins: Margins[S]
) -> Stride[S]:
    """Return a step that ends just beyond the place where a margin first passes zero.

    Parameters
    ----------
    stepper
        Takes steps of any length.
    point
        Where the step begins.
    goal
        Position that no step goes beyond.
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

    # False position with halved weights (Illinois).
    low, high = 0.0, _length(stepper, point, stride)
    f_low, f_high = excess(before), excess(after)
    whole, side = high, 0
    for _ in range(MOST_TRIALS):
        if f_high <= EXACT / 2 or high - low <= CLOSEST * whole:
            break
        length = (low * f_high - high * f_low) / (f_high - f_low)
        trial = stepper.step(replace(point, step=length), goal)
        if trial is None:
            break
        length, f = _length(stepper, point, trial), excess(margins(trial.following))
        if f > -EXACT / 2:
            f_low = f_low / 2 if side > 0 else f_low
            high, f_high, stride, side = length, f, trial, 1
        else:
            f_high = f_high / 2 if side < 0 else f_high
            low, f_low, side = length, f, -1
    return stride


def _length(stepper: Stepper[S], point: Point[S], stride: Stride[S]) -> float:
    """Return the length along the tangent that leads to the end of a step."""
    equations, slope = stepper.equations, float(point.tangent[-1])
    if abs(slope) > NATURAL * equations.metric.sizes[-1]:
        return (stride.following.position - point.position) / slope
    there = equations.reduced(stride.following.solution, stride.following.unknowns)
    here = equations.reduced(point.solution, point.unknowns)
    return equations.metric.product(there - here, equations.reduced(point.solution, point.tangent))
