"""Half of a symmetric loop, and the half that follows by symmetry.

Flip symmetry: the rotation R by pi about an axis carries the ribbon to itself and reverses it,
r(2 e - s) = R r(s) with e the end of the solved half. Both ends of the half lie on the axis and
cross it at a right angle, and so that forces and moments continue, n and m have no component along
it. If the axis is along d2 at e (Moebius, section 5 of the paper), d2 and u3 continue and u2
changes sign; if it is along d1 (a fold), d1, u2 and u3 continue.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ribbonopt.solution import Solution

from .pieces import Array, Piece

TOLERANCE = 1e-6  # of directors and fields, and of positions relative to the length


@dataclass(frozen=True)
class Flip:
    """Rotation by pi about an axis through the end of a ribbon; see the module.

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

    def rotate(self, vectors: Array) -> Array:
        """Rotate directions (k, 3)."""
        return np.asarray(2 * np.outer(vectors @ self.axis, self.axis) - vectors)

    def image(self, piece: Piece) -> Piece:
        """Return the piece that follows by symmetry, in order of increasing arclength."""
        sign = -1.0 if self.along_d2 else 1.0
        return Piece(
            s=(2 * self.end - piece.s)[::-1],
            u2=sign * piece.u2[::-1],
            u3=piece.u3[::-1],
            eta=sign * piece.eta[::-1],
            r=self.point + self.rotate(piece.r - self.point)[::-1],
            d1=sign * self.rotate(piece.d1)[::-1],
            d2=-sign * self.rotate(piece.d2)[::-1],
            d3=-self.rotate(piece.d3)[::-1],
            mirrored=True,
        )


def find_flip(solution: Solution) -> Flip | None:
    """Find the symmetry of which this solution is one half, if there is one.

    None for a ribbon that is already closed, and for one whose image would not join it smoothly
    (position and tangent, within 1e-6) at both ends.
    """
    start, end = solution.scene.interval
    ends = solution.outputs(np.array([start, end]))
    gap = ends["r"][0] - ends["r"][1]
    if np.linalg.norm(gap) <= TOLERANCE * (end - start):
        return None
    for name in ("d2", "d1"):
        axis = ends[name][1]
        flip = Flip(float(end), ends["r"][1], axis, name == "d2")
        off_axis = np.linalg.norm(gap - (gap @ axis) * axis) / (end - start)
        along = np.abs(ends["d1"][0] @ axis)
        across = [np.abs(ends["d3"][0] @ axis), min(along, 1 - along)]
        n, m = ends["n"][1], ends["m"][1] / (end - start)
        loads = max(abs(n @ axis), abs(m @ axis)) / max(np.linalg.norm([n, m]), 1e-300)
        if max(off_axis, *across, loads) <= TOLERANCE:
            return flip
    return None
