"""Coordinates of equilibria that are the same on every mesh and in any phases.

States at both ends, constants of the rod and the position determine the whole solution.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Layout

from .curve import Curve
from .walk.metric import Metric


def reduced(solution: Solution, extended: Array, count: int = 1) -> Array:
    """Return states at both ends, constants of the rod and positions, of a vector [w, l1 .. lk].

    They determine the whole solution, and are the same in any layout; `count` is k.
    """
    return reduced_in(solution.dense.blocks.layout, solution.problem, extended, count)


def reduced_in(
    layout: Layout, problem: BoundaryValueProblem, extended: Array, count: int = 1
) -> Array:
    """Return the same of a vector [w, l1 .. lk] in a layout of the problem."""
    last, c = layout.constants_at - layout.nx, layout.constants_at
    rod = c + layout.nc - problem.lengths - problem.slack
    ends = extended[: layout.nx], extended[last:c]
    return np.concatenate([*ends, extended[c:rod], extended[-count:]])


def row_of(solution: Solution, part: Array, count: int = 1) -> Array:
    """Put a vector of the form of `reduced` in the place of its entries among all points and c."""
    return row_in(solution.dense.blocks.layout, part, count)


def row_in(layout: Layout, part: Array, count: int = 1) -> Array:
    """Put the same in the place of its entries in a layout."""
    nx, points = layout.nx, len(layout.point_elements)
    row = np.zeros(points * nx + layout.nc + count)
    row[:nx], row[(points - 1) * nx : points * nx] = part[:nx], part[nx : 2 * nx]
    rod = part[2 * nx : -count]
    row[points * nx : points * nx + len(rod)] = rod
    row[-count:] = part[-count:]
    return row


def metric_at(solution: Solution, curve: Curve) -> Metric:
    """Return the metric of a stage that begins at a solution.

    Loads and states count relative to their size there, the position relative to its span.
    """
    sizes = 1 + np.abs(reduced(solution, np.append(solution.dense.w, curve.start)))
    # Loads together: one that vanishes by symmetry is as large as the others.
    nx = solution.dense.blocks.layout.nx
    sizes[2 * nx :] = sizes[2 * nx :].max(initial=1.0)
    sizes[-1] = curve.span
    return Metric(sizes)
