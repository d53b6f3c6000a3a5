"""Where pictures stand in a map: near the point they are of, clear of lines and of each other."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from .curves import Array

STEPS = 41  # places along each side that are tried
APART = 0.012  # of the axes: least room between pictures, and between these and the frame
CROSSED = 0.6  # what it costs to lie on a line, and on each further sample of one
MORE = 0.05
ABROAD = 0.8  # what it costs to lie in other regions
SEEN = ((0.5, 0.5), (0.1, 0.1), (0.9, 0.1), (0.1, 0.9), (0.9, 0.9))  # of a picture, where it lies
ELSEWHERE = 1.5  # what it costs not to lie about the point itself


Inside = Callable[[Array], NDArray[np.bool_]]


def places_of(
    marks: Array, sizes: Sequence[Array], taken: Array, inside: Sequence[Inside]
) -> list[Array]:
    """Return the lower left corners (2,) of pictures, in shares of the axes.

    Parameters
    ----------
    marks
        Points (k, 2) that pictures are of, those that have least room first.
    sizes
        Width and height (2,) of each.
    taken
        Points (m, 2), close together along lines.
    inside
        For each picture what says of points (n, 2) whether they are in its own region.
    """
    found: list[tuple[Array, Array]] = []
    for number, (mark, size) in enumerate(zip(marks, sizes, strict=True)):
        corners = _corners(size)
        # About the point itself, where there is room.
        corners = np.concatenate([np.clip(mark - size / 2, APART, 1 - APART - size)[None], corners])
        near = np.clip(mark, corners, corners + size)
        cost = np.hypot(*(near - mark).T) + 0.3 * np.hypot(*(corners + size / 2 - mark).T)
        cost[1:] += 0.02 * ELSEWHERE
        for share in SEEN:
            cost += ABROAD / len(SEEN) * ~inside[number](corners + np.array(share) * size)
        on = (
            ((taken > corners[:, None]) & (taken < corners[:, None] + size)).all(axis=2).sum(axis=1)
        )
        cost += np.where(on > 0, CROSSED + MORE * on, 0.0)
        for corner, other in found:
            apart = (corners >= corner + other + APART) | (corner >= corners + size + APART)
            cost += 1e3 * ~apart.any(axis=1)
        for k in range(len(marks)):  # no picture hides the point that another one is of
            if k != number:
                cost += 0.3 * ((marks[k] > corners) & (marks[k] < corners + size)).all(axis=1)
        found.append((corners[int(cost.argmin())], size))
    return [corner for corner, _ in found]


def samples_of(lines: Sequence[Array], step: float = 0.01) -> Array:
    """Return points (m, 2) close together along lines (k, 2)."""
    found = [np.empty((0, 2))]
    for line in lines:
        gaps = np.hypot(*np.diff(line, axis=0).T)
        along = np.concatenate([[0.0], np.cumsum(gaps)])
        at = np.linspace(0, along[-1], int(along[-1] / step) + 2)
        found.append(np.stack([np.interp(at, along, part) for part in line.T], axis=1))
    return np.concatenate(found)


def _corners(size: Array) -> Array:
    sides = [np.linspace(APART, max(1 - APART - s, APART), STEPS) for s in size]
    return np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)
