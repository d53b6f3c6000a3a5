"""The surface of a shape as points and faces: one sheet, its front where d1 points.

Rows nearer to each other than FINE are left out, as most formats round to single precision; where
pieces meet there is one row, with the values before. A closed band is joined to itself; one with
its face turned over is not, as no normals would fit: it has a seam, two rows in the same place.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.views.shape import Shape

Whole = NDArray[np.int64]

FINE = 1e-4  # of the length: distance of rows at least
MEET = 2e-3  # of the width: rows of two pieces nearer than this from edge to edge are one
LEAST = 1e-3  # of the length of a normal along d1, where generatrices cross
TINY = np.finfo(float).tiny
ACROSS = 4  # strips from edge to edge


@dataclass(frozen=True, eq=False)
class Mesh:
    """A surface, lab frame.

    Attributes
    ----------
    shape : Shape
        What it is the surface of.
    rows : (k,) array of int
        Rows of the shape that it is made of, in order.
    across : (c,) array
        Fractions of the half-width from -1 to 1: each row has a point at each.
    quads : (q, 4) array of int
        Corners of faces, counterclockwise as seen from the front.
    """

    shape: Shape
    rows: Whole
    across: Array
    quads: Whole

    @property
    def points(self) -> Array:
        """Points (k c, 3), row by row."""
        grid = np.stack([self.shape.points(v)[self.rows] for v in self.across], axis=1)
        return np.asarray(grid.reshape(-1, 3))

    @property
    def triangles(self) -> Whole:
        """Corners (2 q, 3) of triangles, two for each face."""
        return np.concatenate([self.quads[:, [0, 1, 2]], self.quads[:, [0, 2, 3]]])

    def spread(self, values: Array) -> Array:
        """Return values of all rows of the shape, (n,) or (n, 3), at each point of the surface."""
        return np.repeat(values[self.rows], len(self.across), axis=0)

    @property
    def normals(self) -> Array:
        """Unit normals (k c, 3) at the points, on the side of d1.

        That of r + v b with b = d2 + e d3 is along (1 + v (e' + u1 (1 + e^2))) d1 +
        v (e u2 - u3) (e d2 - d3): d1, but where e is not u3/u2, as on rods and beside leaps.
        """
        shape, rows = self.shape, self.rows
        e = np.einsum("ij,ij->i", shape.b, shape.d3)[rows, None]
        u1, u2, u3 = (u[rows, None] for u in (shape.u1, shape.u2, shape.u3))
        v = shape.half_widths[rows, None] * self.across
        slope = (np.gradient(e[:, 0]) / np.maximum(np.gradient(shape.s[rows]), TINY))[:, None]
        front = np.maximum(np.abs(1 + v * (slope + u1 * (1 + e**2))), LEAST)
        aside = v * (e * u2 - u3)
        d1, d2, d3 = (d[rows, None] for d in (shape.d1, shape.d2, shape.d3))
        found = front[..., None] * d1 + aside[..., None] * (e[..., None] * d2 - d3)
        found /= np.linalg.norm(found, axis=2, keepdims=True)
        return np.asarray(found.reshape(-1, 3))


def mesh_of(shape: Shape, across: int = ACROSS) -> Mesh:
    """Return the surface of a shape as faces, in so many strips from edge to edge."""
    rows = _rows(shape)
    grid = np.arange(len(rows) * (across + 1)).reshape(len(rows), across + 1)
    if shape.closing > 0:
        rows, grid = rows[:-1], np.concatenate([grid[:-1], grid[:1]])
    corners = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    quads = np.stack(corners, axis=-1).reshape(-1, 4)
    return Mesh(shape, rows, np.linspace(-1.0, 1.0, across + 1), quads)


def _rows(shape: Shape) -> Whole:
    """Return the rows of a shape that are far enough from each other, and all ends of pieces."""
    length = float(shape.s[-1] - shape.s[0])
    stops = [*shape.starts[1:], len(shape.s)]
    found: list[int] = []
    for first, stop in zip(shape.starts, stops, strict=True):
        if found and _meet(shape, found[-1], first):
            piece = _spaced(shape.s, first, stop, FINE * length)[1:]
        else:
            piece = _spaced(shape.s, first, stop, FINE * length)
        found += piece
    return np.array(found, np.int64)


def _meet(shape: Shape, a: int, b: int) -> bool:
    """Whether two rows are in one place, from edge to edge."""
    edges = [shape.r + v * shape.half_widths[:, None] * shape.b for v in (-1.0, 1.0)]
    gaps = [np.linalg.norm(edge[a] - edge[b]) for edge in edges]
    return bool(max(gaps) <= MEET * shape.half_widths[a])


def _spaced(s: Array, first: int, stop: int, apart: float) -> list[int]:
    """Return the first and the last of some rows, and those between that are so far apart."""
    kept = [first]
    for row in range(first + 1, stop - 1):
        if min(s[row] - s[kept[-1]], s[stop - 1] - s[row]) >= apart:
            kept.append(row)
    return [*kept, stop - 1]
