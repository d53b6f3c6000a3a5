"""Closed polygons in space: writhe, half twists of a band about them, and whether they cross."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.kernel import COMPILED

Index = NDArray[np.intp]

AT_ONCE = 5120  # pairs: those of a polygon of 100 points
LISTED = 1 << 22  # pairs whose indices are listed at once
MEETING = 1e-6  # distance, relative to the length of the polygon, at which segments meet


def half_twists(twist: float, writhe: float) -> tuple[int, float]:
    """Nearest whole number to 2 (Tw + Wr), both in turns, and the distance from it."""
    value = 2 * (twist + writhe)
    if not np.isfinite(value):
        return 0, float("inf")
    return round(value), abs(value - round(value))


def writhe(r: Array) -> float:
    """Writhe of the closed polygon through points r (k, 3), exactly.

    Every pair of segments contributes the signed area on the sphere of the directions from which
    they are seen to cross (Levitt 1983; Klenin and Langowski 2000, method 1a).
    """
    if COMPILED is not None:
        return float(COMPILED.writhe(len(r), np.ascontiguousarray(r, dtype=float)))
    return sum(float(_seen_areas(pairs).sum()) for pairs in _pairs(r)) / (2 * np.pi)


def writhe_and_crossings(r: Array) -> tuple[float, int]:
    """Writhe of the closed polygon r (k, 3) but for segments that meet, and how often they do.

    That is the writhe midway: where the line passes through itself it changes by 2.
    """
    reach = 2 * float(np.linalg.norm(np.roll(r, -1, axis=0) - r, axis=1).max())
    area, places = 0.0, np.empty((3, 0))
    for pairs in _pairs(r):
        meet = _meet(pairs, MEETING * _length(r))
        area += float(_seen_areas([points[:, ~meet] for points in pairs]).sum())
        places = np.hstack([places, (pairs[0] + pairs[1])[:, meet] / 2])
    count = 0
    while places.size:
        count += 1
        away = np.linalg.norm(places - places[:, :1], axis=0) > reach
        places = places[:, away]
    return area / (2 * np.pi), count


def _seen_areas(segments: list[Array]) -> Array:
    """Signed areas (pairs,) of pairs of segments."""
    a, b, c, d = segments
    ac, ad, bc, bd = c - a, d - a, c - b, d - b
    area = _spherical_triangle(ac, ad, bd) + _spherical_triangle(ac, bd, bc)
    side = np.einsum("ij,ij->j", _cross(d - c, b - a), ac)
    return np.asarray(np.sign(side) * np.abs(area))


def _spherical_triangle(u: Array, v: Array, w: Array) -> Array:
    """Signed areas (pairs,) that triangles of directions cover on the sphere.

    Van Oosterom and Strackee 1983: of degenerate ones nothing has to be divided.
    """
    lu, lv, lw = (np.sqrt(np.einsum("ij,ij->j", x, x)) for x in (u, v, w))
    volume = np.einsum("ij,ij->j", u, _cross(v, w))
    uv, uw, vw = (np.einsum("ij,ij->j", x, y) for x, y in ((u, v), (u, w), (v, w)))
    return np.asarray(2 * np.arctan2(volume, lu * lv * lw + uv * lw + uw * lv + vw * lu))


def crosses_itself(r: Array) -> bool:
    """Whether two segments of the closed polygon r (k, 3) meet, to 1e-6 of its length."""
    return any(_meet(pairs, MEETING * _length(r)).any() for pairs in _pairs(r))


def _length(r: Array) -> float:
    return float(np.linalg.norm(np.roll(r, -1, axis=0) - r, axis=1).sum())


def _meet(segments: list[Array], distance_of_meeting: float) -> NDArray[np.bool_]:
    """Whether the two segments of each pair are that near to one another."""
    a, b, c, d = segments
    first, second, gap = b - a, d - c, c - a
    normal = _cross(first, second)
    size = np.einsum("ij,ij->j", normal, normal)
    skew = size > 0
    size = np.where(skew, size, 1.0)
    distance = np.abs(np.einsum("ij,ij->j", gap, normal)) / np.sqrt(size)
    # Where on each segment, from 0 to 1, the lines through them are nearest.
    places = [np.einsum("ij,ij->j", _cross(gap, v), normal) / size for v in (second, first)]
    inside = (np.abs(np.array(places) - 0.5) < 0.51).all(axis=0)
    return np.asarray(skew & inside & (distance < distance_of_meeting))


def _pairs(r: Array) -> Iterator[list[Array]]:
    """Yield the ends a, b and c, d (3, pairs) of all pairs of segments that share no point.

    A few at a time: all at once would take more memory than the rest of a solve.
    """
    # Columns of three: numpy then works on long rows.
    points = np.ascontiguousarray(r.T)
    after = np.roll(points, -1, axis=1)
    for i, j in _indices(len(r)):
        for start in range(0, len(i), AT_ONCE):
            part = slice(start, start + AT_ONCE)
            first, second = i[part], j[part]
            ends = (points, first), (after, first), (points, second), (after, second)
            yield [np.take(p, k, axis=1) for p, k in ends]


def _indices(count: int) -> Iterator[tuple[Index, Index]]:
    """Yield the indices of those pairs, i < j, of as many i at once as memory is no matter for."""
    rows = max(1, LISTED // count)
    for start in range(0, count, rows):
        firsts = np.arange(start, min(start + rows, count))
        # The last segment is next to the first.
        ends = np.where(firsts == 0, count - 1, count)
        each = np.maximum(ends - (firsts + 2), 0)
        i, before = np.repeat(firsts, each), np.cumsum(each) - each
        yield i, np.arange(len(i)) + np.repeat(firsts + 2 - before, each)


def _cross(u: Array, v: Array) -> Array:
    """Cross products of columns (3, k)."""
    x, y, z = u
    a, b, c = v
    found = np.empty_like(u)
    found[0] = y * c - z * b
    found[1] = z * a - x * c
    found[2] = x * b - y * a
    return found
