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
from typing import TYPE_CHECKING

import numpy as np

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
        x, rest = output.at_nodes[element], np.ones(len(t), dtype=bool)
        for level in self._levels:
            row = level.row[element]
            rows = np.flatnonzero(row >= 0)
            integrals = level.tableau.integrals(t[rows])
            x[rows] += h[rows, None] * (integrals[:, None] @ level.rates[row[rows]])[:, 0]
            x[rows] += t[rows, None] ** (output.order + 1) * level.delta[row[rows]]
            rest[rows] = False
        if rest.any():
            x[rest] = output.states(phase, sigma[rest])
        return x

    @cached_property
    def _levels(self) -> tuple[Level, ...]:
        """Levels of all elements that polynomials are enough for."""
        K, lay = self.output.blocks.tableau.degree, self.output.blocks.layout
        rest, found = np.arange(lay.element_count), []
        for degree in (max(2 * K - 1, 2), 4 * K):
            rates, delta, fit = self._swept(rest, gauss_of_any(degree))
            row = np.full(lay.element_count, -1)
            row[rest[fit]] = np.arange(fit.sum())
            found.append(Level(gauss_of_any(degree), row, rates[fit], delta[fit]))
            rest = rest[~fit]
            if not len(rest):
                break
        return tuple(found)

    def _swept(self, elements: Index, tableau: Tableau) -> tuple[Array, Array, Array]:
        """Derivatives, delta, and which of the elements these are good for."""
        output, lay = self.output, self.output.blocks.layout
        start, after = output.at_nodes[elements], output.at_nodes[elements + 1]
        h = lay.widths(output.p)[elements, None, None]
        positions = lay.starts(output.p)[elements, None] + h[:, :, 0] * tableau.nodes
        integrals = output.blocks.tableau.integrals(tableau.nodes)
        x = start[:, None] + h * (integrals @ output.rates[elements])
        size = float(np.abs(output.at_nodes).max())
        changes = np.full(len(h), np.inf)
        for _ in range(SWEEPS):
            F = self._derivatives(elements, x, positions)
            improved = start[:, None] + h * (tableau.matrix @ F)
            before, changes = changes, np.abs(improved - x).max(axis=(1, 2))
            x, still = improved, changes <= REST * size
            if (still | (changes >= before)).all():
                break
        delta = after - (start + h[:, 0] * (tableau.weights @ F))
        last = h * (tableau.legendre @ F)[:, -2:] / (2 * tableau.degree)
        decayed = np.abs(last).max(axis=(1, 2)) <= DECAYED * size
        return F, delta, still & decayed & (np.abs(delta).max(axis=1) <= BESIDE * size)

    def _derivatives(self, elements: Index, x: Array, positions: Array) -> Array:
        """Derivatives (N, M, nx) at states (N, M, nx) and relative positions (N, M) in elements."""
        output, F = self.output, np.empty_like(x)
        for phase, its in enumerate(output.blocks.layout.phase_slices):
            rows = slice(*np.searchsorted(elements, (its.start, its.stop)))
            if rows.start < rows.stop:
                places = output.places(phase, positions[rows].ravel())
                flat = x[rows].reshape(-1, x.shape[2])
                found, _ = output.equations(phase).derivatives(flat, places)
                F[rows] = found.reshape(F[rows].shape)
        return F
