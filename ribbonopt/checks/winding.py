"""How often a solution is wound between its ends, whole turns counted."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.rotations import quaternions_from
from ribbonopt.solution.solution import Solution

POINTS = 513


def winds_as(solution: Solution, winding: Array) -> bool:
    """Whether a solution turns from start to end as a rotation vector (3,) says.

    Along the directors of the start. The part of each frame's rotation about that axis is followed
    along the ribbon; it is not defined only where d3 would be turned right round.
    """
    frames = solution.fields(np.linspace(0.0, 1.0, POINTS)).frames
    angle = float(np.linalg.norm(winding))
    axis = winding / angle if angle else np.array([0.0, 0.0, 1.0])
    q = quaternions_from(np.einsum("ji,kjl->kil", frames[0], frames))
    turned = 2 * np.unwrap(np.arctan2(q[:, 1:] @ axis, q[:, 0]))
    return bool(abs(turned[-1] - turned[0] - angle) < np.pi / 2)
