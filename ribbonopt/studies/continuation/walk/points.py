"""Points of a branch: a solution, where it is on the branch, and which way the branch goes on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.extended import Line, Local, local

from .curve import Curve

POINT, FOLD, BRANCH_POINT = "point", "fold", "branch point"


@dataclass(frozen=True, eq=False)
class Point:
    """One accepted point.

    Attributes
    ----------
    solution : Solution
        Verified.
    position : float
        Of the parameter, see `Curve`.
    tangent : (nw + 1,) array
        [dw, dl] per unit of arclength (see `arclength`), along the branch; in the layout of the
        solution.
    sign : float
        Sign of the extended determinant, comparable within one layout.
    step : float
        Arclength to try next.
    number, stage, branch : int
        Place in the whole continuation; branch 0 is the first.
    kind : str
        POINT, FOLD or BRANCH_POINT.
    row : mapping
        What is recorded, by name.
    """

    solution: Solution
    position: float
    tangent: Array
    sign: float
    step: float
    number: int = 0
    stage: int = 0
    branch: int = 0
    kind: str = POINT
    row: Mapping[str, Any] = field(default_factory=dict)

    @property
    def unknowns(self) -> Array:
        """Unknowns and position [w, l]."""
        return np.append(self.solution.dense.w, self.position)


def reduced(solution: Solution, extended: Array) -> Array:
    """Return states at both ends, constants of the rod and position, of a vector [w, l].

    They determine the whole solution, and are the same in any layout.
    """
    layout = solution.dense.blocks.layout
    nodes, _, c = layout.unpack(extended[:-1])
    rod = layout.nc - len(layout.elements) + 1
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


@dataclass(frozen=True, eq=False)
class Metric:
    """Arclength of a branch: sizes of the entries of `reduced` that count as one.

    Loads and states count relative to their size at the start of the stage, the position relative
    to its span.
    """

    sizes: Array

    @classmethod
    def at(cls, solution: Solution, position: float, span: float) -> Metric:
        """Return the metric for a stage that begins at a solution."""
        y = reduced(solution, np.append(solution.dense.w, position))
        sizes = 1 + np.abs(y)
        # Loads together: one that vanishes by symmetry is as large as the others.
        nx = solution.dense.blocks.layout.nx
        sizes[2 * nx :] = sizes[2 * nx :].max(initial=1.0)
        sizes[-1] = span
        return cls(sizes)

    def length(self, y: Array) -> float:
        """Arclength of a difference (of the form of `reduced`)."""
        return float(np.linalg.norm(y / self.sizes))

    def product(self, a: Array, b: Array) -> float:
        """Scalar product of two differences."""
        return float((a / self.sizes) @ (b / self.sizes))

    def dual(self, y: Array) -> Array:
        """Row that gives the scalar product with y."""
        return y / self.sizes**2


def near(
    curve: Curve, metric: Metric, solution: Solution, position: float, ahead: Array
) -> tuple[Local, Array]:
    """Linearise at a solution; return that, and its tangent of unit arclength.

    `ahead` is any direction (of the form of `reduced`) along the branch.
    """
    line: Line = curve.line(solution)
    found = local(line, row_of(solution, metric.dual(ahead)), solution.dense.w, position)
    direction = found.direction
    y = reduced(solution, direction)
    if metric.product(y, ahead) < 0:
        direction, y = -direction, -y
    return found, direction / metric.length(y)
