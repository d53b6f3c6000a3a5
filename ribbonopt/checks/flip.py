"""Flips: the two-fold symmetry by which a piece of a closed band gives the piece that follows.

A flip is the rotation by pi about an axis through a point of the centre line, along d1 or d2 there.
It carries the band to itself and reverses it, r(2 e - s) = R r(s) with e the arclength of that
point. Forces and moments continue, so that n and m have no component along the axis. If the axis is
along d2 (Moebius, section 5 of the paper), d2 and u3 continue and u2 changes sign; if it is along
d1 (a fold), d1, u2 and u3 continue.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.solution.named import Each
from ribbonopt.solution.solution import Solution

TOLERANCE = 1e-6  # of directors and fields, and of positions relative to the length


@dataclass(frozen=True, eq=False)
class Flip:
    """Rotation by pi about an axis through one end of a ribbon; see the module.

    Attributes
    ----------
    end : float
        Arclength of that end.
    point, axis : (3,) arrays
        The end and the direction, a unit vector, lab frame.
    along_d2 : bool
        Whether the axis is along d2 there; along d1 if not.
    """

    end: float
    point: Array
    axis: Array
    along_d2: bool

    @property
    def matrix(self) -> Array:
        """Rotation (3, 3), which is its own inverse and transpose."""
        return np.asarray(2 * np.outer(self.axis, self.axis) - np.eye(3))

    def rotate(self, vectors: Array) -> Array:
        """Rotate directions (k, 3)."""
        return np.asarray(vectors @ self.matrix)

    def carry(self, points: Array) -> Array:
        """Rotate points (k, 3) about the axis."""
        return np.asarray(self.point + self.rotate(points - self.point))


def flip_at(values: Mapping[str, Array], s: Array, index: int, director: str) -> Flip:
    """Flip about a director, d1 or d2, at one row of outputs at arclengths s (k,)."""
    return Flip(float(s[index]), values["r"][index], values[director][index], director == "d2")


def at_ends(solution: Solution) -> Mapping[str, Array]:
    """Return outputs at both ends, in own units: (2,) for scalars, (2, 3) for vectors."""
    return Each(solution.at_nodes, lambda _, values: values[[0, -1]])


def find_flip(solution: Solution) -> Flip | None:
    """Find the flip at the end of a solution that is one half of a closed band, if it is one.

    None for a ribbon that is already closed, and for one whose image would not join it smoothly
    (position and tangent, within 1e-6) at both ends: both must lie on the axis.
    """
    start, end = solution.scene.interval
    s, ends = np.array([start, end]), at_ends(solution)
    gap = ends["r"][0] - ends["r"][1]
    if np.linalg.norm(gap) <= TOLERANCE * (end - start):
        return None
    for name in ("d2", "d1"):
        flip = flip_at(ends, s, 1, name)
        axis = flip.axis
        off_axis = np.linalg.norm(gap - (gap @ axis) * axis) / (end - start)
        along = np.abs(ends["d1"][0] @ axis)
        across = [np.abs(ends["d3"][0] @ axis), min(along, 1 - along)]
        n, m = ends["n"][1], ends["m"][1] / (end - start)
        loads = max(abs(n @ axis), abs(m @ axis)) / max(np.linalg.norm([n, m]), 1e-300)
        if max(off_axis, *across, loads) <= TOLERANCE:
            return flip
    return None
