"""Cyclic reduction of a chain A_e x_e + B_e x_{e+1} + C_e c = d_e: two neighbours at once.

Pairs of neighbours are merged, all of a level at once, by eliminating the node that they share.
Where x_{e+1} is given outright (B_e = 1) and nothing grows along the second of each pair, it is put
in there. Else it is eliminated by orthogonal transformations (structured orthogonal factorisation,
Wright 1992), stable for growing and decaying modes alike.

Element e keeps its place: of a pair (e, f) the relation of f is left, from the first node of e to
node f + 1, and that of e becomes x_{e+1} = d_e - left x - right x_{f+1} - C_e c.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.transcription.collocation.elimination import times

DENSE = 80  # nodes are no longer reduced when their unknowns number less than this
GROWTH = 10.0  # largest factor by which what is put in may be multiplied

Index = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Pairs:
    """Elements merged in one level: (pairs,) each; both, (pairs, 2); nodes where they start."""

    first: Index
    second: Index
    both: Index
    start: Index


@dataclass(frozen=True, eq=False)
class Schedule:
    """Pairs of all levels, elements (m,) that remain, and nodes (m + 1,), in order."""

    levels: tuple[Pairs, ...]
    elements: Index
    nodes: Index


@lru_cache(1000)
def schedule(phases: tuple[int, ...], nx: int) -> Schedule:
    """Return what is merged where phases have so many elements, until few nodes are left.

    The nodes where phases meet remain.
    """
    ends = np.cumsum([0, *phases])
    left = [np.arange(a, b) for a, b in pairwise(ends)]
    levels = []
    while (sum(map(len, left)) + 1) * nx > DENSE and max(map(len, left)) > 1:
        nodes = _nodes(left)
        start = dict(zip(np.concatenate(left).tolist(), nodes.tolist(), strict=False))
        both = np.concatenate([e[: len(e) // 2 * 2].reshape(-1, 2) for e in left])
        at = np.array([start[e] for e in both[:, 0].tolist()])
        levels.append(Pairs(both[:, 0].copy(), both[:, 1].copy(), both, at))
        left = [np.append(e[1 : len(e) // 2 * 2 : 2], e[len(e) // 2 * 2 :]) for e in left]
    return Schedule(tuple(levels), np.concatenate(left), _nodes(left))


def _nodes(left: list[Index]) -> Index:
    return np.append(0, np.concatenate(left) + 1)


@dataclass(frozen=True, eq=False)
class Level:
    """Factors of one level.

    Attributes
    ----------
    pairs : Pairs
        Which elements.
    left : (pairs, nx, nx) array
        Coefficient of the first node in the relation of the node that is eliminated.
    factor : array
        What the right-hand side of the second takes of that of the first, (pairs, nx, nx); where
        transformed, what becomes of both, (pairs, 2 nx, 2 nx).
    right : (pairs, nx, nx) array or None
        Coefficient of the last node, where transformed.
    turned : pair of arrays or None
        Q and R of the transformation.
    """

    pairs: Pairs
    left: Array
    factor: Array
    right: Array | None = None
    turned: tuple[Array, Array] | None = None

    def reduce(self, d: Array) -> None:
        """Carry right-hand sides d (N, nx) through this level, in place."""
        pairs = self.pairs
        if self.right is None:
            d[pairs.second] -= times(self.factor, d[pairs.first])
            return
        both = d[pairs.both]
        d[pairs.both] = times(self.factor, both.reshape(len(both), -1)).reshape(both.shape)

    def expand(self, nodes: Array, d: Array) -> None:
        """Fill the nodes that were eliminated, in place; d (N, nx) less the constants' share."""
        pairs = self.pairs
        found = d[pairs.first] - times(self.left, nodes[pairs.start])
        if self.right is not None:
            found -= times(self.right, nodes[pairs.second + 1])
        nodes[pairs.first + 1] = found

    @property
    def determinant(self) -> tuple[float, float]:
        """Sign and logarithm of the determinant of what was eliminated."""
        if self.turned is None:
            return 1.0, 0.0
        Q, R = self.turned
        triangles = np.diagonal(R, axis1=1, axis2=2)
        sign = np.prod(np.sign(triangles)) * np.prod(np.linalg.slogdet(Q)[0])
        return float(sign), float(np.log(np.abs(triangles)).sum())


class Chain:
    """Factors of a chain of elements, reduced to few.

    Attributes
    ----------
    schedule : Schedule
        What remains.
    levels : tuple of Level
        How it was reduced.
    relations : three arrays
        A, B (m, nx, nx) and C (m, nx, nc) of the elements that remain.
    """

    def __init__(self, A: Array, B: Array, C: Array, phases: tuple[int, ...]) -> None:
        """Reduce; B (N, nx, nx) are identities."""
        given = True
        self.schedule = schedule(phases, A.shape[1])
        levels: list[Level] = []
        if self.schedule.levels:
            A, C = A.copy(), C.copy()
        for pairs in self.schedule.levels:
            first, second = pairs.first, pairs.second
            multiplier = A[second]
            if given and np.abs(multiplier).max() <= GROWTH:
                levels.append(Level(pairs, A[first], multiplier))
                A[second] = -multiplier @ levels[-1].left
                C[second] -= multiplier @ C[first]
            else:
                B = B.copy() if given else B
                given = False
                levels.append(_turned(A, B, C, pairs))
        self.levels, self._constants = tuple(levels), C
        left = self.schedule.elements
        self.relations = A[left], B[left], C[left]

    def reduce(self, d: Array) -> Array:
        """Carry right-hand sides d (N, nx) down all levels; `schedule.elements` remain."""
        if self.levels:
            d = d.copy()
        for level in self.levels:
            level.reduce(d)
        return d

    def expand(self, remaining: Array, c: Array, d: Array) -> Array:
        """Nodes (N + 1, nx) from those that remain, and reduced right-hand sides d."""
        if not self.levels:
            return remaining
        nodes = np.empty((len(d) + 1, d.shape[1]))
        nodes[self.schedule.nodes] = remaining
        d = d - self._constants @ c
        for level in reversed(self.levels):
            level.expand(nodes, d)
        return nodes


def _turned(A: Array, B: Array, C: Array, pairs: Pairs) -> Level:
    """Merge pairs by orthogonal transformations; A, B and C are replaced in place."""
    nx, first, second = A.shape[1], pairs.first, pairs.second
    Q, R = np.linalg.qr(np.concatenate([B[first], A[second]], axis=1), mode="complete")
    R = R[:, :nx]
    factor = Q.swapaxes(1, 2).copy()
    factor[:, :nx] = np.linalg.inv(R) @ factor[:, :nx]
    of_first, of_second = factor[:, :, :nx], factor[:, :, nx:]
    left, right = of_first @ A[first], of_second @ B[second]
    constants = of_first @ C[first] + of_second @ C[second]
    A[second], B[second], C[second] = left[:, nx:], right[:, nx:], constants[:, nx:]
    C[first] = constants[:, :nx]
    return Level(pairs, left[:, :nx], factor, right[:, :nx], (Q, R))
