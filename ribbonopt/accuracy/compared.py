"""Errors of a minimum: its difference to the answer on elements twice as wide.

A problem with a cost is not square: no step of Newton's method on a better scheme tells its error.
Two answers do, one on every element of the other halved. Where the order of convergence is low (a
jump of the strains, or where they fade as d / log d) their difference is no more than the error of
the finer one, and may by accident be less: of what the law says of its singularities a share counts
in any case. Where it is high the difference is the error of the coarser one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.trajectory import Trajectory
from ribbonopt.transcription import Mesh

from .gaps import LEAST, gaps_at_nodes, gaps_between
from .layers import Layers

SPARE = 10.0  # how much less than it may a solver leaves where strains next to jumps count
BESIDE = 1  # elements beside a jump in which its strains are not told


def mesh_to_begin(solution: Solution) -> Mesh:
    """Return the mesh on which one near by is to be solved: of a minimum with bars the coarser."""
    if solution.coarser is None:
        return solution.mesh
    return replace(solution, trajectory=solution.coarser).mesh


class Compared(NamedTuple):
    """Differences of two answers: of parts of the answer, and in each element (N,) of the coarser.

    `local` is what an element adds to them, `inside` the largest in it, both relative.
    """

    errors: dict[str, float]
    local: Array
    inside: Array


def alone(solution: Solution) -> bool:
    """Whether nothing tells a solution's error: a minimum that was found on one mesh only."""
    return bool(solution.problem.recovered) and solution.coarser is None


def compared(
    coarse: Trajectory,
    fine: Trajectory,
    near_by: tuple[Layers, ...],
    sizes: Mapping[str, float],
    least: float,
) -> Compared:
    """Compare two answers, one on the halved elements of the other, with sizes of its parts.

    `least` is what the solver leaves, over what may be wrong of strains that are to count.
    """
    clear = _clear_of_jumps(coarse, near_by, least)
    errors = gaps_at_nodes(coarse, fine, 2, clear)
    gap = fine.dense.at_nodes[::2] - coarse.dense.at_nodes
    size = np.maximum(np.abs(coarse.dense.at_nodes).max(axis=0), 1.0)
    local = np.abs(np.diff(gap, axis=0) / size).max(axis=1)
    everywhere = np.full(len(local), np.inf)
    more, inside = gaps_between(coarse, fine, near_by, everywhere, clear)
    # At its nodes controls are extrapolated from the stages of an element.
    strains = fine.at_nodes["u"][::2] - coarse.at_nodes["u"]
    jumped = np.where(clear(coarse.nodes), np.abs(strains).max(axis=1), 0.0)
    inside = np.maximum(inside, np.maximum(jumped[:-1], jumped[1:]) / max(sizes["u0"], LEAST))
    # Both may be off alike there, where no stage has met a layer of a clamp: the law tells, too.
    off = float(fine.at_nodes["law_residual"][0])
    errors["u0"] = max(errors["u0"], off, float(inside[0]) * sizes["u0"])
    inside[0] = max(inside[0], errors["u0"] / max(sizes["u0"], LEAST))
    inside[0] = max(inside[0], errors["H0"] / max(sizes["H0"], LEAST))
    errors = {name: max(gap, more.get(name, 0.0)) for name, gap in errors.items()}
    errors["u"] = max(errors["u"], errors["u0"])
    return Compared(errors, local, inside)


def _clear_of_jumps(
    coarse: Trajectory, near_by: tuple[Layers, ...], least: float
) -> Callable[[Array], NDArray[np.bool_]]:
    """Return what tells which fractions (k,) are in no element that strains change abruptly in.

    Nor so near to a jump that a minimum leaves them open: at the distance d elements are as wide,
    and so is the distance to a mixture, so that what a solver leaves costs strains that over d^2.
    """
    ends, last = coarse.ends, len(coarse.nodes) - 1
    kept = [near.jump | near.fade for near in near_by]
    places = np.concatenate(
        [
            a + (b - a) * near.places.real[k]
            for a, b, near, k in zip(ends[:-1], ends[1:], near_by, kept, strict=True)
        ]
    )
    jump = np.concatenate([near.jump[k] for near, k in zip(near_by, kept, strict=True)])
    reach = np.where(jump, np.sqrt(SPARE * least), 0.0)
    at = np.searchsorted(coarse.nodes, places) - 1
    left = np.minimum(coarse.nodes[np.clip(at - BESIDE, 0, last)], places - reach)
    right = np.maximum(coarse.nodes[np.clip(at + 1 + BESIDE, 0, last)], places + reach)

    def clear(fractions: Array) -> NDArray[np.bool_]:
        inside = (fractions[:, None] >= left) & (fractions[:, None] <= right)
        return np.asarray(~inside.any(axis=1))

    return clear
