"""A solution as a guess of another problem: its unknowns, where those are of the same kind."""

from __future__ import annotations

from ribbonopt.arrays import Array
from ribbonopt.problem import BoundaryValueProblem

from .trajectory import Trajectory


def unknowns_of(
    found: Trajectory, problem: BoundaryValueProblem, theta: Array, fraction: Array
) -> tuple[Array, Array] | None:
    """Return unknowns v (k, nv) and constants of a problem with parameters theta, at fractions.

    None where they cannot be taken as they are; lengths of phases and slack are not among them.
    """
    mine, own = found.problem, found.dense
    same = mine is problem or (
        mine.state_names == problem.state_names
        and mine.algebraic.numel() == problem.algebraic.numel() == 0
    )
    # Moments are about a point of reference.
    points = [
        [t[p.parameter_names.index(f"reference.{axis}")] for axis in "xyz"]
        for p, t in ((mine, own.theta), (problem, theta))
    ]
    if not same or points[0] != points[1]:
        return None
    rod = len(own.constants) - mine.lengths - mine.slack
    return found.approximate(fraction), own.constants[:rod]
