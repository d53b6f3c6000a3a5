"""Which states of a stage follow from the others by integration alone.

States R whose derivatives contain none of R themselves, such as the position r of a rod, whose
derivative d3 contains the quaternion but no r:

    X_R = x_0R + h A F_R(X_Q),

so that only the unknowns Q of the rest are solved for in an element.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.transcription.layout import Layout
from ribbonopt.transcription.tableaus import Tableau

Places = slice | NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Splitting:
    """Unknowns of a stage in two parts, and what the elimination needs of a scheme for them.

    `contains` (ne, nv + nc) says which equation of a stage contains which of its unknowns.
    """

    layout: Layout
    tableau: Tableau
    contains: NDArray[np.bool_]

    @cached_property
    def _integrated(self) -> NDArray[np.intp]:
        nx = self.layout.nx
        return independent(self.contains[:nx, :nx])

    @cached_property
    def _others(self) -> NDArray[np.intp]:
        return np.setdiff1d(np.arange(self.layout.nv), self._integrated)

    @cached_property
    def integrated(self) -> Places:
        """States R."""
        return _as_slice(self._integrated)

    @cached_property
    def rest(self) -> Places:
        """All other unknowns Q, algebraic ones last; and their equations."""
        return _as_slice(self._others)

    @cached_property
    def rest_states(self) -> Places:
        """States of the rest."""
        return _as_slice(self._others[: self.counts[2]])

    @cached_property
    def counts(self) -> tuple[int, int, int]:
        """Number of states R, of unknowns Q, and of states among these."""
        found = len(self._integrated)
        return found, self.layout.nv - found, self.layout.nx - found

    @cached_property
    def repeated(self) -> Array:
        """Coefficients of the scheme, for each unknown of the rest: (K + 1, 1, K nq)."""
        return np.repeat(self.tableau.coefficients, self.counts[1], axis=1)[:, None]

    @cached_property
    def identities(self) -> Array:
        """Identities (N, nx, nx)."""
        lay = self.layout
        return np.broadcast_to(np.eye(lay.nx), (lay.element_count, lay.nx, lay.nx))

    @cached_property
    def own(self) -> Array:
        """One where a row of a stage's rest is that of a state, zero where algebraic, (nq, 1)."""
        return np.asarray(self._others < self.layout.nx, dtype=float)[:, None]

    @cached_property
    def signs(self) -> Array:
        """Signs (nq,) with which residuals of the rest are right-hand sides."""
        return 1 - 2 * self.own[:, 0]

    def scaled(self, widths: Array) -> Array:
        """Return factors of derivatives (N, K, ne, nv + nc): the width where rows are rates."""
        if not self.layout.nz:
            return widths[:, None, None, None]
        rows = np.arange(self.layout.nv)[:, None] < self.layout.nx
        return np.where(rows, widths[:, None, None, None], 1.0)

    @cached_property
    def diagonal(self) -> Array:
        """The same for all stages of an element: (K nq,)."""
        return np.tile(self.own[:, 0], self.layout.stages)

    @cached_property
    def start(self) -> Array:
        """Where the first node's states stand in the rows of the rest, (nq, nx)."""
        return np.asarray(self._others[:, None] == np.arange(self.layout.nx), dtype=float)


def independent(contains: NDArray[np.bool_]) -> NDArray[np.intp]:
    """States whose derivatives contain none of them, chosen greedily; `contains` is (nx, nx)."""
    coupled = contains | contains.T
    left = ~np.diagonal(contains)
    found: list[int] = []
    while left.any():
        # The one that forbids fewest others.
        forbidden = np.where(left, (coupled & left).sum(axis=1), len(coupled) + 1)
        best = int(forbidden.argmin())
        found.append(best)
        left[best] = False
        left &= ~coupled[best]
    return np.array(sorted(found), dtype=np.intp)


def _as_slice(indices: NDArray[np.intp]) -> Places:
    """Return a slice where indices follow one another: views then instead of copies."""
    if len(indices) and np.ptp(indices) != len(indices) - 1:
        return indices
    first = int(indices[0]) if len(indices) else 0
    return slice(first, first + len(indices))
