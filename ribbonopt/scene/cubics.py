"""Piecewise cubics through the rows of a table: the spline with continuous curvature.

At its ends it is the one without a kink of the third derivative at the second and the last but one
arclength ("not a knot"), so that four rows of a cubic give that cubic; three rows give a parabola,
two a straight line.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from .along import Table


@dataclass(frozen=True, eq=False)
class Cubics:
    """Pieces between knots (k + 1,); coefficients (k, 4) of powers 0 to 3 of s - (left knot)."""

    knots: Array
    coefficients: Array

    @classmethod
    def through(cls, table: Table) -> Cubics:
        """Return the spline through the rows of a table."""
        s, values = np.array(table.s), np.array(table.values)
        h, slopes = np.diff(s), np.diff(values) / np.diff(s)
        bends = _second_derivatives(h, slopes)
        first, last = bends[:-1], bends[1:]
        tangents = slopes - h * (2 * first + last) / 6
        cubes = (last - first) / (6 * h)
        return cls(s, np.stack([values[:-1], tangents, first / 2, cubes], axis=1))

    @property
    def totals(self) -> Array:
        """Coefficients (k, 5) of the integral from the first knot, of powers 0 to 4."""
        powers = self.coefficients / np.arange(1, 5)
        pieces = (powers * np.diff(self.knots)[:, None] ** np.arange(1, 5)).sum(axis=1)
        before = np.concatenate([[0.0], np.cumsum(pieces)[:-1]])
        return np.column_stack([before, powers])

    def at(self, s: Array) -> Array:
        """Return the values (n,) at arclengths (n,); beyond the table its outer cubics go on."""
        piece = np.searchsorted(self.knots[1:-1], s, side="right")
        x, c = s - self.knots[piece], self.coefficients[piece].T
        return np.asarray(c[0] + x * (c[1] + x * (c[2] + x * c[3])))


def _second_derivatives(h: Array, slopes: Array) -> Array:
    """Second derivatives (k + 1,) at the knots, of widths h (k,) and slopes (k,) of the pieces."""
    count = len(h) + 1
    if count == 2:
        return np.zeros(2)
    if count == 3:
        return np.full(3, 2 * (slopes[1] - slopes[0]) / (h[0] + h[1]))
    matrix, right = np.zeros((count, count)), np.zeros(count)
    for i in range(1, count - 1):
        matrix[i, i - 1 : i + 2] = h[i - 1], 2 * (h[i - 1] + h[i]), h[i]
        right[i] = 6 * (slopes[i] - slopes[i - 1])
    matrix[0, :3] = -h[1], h[0] + h[1], -h[0]
    matrix[-1, -3:] = -h[-1], h[-2] + h[-1], -h[-2]
    return np.asarray(np.linalg.solve(matrix, right), dtype=float)
