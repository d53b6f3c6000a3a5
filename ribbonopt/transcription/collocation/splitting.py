"""Which states of a stage follow from the others by integration alone.

States R whose derivatives contain none of R themselves, such as the position r of a rod, whose
derivative d3 contains the quaternion but no r:

    X_R = x_0R + h A F_R(X_Q),

so that only the unknowns Q of the rest are solved for in an element.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.functions import StageFunctions
from ribbonopt.transcription.layout import Layout
from ribbonopt.transcription.tableaus import Tableau

Places = slice | NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Splitting:
    """Unknowns of a stage in two parts, and what the elimination needs of a scheme for them."""

    layout: Layout
    tableau: Tableau
    phases: Sequence[StageFunctions]

    @cached_property
    def _integrated(self) -> NDArray[np.intp]:
        return integrated_states(self.phases, self.layout.nx)

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

    def repeated(self, count: int) -> Array:
        """Coefficients of the scheme, for each of `count` unknowns of a stage: (K + 1, 1, K n)."""
        return np.repeat(self.tableau.coefficients, count, axis=1)[:, None]

    @cached_property
    def identities(self) -> Array:
        """Identities (N, nx, nx)."""
        lay = self.layout
        return np.broadcast_to(np.eye(lay.nx), (lay.element_count, lay.nx, lay.nx))

    @cached_property
    def starts(self) -> Array:
        """Identity (nx, nx): what states have of those of the first node."""
        return np.eye(self.layout.nx)

    @cached_property
    def signs(self) -> Array:
        """Signs (nq,) with which residuals of the rest are right-hand sides."""
        return np.where(self._others < self.layout.nx, -1.0, 1.0)

    def scaled(self, widths: Array) -> Array:
        """Return factors of derivatives (N, K, ne, nv + nc): the width where rows are rates."""
        if not self.layout.nz:
            return widths[:, None, None, None]
        rows = np.arange(self.layout.nv)[:, None] < self.layout.nx
        return np.where(rows, widths[:, None, None, None], 1.0)

    @cached_property
    def diagonal(self) -> Array:
        """One where a row of an element's rest is that of a state, zero elsewhere: (K nq,)."""
        return np.tile(np.asarray(self._others < self.layout.nx, dtype=float), self.layout.stages)


def integrated_states(phases: Sequence[StageFunctions], nx: int) -> NDArray[np.intp]:
    """States R: their derivatives contain none of them, in any phase."""
    return independent(np.any([f.contains[:nx, :nx] for f in phases], axis=0))


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
