"""Inertia of a quadratic form along a chain of elements, by elimination, linear in their number.

With costates p as multipliers of x_{e+1} = A_e x_e + B_e y_e (`chain_form`), an element whose own
variables y are eliminated is a function of the state before and the costate behind it,

    x P x / 2 + p A x - p Y p / 2,

and two that follow each other are one such function again once what lies between them, (x, p), is
eliminated. Neighbours are joined in pairs, then the pairs, all of one level at once. By Sylvester's
and Haynsworth's theorems the negative eigenvalues of all pivots together, less one for each
multiplier, are the negative directions of the form under its conditions. A pivot is singular where
a part of the chain, held at one end and free at the other, is critical: then others are joined.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.transcription.layout import Index

from .chain_form import ChainForm

SINGULAR = 1e-6  # eigenvalue of a pivot, over the largest, from which on rounding is magnified
ARRANGEMENTS = 4  # ways to join neighbours that are tried


def factored(form: ChainForm, shift: float) -> Elimination:
    """Return the elimination of a form plus `shift` times its metric."""
    tried = []
    for arrangement in range(ARRANGEMENTS):
        tried.append(Elimination(form, shift, arrangement))
        if tried[-1].least > SINGULAR:
            return tried[-1]
    return max(tried, key=lambda each: each.least)


class Segments(NamedTuple):
    """Functions of the states before and the costates behind: P, A, Y (n, nx, nx) of each."""

    P: Array
    A: Array
    Y: Array

    def at(self, rows: Index) -> Segments:
        """Return some of them."""
        return Segments(*(part[rows] for part in self))


class _Level(NamedTuple):
    """What joins pairs of segments: those before and behind, their pivots inverted, and corners."""

    before: Index
    behind: Index
    kept: Index
    inverse: Array
    coupling: Array


class Elimination:
    """Factors of a form plus a shift of its metric.

    `negative` is the number of its negative directions; `least` the eigenvalue of a pivot that is
    nearest to zero, over the largest of that pivot or one.
    """

    def __init__(self, form: ChainForm, shift: float, arrangement: int = 0) -> None:
        self.form, self.nx = form, form.A.shape[1]
        self.negative, self.least = 0, np.inf
        segments = self._elements(shift)
        self.levels: list[_Level] = []
        while len(segments.P) > 1:
            skip = (arrangement >> len(self.levels)) & 1 if len(segments.P) > 2 else 0
            segments = self._joined(segments, skip)
        self._closed(segments, shift)

    def _elements(self, shift: float) -> Segments:
        """Eliminate the own variables of all elements."""
        form, nx = self.form, self.nx
        own = form.Q[:, nx:, nx:] + np.diag(shift * form.mass)
        try:
            np.linalg.cholesky(own)
        except np.linalg.LinAlgError:
            self._count(np.asarray(np.linalg.eigvalsh(own)))
        self.own = np.linalg.inv(own)
        self.sides = np.concatenate([form.Q[:, nx:, :nx], form.B.swapaxes(1, 2)], axis=2)
        change = self.sides.swapaxes(1, 2) @ self.own @ self.sides
        return Segments(
            form.Q[:, :nx, :nx] - change[:, :nx, :nx],
            form.A - change[:, nx:, :nx],
            change[:, nx:, nx:],
        )

    def _joined(self, segments: Segments, skip: int) -> Segments:
        """Join neighbours in pairs, all but the first `skip`, and maybe the last."""
        count, nx = len(segments.P), self.nx
        before = np.arange(skip, count - 1, 2)
        kept = np.setdiff1d(np.arange(count), np.concatenate([before, before + 1]))
        a, b = segments.at(before), segments.at(before + 1)
        values, vectors, scale = _eigen(_pivots(b.P, a.Y))
        self._count(values)
        self.negative -= nx * len(before)
        scaled = vectors * scale[..., None]
        inverse = (scaled / values[:, None]) @ scaled.swapaxes(1, 2)
        coupling = np.zeros((len(before), 2 * nx, 2 * nx))
        coupling[:, :nx, nx:], coupling[:, nx:, :nx] = b.A.swapaxes(1, 2), a.A
        change = coupling.swapaxes(1, 2) @ inverse @ coupling
        joined = Segments(
            a.P - change[:, :nx, :nx], -change[:, nx:, :nx], b.Y + change[:, nx:, nx:]
        )
        self.levels.append(_Level(before, before + 1, kept, inverse, coupling))
        order = np.argsort(np.concatenate([kept, before]), kind="stable")
        parts = zip(segments.at(kept), joined, strict=True)
        return Segments(*(np.concatenate(part)[order] for part in parts))

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
        values, vectors, scale = _eigen(K[None])
        self.negative += int((values < 0).sum()) - nx - len(C)
        scaled = vectors[0] * scale[0][:, None]
        self.last = (scaled / values[0]) @ scaled.T

    def _count(self, values: Array) -> None:
        sizes = np.abs(values)
        self.negative += int((values < 0).sum())
        relative = sizes.min(axis=1) / np.maximum(sizes.max(axis=1), 1.0)
        self.least = min(self.least, float(relative.min()))

    def solve(self, f0: Array, f: Array) -> tuple[Array, Array]:
        """Return x_0 and y (N, m) where the form less f_0 . x_0 + f . y is stationary."""
        nx = self.nx
        lines = (self.sides.swapaxes(1, 2) @ (self.own @ f[..., None]))[..., 0]
        # A line (state before; costate behind) for every segment; what is eliminated is kept.
        inner: list[tuple[Index, Array]] = []
        nodes: Index = np.arange(len(f) + 1)
        for level in self.levels:
            a, b = lines[level.before], lines[level.behind]
            between = np.concatenate([b[:, :nx], a[:, nx:]], axis=1)
            outer = np.concatenate([a[:, :nx], b[:, nx:]], axis=1)
            change = level.coupling.swapaxes(1, 2) @ (level.inverse @ between[..., None])
            inner.append((nodes, between))
            order = np.argsort(np.concatenate([level.kept, level.before]), kind="stable")
            lines = np.concatenate([lines[level.kept], outer - change[..., 0]])[order]
            nodes = np.delete(nodes, level.behind)
        side = np.zeros(len(self.last))
        side[:nx], side[2 * nx : 3 * nx] = lines[0, :nx] - f0, lines[0, nx:]
        found = -self.last @ side
        x, p = np.empty((len(f) + 1, nx)), np.empty((len(f) + 1, nx))
        x[0], p[-1] = found[:nx], found[2 * nx : 3 * nx]
        for level, (at, between) in zip(reversed(self.levels), reversed(inner), strict=True):
            outer = np.concatenate([x[at[level.before]], p[at[level.behind + 1]]], axis=1)
            total = (level.coupling @ outer[..., None])[..., 0] + between
            value = -(level.inverse @ total[..., None])[..., 0]
            middle = at[level.behind]
            x[middle], p[middle] = value[:, :nx], value[:, nx:]
        outer = np.concatenate([x[:-1], p[1:]], axis=1)
        return x[0], (self.own @ (f - (self.sides @ outer[..., None])[..., 0])[..., None])[..., 0]


def _pivots(P: Array, Y: Array) -> Array:
    """Second derivatives (n, 2 nx, 2 nx) in the state and costate between two segments."""
    unit = np.broadcast_to(-np.eye(P.shape[1]), P.shape)
    return np.block([[P, unit], [unit, -Y]])


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
