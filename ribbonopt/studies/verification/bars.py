"""Bars of numbers that are read off a solution in any way."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ribbonopt.accuracy.compared import alone
from ribbonopt.accuracy.estimate import SAFETY, analyse
from ribbonopt.accuracy.gaps import ROUNDING
from ribbonopt.checks.zero_moment import lacks_linearisation
from ribbonopt.solution.solution import Solution

Read = Callable[[Solution], float]


def carried(solution: Solution, read: Read, size: float) -> float:
    """Bar of a number by its difference to the next better scheme, as in `estimate_error`.

    Not below rounding of a number of that size; nan where no bar can be given.

    Raises
    ------
    LinAlgError
        If the equations are singular.
    """
    found = analyse(solution)
    gap = abs(read(solution) - read(replace(solution, trajectory=found.other)))
    return SAFETY * found.more * max(gap, ROUNDING * size) if found.known else math.nan


def known(bar: Read, solution: Solution) -> float | None:
    """Return what a reader of bars says of a solution, None where that is nothing."""
    if not solution.status.converged or lacks_linearisation(solution) or alone(solution):
        return None
    try:
        found = bar(solution)
    except np.linalg.LinAlgError:  # the solution is not the only one near
        return None
    return found if math.isfinite(found) else None
