"""Polylines of a plane, split where they meet, so that what is left meets at its ends only.

Lengths are those of the plane in which the rectangle of the map is the unit square.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

Ints = NDArray[np.int64]

SAME = 1e-9  # points this near to each other are one
TOUCH = 1e-10  # of a segment: beyond its ends, where rounding may have put what meets there
BLOCK = 500  # segments that are tried against all others at once


@dataclass(frozen=True, eq=False)
class Net:
    """Straight edges that meet at their ends only.

    Attributes
    ----------
    vertices : Array
        Points (v, 2).
    edges : Ints
        Pairs of vertices (e, 2).
    owners : Ints
        Which polyline each edge is of, (e,).
    """

    vertices: Array
    edges: Ints
    owners: Ints

    @property
    def pruned(self) -> Net:
        """Without edges that lead nowhere, which divide nothing."""
        keep = np.ones(len(self.edges), bool)
        while True:
            degree = np.bincount(self.edges[keep].ravel(), minlength=len(self.vertices))
            loose = keep & (degree[self.edges] == 1).any(axis=1)
            if not loose.any():
                return Net(self.vertices, self.edges[keep], self.owners[keep])
            keep &= ~loose


def net_of(lines: Sequence[Array]) -> Net:
    """Return the net of polylines (k, 2), split where they meet each other or themselves."""
    segments = [np.stack([line[:-1], line[1:]], axis=1) for line in lines]
    owners = np.repeat(np.arange(len(lines)), [len(some) for some in segments])
    ends = np.concatenate(segments)
    cuts = _cuts(ends)
    pieces, whose = [], []
    for i, (a, b) in enumerate(ends):
        at = np.array([0.0, *sorted(cuts.get(i, ())), 1.0])
        points = a + at[:, None] * (b - a)
        points[-1] = b
        pieces.append(np.stack([points[:-1], points[1:]], axis=1))
        whose += [owners[i]] * (len(at) - 1)
    found = np.concatenate(pieces)
    vertices, numbers = _merged(found.reshape(-1, 2))
    return _once(vertices, numbers.reshape(-1, 2), np.array(whose))


def _cuts(ends: Array) -> dict[int, list[float]]:
    """Return where along each segment (n, 2, 2) another one meets it, by the segment's number."""
    starts, ways = ends[:, 0], ends[:, 1] - ends[:, 0]
    low, high = ends.min(axis=1) - SAME, ends.max(axis=1) + SAME
    found: dict[int, list[float]] = {}
    for first in range(0, len(ends), BLOCK):
        mine = slice(first, first + BLOCK)
        near = (low[mine, None] <= high).all(axis=2) & (low <= high[mine, None]).all(axis=2)
        i, j = np.nonzero(near)
        i += first
        i, j = i[i < j], j[i < j]
        gap, cross = starts[j] - starts[i], _cross(ways[i], ways[j])
        with np.errstate(divide="ignore", invalid="ignore"):
            t, u = _cross(gap, ways[j]) / cross, _cross(gap, ways[i]) / cross
        ends_of_both = (-TOUCH, 1 + TOUCH)
        meets = np.isfinite(t) & np.isfinite(u)
        for share in (t, u):
            meets &= (share >= ends_of_both[0]) & (share <= ends_of_both[1])
        for number, share in ((i, t), (j, u)):
            for k in np.nonzero(meets & (share > TOUCH) & (share < 1 - TOUCH))[0]:
                found.setdefault(int(number[k]), []).append(float(share[k]))
    return found


def _cross(a: Array, b: Array) -> Array:
    """Return the cross products (n,) of vectors (n, 2)."""
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def _merged(points: Array) -> tuple[Array, Ints]:
    """Return points (v, 2) each once, and which of them each of the given ones (n, 2) is."""
    order = np.lexsort(points.T[::-1])
    names, kept = np.empty(len(points), np.int64), list[Array]()
    recent: list[int] = []  # of those kept, the ones whose first coordinate is near enough
    for k in order:
        recent = [n for n in recent if points[k, 0] - kept[n][0] <= SAME]
        same = next((n for n in recent if abs(points[k, 1] - kept[n][1]) <= SAME), None)
        if same is None:
            same = len(kept)
            kept.append(points[k])
            recent.append(same)
        names[k] = same
    return np.array(kept), names


def _once(vertices: Array, edges: Ints, owners: Ints) -> Net:
    """Leave out edges without length, and all but one of those between the same two points."""
    ways = np.sort(edges, axis=1)
    _, first = np.unique(ways, axis=0, return_index=True)
    first = np.sort(first)
    first = first[ways[first, 0] != ways[first, 1]]
    return Net(vertices, edges[first], owners[first])
