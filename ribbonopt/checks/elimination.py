"""Inertia of a quadratic form along a chain of elements, by elimination, linear in their number.

With costates p as multipliers of x_{e+1} = A_e x_e + B_e y_e (`chain_form`), an element whose own
variables y are eliminated is a function of the state before and the costate behind it,

    x P x / 2 + p A x - p Y p / 2,

and two that follow each other are one such function again once what lies between them, (x, p), is
eliminated. Neighbours are joined in pairs, then the pairs, all of one level at once. By Sylvester's
and Haynsworth's theorems the negative eigenvalues of all pivots together, less one for each
multiplier, are the negative directions of the form under its conditions.

A pivot is singular where a part of the chain, held at one end and free at the other, is critical.
Then its ends are put on springs, which neighbours give to each other: g |x|^2 / 2 behind the one is
as much less before the other, and changes nothing of the whole.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ribbonopt.arrays import Array

from .chain_form import ChainForm

SINGULAR = 1e-6  # eigenvalue of a pivot, over the largest, from which on rounding is magnified
LEAST = 1e-15  # the same: is zero
SPRINGS = (0.0, 1.0, -0.6, 2.7)  # that are tried, over the impedance of the elements


def factored(form: ChainForm, shift: float) -> Elimination:
    """Return the elimination of a form plus `shift` times its metric."""
    tried: list[Elimination] = []
    for spring in SPRINGS:
        # A stiffness, as the root of stiffness over compliance.
        number = spring * tried[0].impedance if tried else 0.0
        tried.append(Elimination(form.gauged(number) if number else form, shift))
        if tried[-1].least > SINGULAR:
            return tried[-1]
    return max(tried, key=lambda each: each.least)


class Segments(NamedTuple):
    """Functions of the states before and the costates behind: P, A, Y (n, nx, nx) of each."""

    P: Array
    A: Array
    Y: Array


class _Level(NamedTuple):
    """What joins pairs of segments: the inverses of their pivots, and what these are coupled to."""

    inverse: Array
    coupling: Array


class Elimination:
    """Factors of a form plus a shift of its metric.

    `negative` is the number of its negative directions; `least` the eigenvalue of a pivot that is
    nearest to zero, over the largest of that pivot or one.
    """

    def __init__(self, form: ChainForm, shift: float) -> None:
        self.form, self.nx = form, form.A.shape[1]
        self.negative, self.least = 0, np.inf
        segments = self._elements(shift)
        P, Y = (max(float(np.abs(part).max()), LEAST) for part in (segments.P, segments.Y))
        self.impedance = float(np.sqrt(P / Y))
        self.levels: list[_Level] = []
        while len(segments.P) > 1:
            segments = self._joined(segments)
        self._closed(segments, shift)

    def _elements(self, shift: float) -> Segments:
        """Eliminate the own variables of all elements."""
        form, nx = self.form, self.nx
        own = form.Q[:, nx:, nx:] + np.diag(shift * form.mass)
        try:
            np.linalg.cholesky(own)
            self.own = np.linalg.inv(own)
        except np.linalg.LinAlgError:
            self.own = self._inverted(own)
        self.sides = np.concatenate([form.Q[:, nx:, :nx], form.B.swapaxes(1, 2)], axis=2)
        change = self.sides.swapaxes(1, 2) @ self.own @ self.sides
        return Segments(
            form.Q[:, :nx, :nx] - change[:, :nx, :nx],
            form.A - change[:, nx:, :nx],
            change[:, nx:, nx:],
        )

    def _joined(self, segments: Segments) -> Segments:
        """Join neighbours in pairs; the last one may be left."""
        nx, count = self.nx, len(segments.P) // 2
        a, b, rest = (
            Segments(*parts)
            for parts in zip(*(_pairs(part, count) for part in segments), strict=True)
        )
        inverse = self._inverted(_pivots(b.P, a.Y))
        self.negative -= nx * count
        coupling = np.zeros((count, 2 * nx, 2 * nx))
        coupling[:, :nx, nx:], coupling[:, nx:, :nx] = b.A.swapaxes(1, 2), a.A
        change = coupling.swapaxes(1, 2) @ inverse @ coupling
        joined = Segments(
            a.P - change[:, :nx, :nx], -change[:, nx:, :nx], b.Y + change[:, nx:, nx:]
        )
        self.levels.append(_Level(inverse, coupling))
        return Segments(*(np.concatenate(both) for both in zip(joined, rest, strict=True)))

    def _closed(self, whole: Segments, shift: float) -> None:
        """Eliminate the rest: (x_0, x_N, p_N) and the multipliers of the conditions."""
        nx, (P, A, Y), C = self.nx, (part[0] for part in whole), self.form.C
        K = np.zeros((3 * nx + len(C), 3 * nx + len(C)))
        K[: 2 * nx, : 2 * nx] = self.form.ends
        K[:nx, :nx] += P + shift * np.eye(nx)
        K[2 * nx : 3 * nx, :nx], K[2 * nx : 3 * nx, nx : 2 * nx] = A, -np.eye(nx)
        K[2 * nx : 3 * nx, 2 * nx : 3 * nx] = -Y
        K[3 * nx :, : 2 * nx] = C
        K = np.tril(K) + np.tril(K, -1).T
        least = self.least
        self.last = self._inverted(K[None])[0]
        self.negative -= nx + len(C)
        self.least = least  # where the whole is critical it is what was asked

    def _inverted(self, matrices: Array) -> Array:
        """Inverses of symmetric pivots (n, k, k), whose inertia is counted."""
        values, vectors, scale = _eigen(matrices)
        sizes = np.abs(values)
        largest = np.maximum(sizes.max(axis=1), 1.0)[:, None]
        self.negative += int((values < 0).sum())
        self.least = min(self.least, float((sizes / largest).min()))
        values = np.where(sizes < LEAST * largest, LEAST * largest, values)
        scaled = vectors * scale[..., None]
        inverse: Array = (scaled / values[:, None]) @ scaled.swapaxes(1, 2)
        return inverse

    def solve(self, f0: Array, f: Array) -> tuple[Array, Array]:
        """Return x_0 and y (N, m) where the form less f_0 . x_0 + f . y is stationary."""
        forces = np.concatenate([np.zeros((len(f), self.nx)), f], axis=1)
        forces[0, : self.nx] = f0
        found = self.response(forces[..., None])[..., 0]
        return found[0, : self.nx], found[:, self.nx :]

    def response(self, forces: Array) -> Array:
        """Return (x_e, y_e) (N, nx + m, p) where the form less forces . (x_e, y_e) is stationary.

        `forces` (N, nx + m, p), p of them at once, act on the state before an element and on its
        own variables.
        """
        nx, f = self.nx, forces[:, self.nx :]
        # A line (state before; costate behind) for every segment, and those between pairs.
        lines = self.sides.swapaxes(1, 2) @ (self.own @ f)
        lines[:, :nx] -= forces[:, :nx]
        inner = []
        for level in self.levels:
            a, b, rest = _pairs(lines, len(level.inverse))
            between = np.concatenate([b[:, :nx], a[:, nx:]], axis=1)
            outer = np.concatenate([a[:, :nx], b[:, nx:]], axis=1)
            change = level.coupling.swapaxes(1, 2) @ (level.inverse @ between)
            inner.append(between)
            lines = np.concatenate([outer - change, rest])
        side = np.zeros((len(self.last), forces.shape[2]))
        side[:nx], side[2 * nx : 3 * nx] = lines[0, :nx], lines[0, nx:]
        found = -self.last @ side
        # State before and costate behind every segment.
        outer = np.concatenate([found[:nx], found[2 * nx : 3 * nx]])[None]
        for level, between in zip(reversed(self.levels), reversed(inner), strict=True):
            joined, rest = np.split(outer, [len(between)])
            middle = -(level.inverse @ (level.coupling @ joined + between))
            before = np.concatenate([joined[:, :nx], middle[:, nx:]], axis=1)
            behind = np.concatenate([middle[:, :nx], joined[:, nx:]], axis=1)
            both = np.stack([before, behind], axis=1).reshape(-1, 2 * nx, side.shape[1])
            outer = np.concatenate([both, rest])
        return np.concatenate([outer[:, :nx], self.own @ (f - self.sides @ outer)], axis=1)


def _pairs(parts: Array, count: int) -> tuple[Array, Array, Array]:
    """Return the first and the second ones of pairs, and what is left behind them."""
    return parts[: 2 * count : 2], parts[1 : 2 * count : 2], parts[2 * count :]


def _pivots(P: Array, Y: Array) -> Array:
    """Second derivatives (n, 2 nx, 2 nx) in the state and costate between two segments."""
    count, nx = P.shape[:2]
    found, i = np.zeros((count, 2 * nx, 2 * nx)), np.arange(nx)
    found[:, :nx, :nx], found[:, nx:, nx:] = P, -Y
    found[:, i, nx + i] = found[:, nx + i, i] = -1.0
    return found


def _eigen(matrices: Array) -> tuple[Array, Array, Array]:
    """Eigenvalues and vectors of symmetric matrices (n, k, k) scaled on both sides, and scales."""
    scale = np.ones(matrices.shape[:2])
    scaled = matrices
    for _ in range(2):
        largest = np.abs(scaled).max(axis=2)
        scale /= np.sqrt(np.where(largest > 0, largest, 1.0))
        scaled = scale[:, :, None] * matrices * scale[:, None]
    values, vectors = np.linalg.eigh(scaled)
    return values, vectors, scale
