"""Where bending changes its sign along a ribbon, smoothly or by a jump: all places at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array

ROUNDS = 40
FIRST = (1 - np.cos(np.pi * np.arange(1, 12) / 12)) / 2  # of a bracket, where it is looked first
LADDER = np.concatenate([-(0.4 * 10.0 ** np.arange(8)[::-1]), 0.4 * 10.0 ** np.arange(8)])
LOCAL = 3  # places either side from which the crossing is interpolated


def crossings(
    told: Callable[[Array], tuple[Array, ...]],
    brackets: tuple[Array, Array],
    up: NDArray[np.bool_],
    tolerance: float,
) -> Array:
    """Return the first crossing (c,) in each of c brackets.

    Parameters
    ----------
    told
        Values (k,) at places (k,): first those whose sign changes, then others that may pass
        through zero at the same places, and more smoothly.
    brackets
        Places (c,) on either side.
    up
        Whether values are positive (c,) at the first of them.
    tolerance
        How exactly places are wanted.
    """
    a, b = (bound.copy() for bound in brackets)
    places = a[:, None] + (b - a)[:, None] * FIRST
    for _ in range(ROUNDS):
        values = [value.reshape(places.shape) for value in told(places.ravel())]
        after = (values[0] > 0) != up[:, None]
        first = np.where(after.any(axis=1), after.argmax(axis=1), places.shape[1])
        ends = np.column_stack([a, places, b])
        rows = np.arange(len(a))
        a, b = ends[rows, first], ends[rows, first + 1]
        if (b - a <= tolerance).all():
            break
        guesses = [_interpolated(places, value, first) for value in values]
        steps = [guess[:, None] + tolerance * LADDER for guess in guesses]
        middle = a[:, None] + (b - a)[:, None] * np.array([0.25, 0.5, 0.75])
        places = np.clip(np.column_stack([*steps, middle]), a[:, None], b[:, None])
        places.sort(axis=1)
    return np.asarray((a + b) / 2)


def _interpolated(places: Array, values: Array, first: NDArray[np.intp]) -> Array:
    """Return where values (c, k) at places (c, k) are zero near their columns `first` (c,).

    Places as a polynomial of the values, by Neville's scheme; where that is none, a place near.
    """
    columns = np.clip(first, LOCAL, places.shape[1] - LOCAL)[:, None] + np.arange(-LOCAL, LOCAL)
    rows = np.arange(len(first))[:, None]
    x, y = places[rows, columns], values[rows, columns]
    found = x.copy()
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for k in range(1, 2 * LOCAL):
            low, high = y[:, :-k], y[:, k:]
            found = (high * found[:, :-1] - low * found[:, 1:]) / (high - low)
    return np.asarray(np.where(np.isfinite(found[:, 0]), found[:, 0], x[:, LOCAL]))
