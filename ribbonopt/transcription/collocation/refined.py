"""Dense output as one polynomial an element: as exact as substeps, and quick at many places.

What `DenseOutput.states` finds anew at each place, by a substep from the node before, is found here
once for all of an element: a scheme with more Gauss nodes than its own K is applied to it, started
on the collocation polynomial and improved by the same sweeps. Its polynomial has at least the order
p of the nodes throughout. It ends beside the next node by the error delta of K nodes in one step; a
substep over the share t of the element has that error times t^(p+1), up to higher orders, which is
added, so that elements join.

Elements of which that is not so, where the equations have a kink or neighbouring solutions part
fast, are told by sweeps that do not come to rest, by Legendre coefficients of derivatives that do
not decay, or by a large delta: they are left to the substeps.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.layout import Index
from ribbonopt.transcription.tableaus import gauss_of_any

from .blocks import ElementBlocks
from .phase_equations import PhaseEquations

BEYOND = 4  # nodes, more than twice its own
SWEEPS = 40
REST = 1e-12  # change of a sweep, of the largest state: the next changes a tenth of that
BESIDE = 1e-6  # delta, of the largest state, from which on substeps are asked
DECAYED = 1e-10  # what the last two Legendre coefficients add to a state, of the largest


class Read(Protocol):
    """What polynomials are made of: an output of collocation."""

    @property
    def blocks(self) -> ElementBlocks:
        """The discretised equations."""

    @property
    def p(self) -> Array:
        """Parameters."""

    @property
    def order(self) -> int:
        """Order of the error of `states`."""

    @property
    def at_nodes(self) -> Array:
        """States (N + 1, nx) at the nodes."""

    @property
    def rates(self) -> Array:
        """Derivatives (N, K, nx) at the stages, per relative position."""

    @property
    def polynomials(self) -> Refined:
        """What is made of it here, once."""

    def states(self, phase: int, sigma: Array) -> Array:
        """States (k, nx) by substeps."""

    def places(self, phase: int, sigma: Array) -> Array:
        """Positions sigma (k,) with the known fields there."""

    def equations(self, phase: int) -> PhaseEquations:
        """Equations of a phase."""


@dataclass(frozen=True, eq=False)
class Refined:
    """Polynomials of elements, of ordinary differential equations.

    Attributes
    ----------
    coefficients : (N, n, nx) array
        Of Chebyshev polynomials T_k(2t - 1) of the position t from 0 to 1 in each element.
    fit : (N,) array of bool
        Which elements they are good for.
    """

    coefficients: Array
    fit: NDArray[np.bool_]

    @classmethod
    def of(cls, output: Read) -> Refined:
        """Find the polynomials of an output."""
        K, lay = output.blocks.tableau.degree, output.blocks.layout
        tableau = gauss_of_any(2 * K + BEYOND)
        start, h = output.at_nodes[:-1], lay.widths(output.p)[:, None]
        size = float(np.abs(output.at_nodes).max())
        F, still = _swept(output, tableau.degree, REST * size)
        delta = output.at_nodes[1:] - start - h * _times(tableau.weights[None], F)[0]
        last = h * _times(tableau.legendre[-2:], F) / (2 * tableau.degree)
        decayed = np.abs(last).max(axis=(0, 2)) <= DECAYED * size
        integrals, power = _in_chebyshev(tableau.degree, output.order + 1)
        found = h * _times(integrals, F) + power[:, None, None] * delta
        found[0] += start
        fit = still & decayed & (np.abs(delta).max(axis=1) <= BESIDE * size)
        return cls(np.ascontiguousarray(found.swapaxes(0, 1)), fit)

    def __call__(self, element: Index, t: Array) -> Array:
        """States (k, nx) at positions t (k,) from 0 to 1 in elements (k,)."""
        basis = _chebyshev(t, self.coefficients.shape[1])
        return np.asarray((basis[:, None] @ self.coefficients[element])[:, 0])


def states_at_many(output: Read, phase: int, sigma: Array) -> Array:
    """States (k, nx) at relative positions sigma (k,) of a phase, by polynomials where they fit."""
    lay = output.blocks.layout
    if lay.nz or output.order == output.blocks.tableau.dense_order:
        return output.states(phase, sigma)
    element, t, _ = lay.locate(output.p, phase, sigma)
    x, rest = output.polynomials(element, t), ~output.polynomials.fit[element]
    if rest.any():
        x[rest] = output.states(phase, sigma[rest])
    return x


def _times(matrix: Array, values: Array) -> Array:
    """Return a matrix (m, M) times values (M, N, nx): (m, N, nx)."""
    found = matrix @ values.reshape(len(values), -1)
    return np.asarray(found.reshape(len(matrix), *values.shape[1:]))


def _chebyshev(t: Array, count: int) -> Array:
    """Return T_0 ... T_(count - 1) of 2t - 1 at t (k,), an array (k, count)."""
    return np.asarray(np.cos(np.arccos(2 * t - 1)[:, None] * np.arange(count)))


@lru_cache
def _in_chebyshev(degree: int, power: int) -> tuple[Array, Array]:
    """Return coefficients (n, M) of integrals of Lagrange's basis at Gauss nodes; of t^power."""
    count = max(degree, power) + 1
    t = (1 + np.cos(np.pi * (np.arange(count) + 0.5) / count)) / 2
    values = np.column_stack([gauss_of_any(degree).integrals(t), t**power])
    # The polynomials are orthogonal on these places.
    found = 2 / count * _chebyshev(t, count).T @ values
    found[0] /= 2
    return found[:, :-1], found[:, -1]


def _swept(output: Read, degree: int, rest: float) -> tuple[Array, NDArray[np.bool_]]:
    """Return derivatives (M, N, nx) at Gauss nodes, and in which elements (N,) sweeps come to rest.

    Elements that have come to it, or will not, are swept no further.
    """
    lay, tableau = output.blocks.layout, gauss_of_any(degree)
    start, h = output.at_nodes[:-1], lay.widths(output.p)
    places = lay.starts(output.p) + tableau.nodes[:, None] * h
    integrals = output.blocks.tableau.integrals(tableau.nodes)
    x = start + h[:, None] * _times(integrals, output.rates.swapaxes(0, 1))
    F, fit, moving = np.empty_like(x), np.zeros(len(h), dtype=bool), np.arange(len(h))
    before = np.full(len(h), np.inf)
    for _ in range(SWEEPS):
        found = _derivatives(output, moving, x, places[:, moving])
        improved = start[moving] + h[moving, None] * _times(tableau.matrix, found)
        change = np.abs(improved - x).max(axis=(0, 2))
        still = change <= rest
        goes_on = ~still & (change < before)
        x, before = improved, change
        if not goes_on.all():
            F[:, moving[~goes_on]], fit[moving[~goes_on]] = found[:, ~goes_on], still[~goes_on]
            x, before, moving = x[:, goes_on], before[goes_on], moving[goes_on]
            if not len(moving):
                break
    return F, fit


def _derivatives(output: Read, elements: Index, x: Array, positions: Array) -> Array:
    """Return derivatives (M, N, nx) at states and relative positions (M, N) in elements (N,)."""

    def of(phase: int, x: Array, positions: Array) -> Array:
        places = output.places(phase, positions.ravel())
        found, _ = output.equations(phase).derivatives(x.reshape(-1, x.shape[2]), places)
        return found.reshape(x.shape)

    slices = output.blocks.layout.phase_slices
    if len(slices) == 1:
        return of(0, x, positions)
    F = np.empty_like(x)
    cuts = np.searchsorted(elements, [its.start for its in slices] + [slices[-1].stop])
    for phase, (a, b) in enumerate(pairwise(cuts.tolist())):
        if a < b:
            F[:, a:b] = of(phase, x[:, a:b], positions[:, a:b])
    return F
