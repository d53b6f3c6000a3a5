"""Coordinates of equilibria that are the same on every mesh and in any phases.

States at both ends, constants of the rod and the position determine the whole solution.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.solution.solution import Solution

from .curve import Curve
from .walk.metric import Metric


def reduced(solution: Solution, extended: Array) -> Array:
    """Return states at both ends, constants of the rod and position, of a vector [w, l].

    They determine the whole solution, and are the same in any layout.
    """
    layout = solution.dense.blocks.layout
    nodes, _, c = layout.unpack(extended[:-1])
    rod = layout.nc - solution.problem.kept(_lengths) - solution.problem.slack
    return np.concatenate([nodes[0], nodes[-1], c[:rod], extended[-1:]])


def row_of(solution: Solution, part: Array) -> Array:
    """Put a vector of the form of `reduced` in the place of its entries among all points and c."""
    layout = solution.dense.blocks.layout
    nx, points = layout.nx, len(layout.point_elements)
    row = np.zeros(points * nx + layout.nc + 1)
    row[:nx], row[(points - 1) * nx : points * nx] = part[:nx], part[nx : 2 * nx]
    rod = part[2 * nx : -1]
    row[points * nx : points * nx + len(rod)] = rod
    row[-1] = part[-1]
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


def _lengths(problem: BoundaryValueProblem) -> int:
    """Return how many constants are lengths of phases; those between stations are known."""
    return problem.lengths
