"""Lowest eigenvalues of K x = omega^2 M x along a chain of elements, and none missed.

With M = R^T R and K + sigma M positive, mu = 1 / (omega^2 + sigma) are the eigenvalues of
R (K + sigma M)^-1 R^T, symmetric in the space of what moves at the stages: the largest come first
in a Krylov space of blocks. M on that side survives what is singular: of M turns without inertia,
of K folds and branch points. Elimination tells how many eigenvalues are below a number: were there
more than were found, another block would go on.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from ..chain_form import ChainForm
from ..elimination import Elimination, factored

BLOCK = 4  # right sides at once: modes come in pairs, of rings and of what is loosely coupled
RESIDUAL = 1e-7  # of an eigenvalue mu, over itself: its error is of the order of the square
STILL = 1e-12  # of the largest mu: does not move
DEPENDENT = 1e-13  # of a block: nothing new
MORE = 2  # modes found beyond those asked for: their residuals tell of those before
SHIFT = 500.0  # of omega^2, where stiffness, length and mass are one
SHIFTS, FARTHER = 12, 8.0  # tries of a shift below all eigenvalues, each that many times farther
BESIDE = 1e-7  # of omega^2 + sigma: how far behind the last mode others are counted


class Spectrum(NamedTuple):
    """Eigenvalues omega^2 (k,) in order, their modes, and how far below all the shift was.

    `modes` (N, nx + m, k) are the states before each element and its own variables, of kinetic
    energy one half at unit frequency. `complete` says that none is missed.
    """

    squared: Array
    modes: Array
    shift: float
    complete: bool


@dataclass(frozen=True, eq=False)
class Pencil:
    """K and M = R^T R along a chain of elements.

    `rows` (N, c, nx + m) are R by element, what moves at the stages; `soft`, next to nothing of the
    largest eigenvalue of K, is added to K times the metric of its form: variables without any
    effect are no disturbances.
    """

    form: ChainForm
    rows: Array
    soft: float

    @cached_property
    def mass(self) -> Array:
        """Hessians (N, nx + m, nx + m) of the elements."""
        found: Array = self.rows.swapaxes(1, 2) @ self.rows
        return found

    def factored(self, sigma: float) -> Elimination:
        """Return the elimination of K + sigma M."""
        return factored(replace(self.form, Q=self.form.Q + sigma * self.mass), self.soft)

    def lowest(self, count: int, scale: float) -> Spectrum | str:
        """Return the `count` lowest eigenvalues, all that move if fewer, or why there are none.

        `scale` is a stiffness over a mass and the fourth power of a length.
        """
        found = self._shifted(SHIFT * scale)
        if isinstance(found, str):
            return found
        factors, shift = found
        krylov = _Krylov(factors, self.rows)
        krylov.grow(count)
        while True:
            mu = krylov.values[:count]
            squared, complete = 1 / mu - shift, True
            if len(squared) < count:  # all that moves has been found
                break
            beyond = squared[-1] + BESIDE / mu[-1]
            known = int((1 / krylov.values - shift < beyond).sum())
            complete = self.factored(-beyond).negative <= known
            if complete or not krylov.again(count):
                break
        return Spectrum(squared, krylov.modes(len(squared)), shift, complete)

    def improved(self, near: Array, shift: float) -> Array:
        """Return the eigenvalues omega^2 (k,) of modes near to `near` (N, nx + m, k).

        `shift` is one below all of them. One step of the inverse iteration in all of the space of
        these modes: errors of the eigenvalues are of the order of the squares of theirs.
        """
        krylov = _Krylov(self.factored(shift), self.rows)
        moved, _ = np.linalg.qr((self.rows @ near).reshape(krylov.size, -1))
        krylov.enlarge(moved)
        return 1 / krylov.values - shift

    def _shifted(self, shift: float) -> tuple[Elimination, float] | str:
        """Return the factors of K + sigma M, positive, and sigma."""
        for _ in range(SHIFTS):
            factors = self.factored(shift)
            if not factors.negative:
                return factors, shift
            shift *= FARTHER
        return "something gives way that has no mass (inertia: d3 or d1)"


class _Krylov:
    """A growing basis of what moves at the stages, and the operator in it."""

    def __init__(self, factors: Elimination, rows: Array) -> None:
        self.factors, self.rows = factors, rows
        self.size = rows.shape[0] * rows.shape[1]
        self.basis, self.applied = np.empty((self.size, 0)), np.empty((self.size, 0))
        self.values, self.vectors = np.empty(0), np.empty((0, 0))
        self.random = np.random.default_rng(0)  # the same for each call

    def grow(self, count: int) -> None:
        """Enlarge the basis until `count` eigenvalues are exact, or nothing is left."""
        block = self.random.standard_normal((self.size, BLOCK))
        while (block := self._independent(block)).shape[1]:
            block = self.enlarge(block)
            if len(self.values) >= count + MORE and self._exact(count):
                return
        # Nothing is left: what is below rounding does not move.
        self.values = self.values[self.values > STILL * self.values[:1].sum()]

    def enlarge(self, block: Array) -> Array:
        """Enlarge the basis by a block, orthonormal to it, and return the operator times that."""
        applied = self._times(block)
        self.basis = np.hstack([self.basis, block])
        self.applied = np.hstack([self.applied, applied])
        small = self.basis.T @ self.applied
        values, vectors = np.linalg.eigh((small + small.T) / 2)
        self.values, self.vectors = values[::-1], vectors[:, ::-1]
        return applied

    def again(self, count: int) -> bool:
        """Go on with another block; false where there is none."""
        before = self.basis.shape[1]
        self.grow(count)
        return bool(self.basis.shape[1] > before)

    def modes(self, count: int) -> Array:
        """Return the modes (N, nx + m, count), scaled to R x of length one."""
        mu = self.values[:count]
        ritz = self.basis @ self.vectors[:, :count]
        return self._response(ritz) / mu

    def _response(self, moved: Array) -> Array:
        N, c, _ = self.rows.shape
        return self.factors.response(self.rows.swapaxes(1, 2) @ moved.reshape(N, c, -1))

    def _times(self, moved: Array) -> Array:
        found: Array = (self.rows @ self._response(moved)).reshape(moved.shape)
        return found

    def _independent(self, block: Array) -> Array:
        """Return an orthonormal basis of what a block has beside the basis; twice is enough."""
        size = np.linalg.norm(block)
        for _ in range(2):
            block = block - self.basis @ (self.basis.T @ block)
        q, r = np.linalg.qr(block)
        kept = np.abs(np.diag(r)) > DEPENDENT * size
        q = q[:, kept]
        found: Array = q - self.basis @ (self.basis.T @ q)
        return found

    def _exact(self, count: int) -> bool:
        kept = self.vectors[:, :count]
        rest = self.applied @ kept - self.basis @ (kept * self.values[:count])
        return bool((np.linalg.norm(rest, axis=0) <= RESIDUAL * self.values[:count]).all())
