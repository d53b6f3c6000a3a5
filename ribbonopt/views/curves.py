"""Smooth curves through points of a plane, for the eye: what is between points is not known."""

from __future__ import annotations

from collections.abc import Collection
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FINEST, COARSEST = 24, 2  # parts of a curve between two points
STEEPEST = 3.0  # slope over that of the chord, at which cubic curves go one way still
DENSE = 100.0  # parts per unit of length


def curves_through(points: Array, corners: Collection[int] = ()) -> list[Array]:
    """Return a curve (2, m) from each point to the next, smooth but at corners.

    Cubic Hermite curves in the chord length. The tangent at a point is that of the parabola through
    its neighbours and no longer than one: no curve leaves its chord by more than a quarter of it.
    Along an axis that the points go along one way it does so too.

    Parameters
    ----------
    points
        Points (2, k), in a plane in which lengths along both axes may be compared.
    corners
        Indices of the points where the direction may change at once.
    """
    last = points.shape[1] - 1
    cuts = sorted({0, *(i for i in corners if 0 < i < last), last})
    return [curve for a, b in pairwise(cuts) if a < b for curve in _smooth(points[:, a : b + 1])]


def _smooth(points: Array) -> list[Array]:
    """Return the curves between points (2, k), k > 1."""
    ways = np.diff(points)
    chords = np.hypot(*ways)
    lengths = np.where(chords > 0, chords, 1.0)
    towards = ways / lengths
    tangents = _tangents(towards, np.maximum(chords, np.finfo(float).tiny))
    curves = []
    for i, (way, chord) in enumerate(zip(ways.T, chords, strict=True)):
        count = int(np.clip(np.ceil(DENSE * chord), COARSEST, FINEST))
        t = np.linspace(0.0, 1.0, count + 1)
        rise = t**2 * (3 - 2 * t)
        out, into = t * (1 - t) ** 2, t**2 * (t - 1)
        curve = points[:, i, None] + np.outer(way, rise)
        curve += chord * (np.outer(tangents[:, i], out) + np.outer(tangents[:, i + 1], into))
        curve[:, 0], curve[:, -1] = points[:, i], points[:, i + 1]  # to the last digit
        curves.append(curve)
    return curves


def _tangents(towards: Array, chords: Array) -> Array:
    """Return tangents (2, k) at points, from the directions (2, k - 1) and lengths between them."""
    if len(chords) == 1:
        return np.repeat(towards, 2, axis=1)
    before, after = chords[:-1], chords[1:]
    inner = (after * towards[:, :-1] + before * towards[:, 1:]) / (before + after)
    ends = 2 * towards[:, [0, -1]] - inner[:, [0, -1]]
    ends /= np.maximum(np.hypot(*ends), 1.0)
    found = np.column_stack([ends[:, 0], inner, ends[:, 1]])
    return _one_way(found, towards)


def _one_way(tangents: Array, towards: Array) -> Array:
    """Return tangents (2, k) no steeper along an axis than curves that go one way there have.

    That is three times the lesser slope (Fritsch and Carlson). Next to where points turn nothing is
    asked: there it would flatten what is round.
    """
    sides = np.pad(towards, ((0, 0), (2, 2)), mode="edge")
    around = np.stack([sides[:, i : i + tangents.shape[1]] for i in range(4)])
    most = STEEPEST * np.abs(around[1:3]).min(axis=0)
    up, down = (around > 0).all(axis=0), (around < 0).all(axis=0)
    tangents = np.where(up, np.clip(tangents, 0, most), tangents)
    return np.where(down, np.clip(tangents, -most, 0), tangents)
