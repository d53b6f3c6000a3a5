"""Dense output as one polynomial an element: as exact as substeps, and quick at many places.

What `DenseOutput.states` finds anew at each place, by a substep from the node before, is found here
once for all of an element: the scheme with 2K - 1 Gauss nodes is applied to it, started on the
collocation polynomial and improved by the same sweeps. Its polynomial has order 2K throughout, as
the nodes have. It ends beside the next node by the error delta of the K nodes in one step; a
substep over the share t of the element has that error times t^(2K+1), up to higher orders, which is
added, so that elements join.

Where derivatives have Legendre coefficients that do not decay, twice as many nodes are tried.
Elements that these are not enough for, where the equations have a kink or neighbouring solutions
part fast, are left to the substeps; so they are where delta is large.
"""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.layout import Index
from ribbonopt.transcription.tableaus import Tableau, gauss_of_any

if TYPE_CHECKING:
    from .output import DenseOutput

SWEEPS = 30
REST = 1e-13  # change of a sweep, of the largest state: the next changes less
BESIDE = 1e-6  # delta, of the largest state, from which on substeps are asked
DECAYED = 1e-10  # what the last two Legendre coefficients add to a state, of the largest


@dataclass(frozen=True, eq=False)
class Level:
    """Elements with polynomials of one degree: derivatives (N, M, nx) at the nodes of `tableau`.

    `row` (all elements,) are theirs among the N, -1 for elements of other levels; `delta` (N, nx).
    """

    tableau: Tableau
    row: Index
    rates: Array
    delta: Array


@dataclass(frozen=True, eq=False)
class Refined:
    """Polynomials of the elements of an output, of ordinary differential equations."""

    output: DenseOutput

    def states(self, phase: int, sigma: Array) -> Array:
        """States x (k, nx) at the relative positions sigma (k,) of a phase."""
        output = self.output
        if output.blocks.layout.nz or output.order == output.blocks.tableau.dense_order:
            return output.states(phase, sigma)
        element, t, h = output.blocks.layout.locate(output.p, phase, sigma)
        x, left = output.at_nodes[element], np.arange(len(t))
        for level in self._levels:
            row = level.row[element[left]]
            inside = row >= 0
            rows, row = left[inside], row[inside]
            integrals = level.tableau.integrals(t[rows])
            x[rows] += h[rows, None] * (integrals[:, None] @ level.rates[row])[:, 0]
            x[rows] += t[rows, None] ** (output.order + 1) * level.delta[row]
            left = left[~inside]
            if not len(left):
                return x
        x[left] = output.states(phase, sigma[left])
        return x

    @cached_property
    def _levels(self) -> tuple[Level, ...]:
        """Levels of all elements that polynomials are enough for."""
        K, lay = self.output.blocks.tableau.degree, self.output.blocks.layout
        rest, found = np.arange(lay.element_count), []
        for degree in (max(2 * K - 1, 2), 4 * K):
            tableau = gauss_of_any(degree)
            rates, delta, fit = self._swept(rest, tableau)
            row = np.full(lay.element_count, -1)
            row[rest[fit]] = np.arange(fit.sum())
            found.append(Level(tableau, row, rates[fit], delta[fit]))
            rest = rest[~fit]
            if not len(rest):
                break
        return tuple(found)

    def _swept(self, elements: Index, tableau: Tableau) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Derivatives (N, M, nx), delta (N, nx), and which elements (N,) these are good for.

        Elements that have come to rest, or will not, are swept no further.
        """
        output, lay = self.output, self.output.blocks.layout
        start, h = output.at_nodes[elements], lay.widths(output.p)[elements]
        places = lay.starts(output.p)[elements, None] + h[:, None] * tableau.nodes
        integrals = output.blocks.tableau.integrals(tableau.nodes)
        x = start[:, None] + h[:, None, None] * (integrals @ output.rates[elements])
        size = float(np.abs(output.at_nodes).max())
        F, fit, moving = np.empty_like(x), np.zeros(len(h), dtype=bool), np.arange(len(h))
        before = np.full(len(h), np.inf)
        for _ in range(SWEEPS):
            found = self._derivatives(elements[moving], x, places[moving])
            improved = start[moving, None] + h[moving, None, None] * (tableau.matrix @ found)
            change = np.abs(improved - x).max(axis=(1, 2))
            still = change <= REST * size
            goes_on = ~still & (change < before)
            x, before = improved, change
            if not goes_on.all():
                done = ~goes_on
                F[moving[done]], fit[moving[done]] = found[done], still[done]
                x, before, moving = x[goes_on], before[goes_on], moving[goes_on]
                if not len(moving):
                    break
        delta = output.at_nodes[elements + 1] - start - h[:, None] * (tableau.weights @ F)
        last = h[:, None, None] * (tableau.legendre[-2:] @ F) / (2 * tableau.degree)
        fit &= np.abs(last).max(axis=(1, 2)) <= DECAYED * size
        return F, delta, fit & (np.abs(delta).max(axis=1) <= BESIDE * size)

    def _derivatives(self, elements: Index, x: Array, positions: Array) -> Array:
        """Derivatives (N, M, nx) at states (N, M, nx) and relative positions (N, M) in elements."""
        output, slices = self.output, self.output.blocks.layout.phase_slices
        F = np.empty_like(x)
        cuts = np.searchsorted(elements, [its.start for its in slices] + [slices[-1].stop])
        for phase, (a, b) in enumerate(pairwise(cuts.tolist())):
            if a < b:
                places = output.places(phase, positions[a:b].ravel())
                flat = x[a:b].reshape(-1, x.shape[2])
                F[a:b] = output.equations(phase).derivatives(flat, places)[0].reshape(F[a:b].shape)
        return F
