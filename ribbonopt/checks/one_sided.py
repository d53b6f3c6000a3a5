"""Whether a ribbon ends where the strains of its law leap.

A clamp that bears the load of a strip loaded along its width has m2 = 0 and m3 not: there strains
by Sadowsky are those of the side that the ribbon comes from, and rounding would choose one.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.solution.solution import Solution

from .arcs import NEGLIGIBLE, ROUNDED


def ends_beyond_switch(solution: Solution) -> bool:
    """Whether at an end of the ribbon rounding takes the law to the side where the ribbon is not.

    There its switch is zero, to rounding, and its strains leap.
    """
    nodes, stages = solution.at_nodes, solution.at_stages
    scale = float(np.abs(stages["m"]).max())
    value, leap, beside = (
        v[[0, -1]] for v in (nodes["switching"], nodes["leap"], stages["switching"])
    )
    zero = (np.abs(value) <= ROUNDED * scale) & (np.abs(beside) > NEGLIGIBLE * scale)
    return bool((zero & (leap > NEGLIGIBLE * scale) & (value * np.sign(beside) <= 0)).any())
