"""Where a law is singular on the ribbon itself, so that its strains leap and no phase ends there.

A strip with natural strains that stays planar leaps where it unbends into one that is curved across
alone (R = 0, `mechanics.laws.natural_sadowsky`): the fold of a tape spring ends there. Twist, as
little as it may be, makes that smooth; without any no mesh gets it right.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.solution.solution import Solution

NONE = 1e-7  # of the leap: what is not there


def unseen_leaps(solution: Solution) -> list[str]:
    """Say where strains leap inside a phase of a law that is not smooth."""
    trajectory = solution.trajectory
    _, fraction, _, phase = trajectory.stages
    least, found = NONE * float(np.abs(trajectory.at_stages["switching"]).max()), list[float]()
    for i in range(len(trajectory.ends) - 1):
        if solution.sheets and not solution.sheets[i]:
            continue  # a mixture of both sheets
        rows = trajectory.singular_at_stages(i)
        if not rows.size:
            continue
        places = fraction[phase == i]
        re, im, size = (rows[:, :, k] for k in range(3))
        twist, leap = np.maximum(np.abs(im[1:]), np.abs(im[:-1])), np.minimum(size[1:], size[:-1])
        on_axis = (twist <= NONE * leap) & (leap > least)
        found += list(places[1:][(((re[1:] > 0) != (re[:-1] > 0)) & on_axis).any(axis=1)])
    if not found:
        return []
    start, end = solution.scene.interval
    where = ", ".join(f"{start + (end - start) * at:.4g}" for at in found)
    return [
        f"about s = {where} the strip, which stays planar, leaps from bent to curved across alone "
        "(R = 0), without phases that end there; use law: variational, or twist it a little"
    ]
