"""An order of points in which neighbours follow: each is the nearest of those left.

That costs the square of their number, so that many are divided into cells first, each walked by
itself: n log n.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ribbonopt.arrays import Array

Indices = np.ndarray[Any, np.dtype[np.signedinteger[Any]]]

MOST = 8_000  # points of a cell: beyond, chains are some per cent shorter and take much longer
FEW = 64  # points, from which those that were visited are put away


def chain(points: Array, size: int) -> list[int]:
    """Order points (k, d) so that each is the nearest of those left to the one before.

    In whatever order they are given, the result is the same. Every coordinate counts by the range
    of its values. Where there are many, a jump may stand behind a multiple of `size` points.
    """
    count = len(points)
    if not points.size:
        return list(range(count))
    spans = np.ptp(points, axis=0)
    points = (points - points.min(axis=0)) / np.where(spans > 0, spans, 1.0)
    sorted_ = np.lexsort(points.T[::-1])
    points = points[sorted_]
    cells = _cells(points, np.arange(count), size)
    walked = [cell[_walk(points[cell])] for cell in cells]
    return [int(i) for i in sorted_[np.concatenate(walked)]]


def _cells(points: Array, cell: Indices, size: int) -> Iterator[Indices]:
    """Divide a cell where it costs least, until none is too large."""
    if len(cell) <= MOST:
        yield cell
        return
    axis = max(range(points.shape[1]), key=lambda i: _gap(points[cell, i]))
    parts = -(-len(cell) // MOST)
    first = round(-(-len(cell) // size) * (parts // 2) / parts) * size
    along = np.argsort(points[cell, axis], kind="stable")
    for part in (along[:first], along[first:]):
        yield from _cells(points, cell[part], size)


def _gap(values: Array) -> float:
    """Mean gap of neighbouring values: rows of a grid are kept whole, and what is wide is cut."""
    return float(np.ptp(values)) / max(len(np.unique(values)) - 1, 1)


def _walk(points: Array) -> Indices:
    """Go from the first point (k, d) to the nearest of those left, again and again."""
    count = len(points)
    left, names = np.ascontiguousarray(points.T), np.arange(count)
    gaps, order, at = np.empty_like(left), np.empty(count, dtype=int), 0
    for i in range(count):
        order[i] = names[at]
        here = left[:, at, None].copy()
        left[:, at] = np.inf
        if 2 * (count - i) < len(names) > FEW:
            kept = np.isfinite(left[0])
            left, names = left[:, kept], names[kept]
            gaps = np.empty_like(left)
        np.abs(np.subtract(left, here, out=gaps), out=gaps)
        at = int(gaps.sum(axis=0).argmin())
    return order
