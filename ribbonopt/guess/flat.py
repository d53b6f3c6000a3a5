"""What lies in a plane but for a little: the same without that little, as a guess.

Out of its plane a planar ribbon of Sadowsky's is a rod with B3 = 2 B2, of which some stand at the
verge of leaving it (the figure of eight): equations that are singular across the plane, though not
in it. From a guess that is planar to the last digit Newton's method stays in the plane.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.section import RodFields
from ribbonopt.solution.solution import Solution

from .unknowns import Guess

NEARLY, EXACTLY = 1e-3, 1e-12  # of the largest moment and force, what is out of the plane


@dataclass(frozen=True, eq=False)
class Flattened:
    """Another guess, put into the plane across its mean d2."""

    guess: Guess

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length."""
        found = self.guess.fields(fraction)
        normal = _normal(found.frames[:, :, 1].mean(axis=0))
        d3 = _within(found.frames[:, :, 2], normal)
        d3 /= np.linalg.norm(d3, axis=1, keepdims=True)
        d2 = np.broadcast_to(normal, d3.shape)
        frames = np.stack([np.cross(d2, d3), d2, d3], axis=2)
        r = found.r[:1] + _within(found.r - found.r[:1], normal)
        return RodFields(r, frames, _within(found.n, normal), found.m - _within(found.m, normal))


def nearly_flat(solution: Solution) -> bool:
    """Whether a solution lies in a plane but for a little, which may be an error."""
    o, off = solution.trajectory.at_nodes, 0.0
    for name in ("m3", "m1", "n2"):
        across, whole = o.largest(name), o.largest(name[0])
        if across >= NEARLY * whole > 0:
            return False
        off = max(off, across / whole if whole > 0 else 0.0)
    return off > EXACTLY


def _normal(direction: Array) -> Array:
    """Return a unit vector, an axis of the lab if near to one: rounding then does not matter."""
    direction = direction / np.linalg.norm(direction)
    axis = np.round(direction)
    close = np.abs(direction - axis).max() < np.sqrt(NEARLY)
    return np.asarray(axis if close else direction)


def _within(vectors: Array, normal: Array) -> Array:
    """Parts (k, 3) of vectors within the plane."""
    return np.asarray(vectors - np.outer(vectors @ normal, normal))
