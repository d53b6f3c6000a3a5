"""Bars of what supports carry."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ribbonopt.solution.acting import reactions
from ribbonopt.solution.solution import Solution

from .estimate import SAFETY, analyse
from .gaps import ROUNDING


def reaction_errors(solution: Solution) -> tuple[float, ...]:
    """Bars of `reactions`, by the largest component of each; nan where none can be given.

    Differences to the next better scheme, as in `estimate_error`.

    Raises
    ------
    LinAlgError
        If the equations are singular.
    """
    found = analyse(solution)
    bar = SAFETY * found.more if found.known else math.nan
    ours, theirs = (
        [place.force for place in reactions(each)]
        for each in (solution, replace(solution, trajectory=found.other))
    )
    size = max((float(np.abs(force).max()) for force in ours), default=0.0)
    gaps = (float(np.abs(a - b).max()) for a, b in zip(ours, theirs, strict=True))
    return tuple(bar * max(gap, ROUNDING * size) for gap in gaps)
