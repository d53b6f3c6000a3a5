"""A shape with the force that balances its moments best, where no load acts in between."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.section import RodFields

from .unknowns import Guess

POINTS = 65


@dataclass(frozen=True, eq=False)
class Balanced:
    """Another guess with a constant force n: m = m_0 + n x r, by least squares.

    Exact for a shape in equilibrium, such as a helix with the moments of its law.
    """

    guess: Guess

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length."""
        found = self.guess.fields(fraction)
        return RodFields(found.r, found.frames, np.tile(self.force, (len(fraction), 1)), found.m)

    @cached_property
    def force(self) -> Array:
        """The force (3,), lab frame; no part of it along a straight line."""
        found = self.guess.fields(np.linspace(0.0, 1.0, POINTS))
        r = found.r - found.r.mean(axis=0)
        m = found.m - found.m.mean(axis=0)
        turned = -np.cross(r[:, None], np.eye(3)[None])  # (k, 3, 3): rows e_i x r
        return np.asarray(np.linalg.lstsq(turned.transpose(0, 2, 1).reshape(-1, 3), m.ravel())[0])
