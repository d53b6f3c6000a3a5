"""The tangent of a curve at one of its points."""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.arrays import Array

from .points import Point, S
from .protocol import Equations, Linearised, Trial


def near(
    equations: Equations[S], solution: S, unknowns: Array, ahead: Array
) -> tuple[Linearised, Array]:
    """Linearise at a solution; return that, and its tangent (n + k,) of unit arclength.

    `ahead` (m,) are coordinates of any direction along the curve.
    """
    metric = equations.metric
    found = equations.linearise(solution, unknowns, ahead)
    direction = found.direction
    y = equations.reduced(solution, direction)
    if metric.product(y, ahead) < 0:
        direction, y = -direction, -y
    return found, direction / metric.length(y)


def renewed(equations: Equations[S], point: Point[S]) -> Point[S]:
    """Return a point with its tangent and its step in the metric of equations; the same way."""
    length = equations.metric.length(equations.reduced(point.solution, point.tangent))
    return replace(point, tangent=point.tangent / length, step=point.step * length)


def moved(equations: Equations[S], point: Point[S], trial: Trial[S]) -> Point[S]:
    """Return a trial next to a point in its place, facing the same way."""
    solution, unknowns = trial.solution, trial.unknowns
    ahead = equations.reduced(point.solution, point.tangent)
    found, tangent = near(equations, solution, unknowns, ahead)
    return replace(point, solution=solution, unknowns=unknowns, tangent=tangent, sign=found.sign)
