"""Where a curve comes near itself: the least distance between segments of a polygon, as places."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ribbonopt.arrays import Array

MOST = 20_000  # pairs of segments that are looked at closely, the nearest first


class Approach(NamedTuple):
    """A distance, and the two places along the curve, as fractions of its length."""

    distance: float
    first: float
    second: float


def nearest_approach(r: Array, within: float, apart: float, closed: bool) -> Approach | None:
    """Where an evenly spaced polygon comes nearest to itself; None if not nearer than `within`.

    Parameters
    ----------
    r
        Points (k, 3); of a closed polygon the first is not repeated.
    within
        Distance beyond which nothing counts.
    apart
        Least distance of the two places along the curve, as a fraction of its length.
    closed
        Whether the last point is followed by the first.
    """
    after = np.roll(r, -1, axis=0) if closed else r[1:]
    before = r if closed else r[:-1]
    count, middle = len(before), (before + after) / 2
    i, j = np.triu_indices(count, max(1, int(np.ceil(apart * count))))
    if closed:
        i, j = (k[count - (j - i) >= apart * count] for k in (i, j))
    longest = float(np.linalg.norm(after - before, axis=1).max())
    squares = np.einsum("ij,ij->i", middle, middle)
    apart_by = (squares[:, None] + squares - 2 * middle @ middle.T)[i, j]
    near = np.flatnonzero(apart_by < (within + longest) ** 2)
    if not len(near):
        return None
    near = near[np.argsort(apart_by[near], kind="stable")[:MOST]]
    i, j = i[near], j[near]
    distance, x, y = _between(before[i], after[i], before[j], after[j])
    best = int(distance.argmin())
    if not distance[best] < within:
        return None
    places = (i[best] + x[best]) / count, (j[best] + y[best]) / count
    return Approach(float(distance[best]), float(places[0]), float(places[1]))


def _between(a: Array, b: Array, c: Array, d: Array) -> tuple[Array, Array, Array]:
    """Distances (k,) of segments ab and cd, and where on each, from 0 to 1, they are nearest."""
    u, v, w = b - a, d - c, c - a
    uu, vv, uv, uw, vw = (np.einsum("ij,ij->i", p, q) for p, q in _products(u, v, w))
    free = uu * vv - uv**2
    with np.errstate(divide="ignore", invalid="ignore"):
        x = np.where(free > 0, (uw * vv - vw * uv) / free, 0.0)
    # Nearest on the lines, moved onto one segment, then the other, and the first again.
    x = np.clip(np.nan_to_num(x), 0.0, 1.0)
    y = np.clip((uv * x - vw) / vv, 0.0, 1.0)
    x = np.clip((uv * y + uw) / uu, 0.0, 1.0)
    gap = w + y[:, None] * v - x[:, None] * u
    return np.linalg.norm(gap, axis=1), x, y


def _products(u: Array, v: Array, w: Array) -> list[tuple[Array, Array]]:
    return [(u, u), (v, v), (u, v), (u, w), (v, w)]
