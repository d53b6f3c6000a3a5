"""What the branches of a line begin with, and whether one of them has led there already."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from ribbonopt.errors import ConvergenceError, SceneError
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.plain import Row
from ribbonopt.scene import Scene, validate_scene
from ribbonopt.scene.equilibria import Equilibria
from ribbonopt.scene.quantities import START_VECTORS
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.recorded import numbers_of
from ribbonopt.studies.continuation.walk.points import POINT
from ribbonopt.studies.equilibria.all import all_equilibria

SAME = 0.02  # of the largest: what polynomials between points of a branch are trusted with
TOLD = ("energy", *(name for names in START_VECTORS for name in names))
BESIDE = 0.01  # of a range: how far beyond its ends is looked
ABOUT = 4  # points of a branch that its values between two of them are taken from


def seeds_at(
    scene: Scene, prepared: Prepared, along: str, limits: tuple[float, float]
) -> tuple[tuple[Solution, ...], float | None]:
    """Return the equilibria at a place of a line, looked for along this line alone.

    None where there is none; and the strain energy below which was looked.
    """
    low, high = limits
    more = BESIDE * (high - low)  # a range has the place itself inside
    asked = scene
    if not isinstance(scene.equilibria, Equilibria):
        asked = replace(scene, equilibria=Equilibria(along={along: (low - more, high + more)}))
        try:
            validate_scene(asked)
        except SceneError:  # there is nothing beyond the end
            asked = replace(scene, equilibria=Equilibria(along=(along,)))
    try:
        found = all_equilibria(asked, prepared)
    except ConvergenceError:
        return (), None
    return found.solutions, found.below


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
