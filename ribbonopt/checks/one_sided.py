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
    nodes, stages = solution.at_nodes, solution.at_stages
    scale = float(np.abs(stages["m"]).max())
    value, beside = (v[[0, -1]] for v in (nodes["switching"], stages["switching"]))
    zero = (np.abs(value) <= ROUNDED * scale) & (np.abs(beside) > NEGLIGIBLE * scale)
    counts = np.array([True, value[1] * np.sign(beside[1]) <= 0])
    return bool((zero & (nodes["leap"][[0, -1]] > NEGLIGIBLE * scale) & counts).any())
