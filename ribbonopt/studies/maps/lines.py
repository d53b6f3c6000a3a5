"""Loci as lines of the unit square: smooth between their points, joined to what they end at.

What is between the points of a locus is a cubic curve through them, so that loci that lie close
together are not crossed by chords. One that ends within reach of another, or of the border, ends
there: what a walk leaves out at a double point is no way from one region to another.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import pairwise

import numpy as np

from ribbonopt.arrays import Array

PARTS = 8  # of a curve between two points
UNEVEN = 4.0  # ratio of spacings, beyond which polynomials of degree 4 may swing
REACH = 4e-3  # of the square: an end this near to something ends there
BEYOND = 1e-6  # by how much it is drawn over that, so that both surely meet
CLOSED = 1e-6  # between the two ends of a closed line

BORDER = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]])


def smooth(points: Array, corners: Collection[int] = ()) -> Array:
    """Return a curve (m, 2) through points (k, 2), in their order, smooth but at corners.

    It holds each point as it is: point i is number `PARTS * i` of the curve.

    Parameters
    ----------
    points
        In the unit square; no two that follow one another are the same.
    corners
        Numbers of the points where the direction may change at once, such as cusps.
    """
    last = len(points) - 1
    if last < 2:
        return _straight(points)
    cuts = sorted({0, *(i for i in corners if 0 < i < last), last})
    parts = [
        _curve(points[a : b + 1], _closed(points) and len(cuts) == 2) for a, b in pairwise(cuts)
    ]
    return np.concatenate([parts[0], *(part[1:] for part in parts[1:])])


def joined(lines: Sequence[Array]) -> list[Array]:
    """Return the border and lines (k, 2), each led on from its ends to what is within reach."""
    all_ = [BORDER, *lines]
    found = [BORDER]
    for own, line in enumerate(lines, start=1):
        if not _closed(line):
            others = [np.stack([o[:-1], o[1:]], axis=1) for i, o in enumerate(all_) if i != own]
            for _ in range(2):
                line = _led_on(line, others)[::-1]
        found.append(line)
    return found


def _closed(line: Array) -> bool:
    return len(line) > 3 and float(np.hypot(*(line[-1] - line[0]))) <= CLOSED


def _straight(points: Array) -> Array:
    share = np.linspace(0, 1, PARTS + 1)[1:, None]
    parts = [a + share * (b - a) for a, b in pairwise(points)]
    return np.concatenate([points[:1], *parts])


def _curve(points: Array, closed: bool) -> Array:
    """Return a cubic Hermite curve in the length of chords."""
    if len(points) < 3:
        return _straight(points)
    if closed:
        around = np.concatenate([points[-4:-1], points, points[1:4]])
        whole = _curve(around, closed=False)
        return whole[3 * PARTS : -3 * PARTS]
    ways = np.diff(points, axis=0)
    chords = np.maximum(np.hypot(*ways.T), np.finfo(float).tiny)
    tangents = np.array([_tangent(points, chords, i) for i in range(len(points))])
    t = np.linspace(0, 1, PARTS + 1)[1:, None]
    rise, out, into = t**2 * (3 - 2 * t), t * (1 - t) ** 2, t**2 * (t - 1)
    parts = [points[:1]]
    for i, (way, chord) in enumerate(zip(ways, chords, strict=True)):
        part = points[i] + rise * way + chord * (out * tangents[i] + into * tangents[i + 1])
        part[-1] = points[i + 1]  # to the last digit
        parts.append(part)
    return np.concatenate(parts)


def _tangent(points: Array, chords: Array, i: int) -> Array:
    """Return the derivative (2,) at point i by the length of chords, from the points about it.

    From five of them, or from three where spacings differ much.
    """
    for count in (5, 3):
        width = min(count, len(points))
        first = min(max(i - width // 2, 0), len(points) - width)
        near = chords[first : first + width - 1]
        if near.max() <= UNEVEN * near.min() or count == 3:
            break
    at = np.concatenate([[0.0], np.cumsum(near)])
    gaps = at[i - first] - at
    others = [j for j in range(width) if at[j] != at[i - first]]
    weights = np.zeros(width)
    for j in others:
        rest = [k for k in others if k != j]
        weights[j] = np.prod(gaps[rest] / (at[j] - at[rest])) / (at[j] - at[i - first])
    weights[i - first] = -weights.sum()
    return np.asarray(weights @ points[first : first + width])


def _led_on(line: Array, others: Sequence[Array]) -> Array:
    """Return a line that goes on from its last point to the border, or else what else is near.

    `others` are segments (m, 2, 2) of the border and of all other lines, in this order.
    """
    for sides in (others[0], np.concatenate(others)):
        longer = _led_to(line, sides)
        if len(longer) > len(line):
            return longer
    return line


def _led_to(line: Array, sides: Array) -> Array:
    """Return a line that goes on from its last point to the nearest of sides, if that is near."""
    end = line[-1]
    starts, ways = sides[:, 0], sides[:, 1] - sides[:, 0]
    squares = np.maximum((ways**2).sum(axis=1), np.finfo(float).tiny)
    share = np.clip(((end - starts) * ways).sum(axis=1) / squares, 0, 1)
    feet = starts + share[:, None] * ways
    gaps = np.hypot(*(feet - end).T)
    nearest = int(gaps.argmin())
    if gaps[nearest] > REACH:
        return line
    way = feet[nearest] - end
    if gaps[nearest] < BEYOND:  # it is there: on along itself
        way = end - line[-2]
    way = way / max(float(np.hypot(*way)), np.finfo(float).tiny)
    return np.concatenate([line, (end + (gaps[nearest] + BEYOND) * way)[None]])
