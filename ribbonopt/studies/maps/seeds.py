"""Which equilibria at the beginning of a line no branch has led to yet."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np

from ribbonopt.plain import Row
from ribbonopt.scene.quantities import START_VECTORS
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.recorded import numbers_of
from ribbonopt.studies.continuation.walk.points import POINT

SAME = 0.02  # of the largest: what polynomials between points of a branch are trusted with
TOLD = ("energy", *(name for names in START_VECTORS for name in names))
ABOUT = 4  # points of a branch that its values between two of them are taken from


def is_known(seed: Solution, branches: Iterable[Sequence[Row]], parameter: str, at: float) -> bool:
    """Whether one of the branches goes through an equilibrium.

    Parameters
    ----------
    seed
        The equilibrium.
    branches
        Rows of regular points, in order, of each branch.
    parameter, at
        The number that branches move, and its value at the equilibrium.
    """
    found = numbers_of(seed)
    mine = np.array([found[name] for name in TOLD], float)
    return any(_goes_through(mine, rows, parameter, at) for rows in branches)


def branches_of(rows: Iterable[Row]) -> list[list[Row]]:
    """Return the regular points of rows, by branch."""
    found: dict[tuple[int, int], list[Row]] = {}
    for row in rows:
        if row["kind"] == POINT:
            found.setdefault((row["stage"], row["branch"]), []).append(row)
    return list(found.values())


def _goes_through(mine: np.ndarray, rows: Sequence[Row], parameter: str, at: float) -> bool:
    for i, (a, b) in enumerate(pairwise(rows)):
        low, high = sorted((a[parameter], b[parameter]))
        if not low <= at <= high or low == high:
            continue
        first = max(0, min(i + 1 - ABOUT // 2, len(rows) - ABOUT))
        some = _one_way(rows, i, first, parameter)
        values = np.array([[row[name] for name in TOLD] for row in some], float)
        there = _between(np.array([row[parameter] for row in some]), values, at)
        scale = np.maximum(np.abs(mine), np.abs(there)).max()
        if np.abs(there - mine).max() <= SAME * scale:
            return True
    return False


def _one_way(rows: Sequence[Row], i: int, first: int, parameter: str) -> Sequence[Row]:
    """Return rows about the step after row i, along which the parameter goes one way."""
    some = rows[first : first + ABOUT]
    steps = np.diff([row[parameter] for row in some])
    return some if (steps > 0).all() or (steps < 0).all() else rows[i : i + 2]


def _between(x: np.ndarray, values: np.ndarray, at: float) -> np.ndarray:
    """Return the polynomial through values (k, n) at x (k,), at a place."""
    weights = [
        np.prod([(at - b) / (a - b) for j, b in enumerate(x) if j != i]) for i, a in enumerate(x)
    ]
    return np.asarray(np.array(weights) @ values)
