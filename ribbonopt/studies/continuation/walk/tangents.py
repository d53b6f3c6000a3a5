"""The tangent of a curve at one of its points."""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.arrays import Array

from .linearised import Heading, Linearised
from .points import Point, S
from .protocol import Equations, Trial


def near(
    equations: Equations[S], solution: S, unknowns: Array, ahead: Array
) -> tuple[Linearised, Array]:
    """Linearise at a solution; return that, and its tangent (n + k,) of unit arclength.

    `ahead` (m,) are coordinates of any direction along the curve.
    """
    found = equations.linearise(solution, unknowns, ahead)
    return found, _unit(equations, solution, found, ahead)


def headed(
    equations: Equations[S], solution: S, unknowns: Array, ahead: Array
) -> tuple[float, Array]:
    """Return the sign and the tangent (n + k,) of what may become a point; else as `near`."""
    found = equations.heading(solution, unknowns, ahead)
    return found.sign, _unit(equations, solution, found, ahead)


def _unit(equations: Equations[S], solution: S, found: Heading, ahead: Array) -> Array:
    """Return the tangent (n + k,) of unit arclength that points ahead."""
    metric, direction = equations.metric, found.direction
    y = equations.reduced(solution, direction)
    length = metric.length(y)
    return direction / (length if metric.product(y, ahead) >= 0 else -length)


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
