"""Whether a ribbon ends where the strains of its law leap.

A clamp that bears the load of a strip loaded along its width has m2 = 0 and m3 not: there strains
by Sadowsky are those of the side that the ribbon comes from, and rounding would choose one.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.solution.solution import Solution

from .arcs import NEGLIGIBLE, ROUNDED


def ends_on_switch(solution: Solution) -> bool:
    """Whether at an end of the ribbon, to rounding, the law's switch is zero and strains leap.

    At the start, whose strains are told with a bar; at the end only where rounding takes the law to
    the side where the ribbon is not.
    """
    nodes, stages = solution.trajectory.at_nodes, solution.trajectory.at_stages
    scale = stages.largest("m")
    value, beside, leap = nodes["switching"], stages["switching"], nodes["leap"]
    for at in (0, -1):
        zero = abs(value[at]) <= ROUNDED * scale and abs(beside[at]) > NEGLIGIBLE * scale
        counts = at == 0 or value[at] * np.sign(beside[at]) <= 0
        if zero and leap[at] > NEGLIGIBLE * scale and counts:
            return True
    return False
