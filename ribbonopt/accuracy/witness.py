"""What local errors do not show by themselves: what is conserved, and whose states they are of."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.mechanics.outputs import own_name
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.solution.trajectory import Trajectory

QUIET = 1e-12  # local errors that are rounding


def witness(better: Trajectory, split: int) -> Array:
    """Local errors (N,) that what is conserved betrays: the better scheme keeps it better."""
    nodes, found = better.at_nodes, np.zeros(1)
    force, moment, strain = (nodes.largest(name) for name in "nmu")
    # By how much states change H = W_Leg + n3: strain times that of the moment, and the force.
    scale = max(1.0, force + strain * (force + moment))
    for name in better.problem.conserved:
        values = nodes[name]
        steps = np.abs(values[1:] - values[:-1]) / scale
        found = np.maximum(found, summed(steps, split))
    return found


def more_of(local: Array, witnessed: Array) -> tuple[Array, float]:
    """Local errors with what was overlooked, and by how much that makes errors larger."""
    loud = witnessed > QUIET
    if not loud.any():
        return local, 1.0
    more = np.where(loud, np.maximum(local, witnessed), local)
    doubt = float(more.sum() / local.sum()) if more.max() > local.max() else 1.0
    return more, doubt


def summed(parts: Array, split: int) -> Array:
    """Return sums (N,) over the parts of each element."""
    return parts if split == 1 else np.asarray(parts.reshape(-1, split).sum(axis=1))


def columns_of_rod(problem: BoundaryValueProblem) -> NDArray[np.intp]:
    """Columns of the states that are none of the law's own."""
    names = problem.state_names
    return np.flatnonzero([own_name(name) not in problem.phases[0].outputs for name in names])
