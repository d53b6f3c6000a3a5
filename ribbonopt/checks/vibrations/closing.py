"""The seven conditions of a closed band that nothing holds: it returns to where it begins.

r(1) - r(0) = 0, vec(q0* o q1 o t*) = 0 and q0 . q0 = 1, where t is the half turn about d3 of a band
with an odd number of half twists, or nothing; in a plane positions and the angle return.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.rotations import product

UNIT = np.eye(4)
SIGNS = np.array([1.0, -1.0, -1.0, -1.0])


def _product(p: Array, q: Array) -> Array:
    return np.array(product(p, q))


@dataclass(frozen=True, eq=False)
class Closing:
    """The conditions of a closed band, as functions of its ends (2, nx).

    `turned` says whether directors return behind half a turn; `planar` whether states are those of
    a plane.
    """

    turned: bool
    planar: bool

    def conditions(self, ends: Array, *_: Array) -> list[Array]:
        """Return the conditions (k,), and their Jacobian in both ends, flat, columns first."""
        nx = ends.shape[1]
        if self.planar:
            return [np.zeros(3), np.hstack([-np.eye(3), np.eye(3)]).T.ravel()]
        jacobian = np.zeros((7, 2, nx))
        jacobian[:3, 0, :3], jacobian[:3, 1, :3] = -np.eye(3), np.eye(3)
        jacobian[3:6, 0, 3:7] = np.einsum("kij,j->ki", self._bilinear, ends[1, 3:7])
        jacobian[3:6, 1, 3:7] = np.einsum("kij,i->kj", self._bilinear, ends[0, 3:7])
        jacobian[6, 0, 3:7] = 2 * ends[0, 3:7]
        return [np.zeros(7), jacobian.reshape(7, 2 * nx).T.ravel()]

    def bent(self, ends: Array, _: Array, __: Array, multipliers: Array) -> list[Array]:
        """Return the Hessian of multipliers . conditions in both ends, flat."""
        nx = ends.shape[1]
        found = np.zeros((2, nx, 2, nx))
        if not self.planar:
            mixed = np.einsum("k,kij->ij", multipliers[3:6], self._bilinear)
            found[0, 3:7, 1, 3:7], found[1, 3:7, 0, 3:7] = mixed, mixed.T
            found[0, 3:7, 0, 3:7] = 2 * multipliers[6] * np.eye(4)
        return [found.ravel()]

    @property
    def _bilinear(self) -> Array:
        """Coefficients (3, 4, 4) of vec(q0* o q1 o t*) in q0 and q1."""
        turn = SIGNS * (UNIT[3] if self.turned else UNIT[0])
        rows = [[_product(_product(SIGNS * p, q), turn) for q in UNIT] for p in UNIT]
        return np.moveaxis(np.array(rows)[..., 1:], 2, 0)
