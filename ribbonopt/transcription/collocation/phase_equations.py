"""The equations of one phase at states anywhere: algebraic variables, and how fast states part."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.functions import StageFunctions
from ribbonopt.transcription.layout import Layout


@dataclass(frozen=True, eq=False)
class PhaseEquations:
    """Equations of a phase at given constants and parameters (`numbers`)."""

    functions: StageFunctions
    layout: Layout
    numbers: tuple[Array, Array]

    def algebraic(self, x: Array, z: Array, places: Array) -> Array:
        """Algebraic variables (k, nz) that solve their equations at states x (k, nx), from z."""
        lay = self.layout
        if not lay.nz or lay.nz != lay.ng:
            return z
        rows, columns = slice(lay.nx, lay.nx + lay.ng), slice(lay.nx, lay.nv)
        for _ in range(3):  # from the accuracy of the polynomial to rounding
            values, jacobian = self._linearized(np.hstack([x, z]), places)
            z = z - _solved(jacobian[:, rows, columns], values[:, rows, None])[:, :, 0]
        return z

    def derivatives(self, v: Array, places: Array) -> tuple[Array, Array]:
        """Return derivatives F (k, nx) at v (k, nv), algebraic variables solved for; and v so."""
        lay = self.layout
        if lay.nz:
            x = v[:, : lay.nx]
            v = np.hstack([x, self.algebraic(x, v[:, lay.nx :], places)])
        values = self.functions.mapped_values(v, *self.numbers, places)[0]
        return values.reshape(len(v), -1)[:, : lay.nx], v

    def rates(self, v: Array, places: Array) -> Array:
        """Rates (k,) at which neighbouring solutions part or meet at unknowns v (k, nv)."""
        return rates_of(self._linearized(v, places)[1], self.layout)

    def _linearized(self, v: Array, places: Array) -> tuple[Array, Array]:
        """Equations (k, ne) and their derivatives (k, ne, nv + nc)."""
        values, jacobian = self.functions.mapped_dense(v, *self.numbers, places)
        columns = self.layout.nv + self.layout.nc
        jacobian = jacobian.reshape(len(v), columns, -1).swapaxes(1, 2)
        return values.reshape(len(v), -1), jacobian


def rates_of(jacobian: Array, layout: Layout) -> Array:
    """Rates (k,) at which neighbouring solutions part or meet, from derivatives (k, ne, nv + nc).

    The spectral radius of those by the states, algebraic variables following.
    """
    nx, held = layout.nx, slice(layout.nx, layout.nv)
    slopes = jacobian[:, :nx, :nx]
    if layout.nz and layout.nz == layout.ng:
        follow = _solved(jacobian[:, held, held], jacobian[:, held, :nx])
        slopes = slopes - jacobian[:, :nx, held] @ follow
    # From the eighth power, since norms of matrices far from normal say nothing.
    for _ in range(3):
        slopes = slopes @ slopes
    return np.asarray(np.abs(slopes).sum(axis=-1).max(axis=-1) ** 0.125)


def _solved(matrices: Array, right: Array) -> Array:
    """Solve for (k, n, m) with matrices (k, n, n); the least step where one is singular."""
    try:
        return np.asarray(np.linalg.solve(matrices, right))
    except np.linalg.LinAlgError:  # a law without derivative, at the one point where m = 0
        return np.asarray(np.linalg.pinv(matrices) @ right)
