"""The innermost point of a face, from which its border is farthest, and others far from it."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array

from .faces import Face

GRID = 24  # places along each side of what is searched
ROUNDS = 4  # each in a window that is so much smaller
CLOSER = 0.12
BESIDE = (0.25, 0.05, 0.01)  # of a side's length: places beside it, for slivers that no grid meets


def innermost(face: Face, away: Array | None = None) -> tuple[Array, float]:
    """Return the point (2,) of a face that is farthest from its border, and that distance.

    Parameters
    ----------
    face
        The face.
    away
        Points (n, 2) that it is to be far from as well.
    """
    sides = face.sides
    low, high = face.outer.min(axis=0), face.outer.max(axis=0)
    best, room = _best(face, sides, _beside(sides), away)
    size = high - low
    middle = (low + high) / 2
    for _ in range(ROUNDS):
        point, found = _best(face, sides, _grid(middle - size / 2, middle + size / 2), away)
        if found > room:
            best, room = point, found
        middle, size = best, size * CLOSER
    return best, _clear(best[None], sides)[0]


def distances(points: Array, sides: Array) -> Array:
    """Return how far points (n, 2) are from the nearest of segments (m, 2, 2), (n,)."""
    return _clear(points, sides)


def _best(face: Face, sides: Array, points: Array, away: Array | None) -> tuple[Array, float]:
    points = points[face.contains(points)]
    if not len(points):
        return face.outer[0], -1.0
    room = _clear(points, sides)
    if away is not None and len(away):
        gaps = np.hypot(*(points[:, None] - away).transpose(2, 0, 1)).min(axis=1)
        room = np.minimum(room, gaps / 3)  # a third: the border still counts for most
    best = int(room.argmax())
    return points[best], float(room[best])


def _grid(low: Array, high: Array) -> Array:
    sides = [np.linspace(a, b, GRID) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)


def _beside(sides: Array) -> Array:
    """Return points (n, 2) to the left of the middles of sides, where the face is."""
    ways = sides[:, 1] - sides[:, 0]
    left = np.stack([-ways[:, 1], ways[:, 0]], axis=1)
    return np.concatenate([sides.mean(axis=1) + share * left for share in BESIDE])


def _clear(points: Array, sides: Array) -> Array:
    starts, ways = sides[:, 0], sides[:, 1] - sides[:, 0]
    squares = np.maximum((ways**2).sum(axis=1), np.finfo(float).tiny)
    nearest = np.full(len(points), np.inf)
    for first in range(0, len(points), 256):  # so that much memory is never needed
        some = points[first : first + 256, None] - starts
        share = np.clip((some * ways).sum(axis=2) / squares, 0, 1)
        gaps = np.hypot(*(some - share[..., None] * ways).transpose(2, 0, 1))
        nearest[first : first + 256] = gaps.min(axis=1)
    return nearest
