"""The conditions of all that a piece was solved of: a closed band, a strip between two clamps.

A band that nothing holds returns to where it begins, r(1) - r(0) = 0, vec(q0* o q1 o t*) = 0 and
q0 . q0 = 1, where t is the half turn about d3 of a band with an odd number of half twists, or
nothing; in a plane positions and the angle return. Clamps hold r and q, vec(q* o dq) = 0.
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
        count = 3 if self.planar else 7
        # Other states, such as what loads make of the moment, are zero at the start.
        jacobian = np.zeros((nx, 2, nx))
        jacobian[count:, 0, count:] = np.eye(nx - count)
        jacobian[:3, 0, :3], jacobian[:3, 1, :3] = -np.eye(3), np.eye(3)
        if self.planar:
            return [np.zeros(nx), jacobian.reshape(nx, 2 * nx).T.ravel()]
        jacobian[3:6, 0, 3:7] = np.einsum("kij,j->ki", self._bilinear, ends[1, 3:7])
        jacobian[3:6, 1, 3:7] = np.einsum("kij,i->kj", self._bilinear, ends[0, 3:7])
        jacobian[6, 0, 3:7] = 2 * ends[0, 3:7]
        return [np.zeros(nx), jacobian.reshape(nx, 2 * nx).T.ravel()]

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


@dataclass(frozen=True, eq=False)
class Clamps:
    """Two clamps, as functions of the ends (2, nx) that they hold; `planar` as for a band."""

    planar: bool

    def conditions(self, ends: Array, *_: Array) -> list[Array]:
        """Return the conditions (k,), and their Jacobian in both ends, flat, columns first."""
        nx, count = ends.shape[1], 3 if self.planar else 7
        rows = np.eye(2 * nx).reshape(2, nx, 2, nx)
        if not self.planar:
            for end, q in enumerate(ends[:, 3:7]):
                turns = [_product(SIGNS * q, each) for each in UNIT]
                rows[end, 3:7, end, 3:7] = np.roll(np.array(turns).T, -1, axis=0)
            rows[0, 6] *= 2  # of q . q, half of which is q . dq
        # The length of q at the end is that at the start, and what is zero there is not known here.
        kept = [*rows[0], *rows[1, : count - (not self.planar)]]
        jacobian = np.array(kept).reshape(len(kept), 2 * nx)
        return [np.zeros(len(kept)), jacobian.T.ravel()]

    def bent(self, ends: Array, _: Array, __: Array, multipliers: Array) -> list[Array]:
        """Return the Hessian of multipliers . conditions in both ends, flat."""
        nx = ends.shape[1]
        found = np.zeros((2, nx, 2, nx))
        if not self.planar:
            found[0, 3:7, 0, 3:7] = 2 * multipliers[6] * np.eye(4)
        return [found.ravel()]
