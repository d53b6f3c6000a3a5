"""Linear algebra of a chain of elements: stages eliminated by element, nodes by cyclic reduction.

1. Stages. The transcription eliminates what it has inside each element, if anything; what is left
   couples neighbouring nodes: A_e x_e + B_e x_{e+1} + C_e c = d_e.
2. Nodes. Pairs of neighbours are merged by orthogonal elimination of the node they share, all pairs
   of a level at once (structured orthogonal factorisation, Wright 1992): stable for growing and
   decaying modes alike, cost linear in the number of elements, few numpy calls.
3. When few nodes are left, they, the constants and the conditions make one small dense system.

The factors are kept: a new right-hand side costs matrix-vector products only.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.transcription.collocation.elimination import times
from ribbonopt.transcription.residuals import Derivatives, Residuals

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Blocks

    from .protocols import Condensed

DENSE = 80  # nodes of a phase are no longer reduced when their unknowns number less than this
NEUTRAL, NEARLY = 1e-8, 1e-4  # singular value that counts as none, over the largest and the next


@dataclass(frozen=True, eq=False)
class _Level:
    """One level of the reduction: factors that eliminate the middle node of each pair."""

    QT: Array  # (pairs, 2 nx, 2 nx)
    R_inverse: Array  # (pairs, nx, nx)
    left: Array  # (pairs, nx, nx), coefficient of the left node in the eliminated rows
    right: Array
    constants: Array


@dataclass(frozen=True, eq=False)
class _Chain:
    """Factors of the elements of one phase."""

    levels: tuple[_Level, ...]

    def reduce(self, d: Array) -> tuple[list[Array], Array]:
        """Carry a right-hand side (n, nx) down the levels: eliminated parts and what is left.

        A last element without a partner goes to the next level as it is.
        """
        eliminated = []
        nx = d.shape[1]
        for level in self.levels:
            pairs = len(level.QT)
            merged = (level.QT @ d[: 2 * pairs].reshape(pairs, 2 * nx, 1))[:, :, 0]
            eliminated.append(merged[:, :nx])
            d = np.concatenate([merged[:, nx:], d[2 * pairs :]])
        return eliminated, d

    def expand(self, nodes: Array, c: Array, eliminated: list[Array]) -> Array:
        """Nodes (n + 1, nx) of the phase from those that were not eliminated."""
        for level, d in zip(reversed(self.levels), reversed(eliminated), strict=True):
            pairs = len(level.QT)
            left, right = nodes[:pairs], nodes[1 : pairs + 1]
            known = times(level.left, left) + times(level.right, right) + level.constants @ c
            middle = times(level.R_inverse, d - known)
            wider = np.empty((len(nodes) + pairs, nodes.shape[1]))
            wider[0 : 2 * pairs : 2], wider[1 : 2 * pairs : 2] = left, middle
            wider[2 * pairs :] = nodes[pairs:]
            nodes = wider
        return nodes


def factored(
    blocks: Blocks,
    derivatives: Derivatives,
    p: Array,
    only: Residuals | None = None,
    neutral: bool = False,
) -> Condensed:
    """Factor the Newton matrix of a square problem, by the compiled kernel where it can.

    Quicker if it is for the stages' part of the residuals `only`. Where one `neutral` direction may
    change nothing, and does, steps leave it alone. LinAlgError where the matrix is singular.
    """
    if blocks.compiled is not None and not neutral:
        return blocks.compiled.factor(derivatives, p, only)
    return CondensedSystem(blocks, derivatives, p, only, neutral)


class CondensedSystem:
    """Factored Newton matrix of a square problem; `solve` gives the Newton step."""

    def __init__(
        self,
        blocks: Blocks,
        derivatives: Derivatives,
        p: Array,
        only: Residuals | None = None,
        neutral: bool = False,
    ) -> None:
        """Factor; quicker if it is for the stages' part of the residuals `only`.

        Where one `neutral` direction may change nothing, and does, steps leave it alone.
        """
        lay = self._layout = blocks.layout
        self._elements = blocks.eliminate(derivatives, p, only)
        A, B, C = self._elements.relations
        chains, rest = zip(
            *(_factor_chain(A[s], B[s], C[s]) for s in lay.phase_slices), strict=True
        )
        self._chains: tuple[_Chain, ...] = chains
        # Nodes that remain in each phase; neighbouring phases share one.
        self._ends = np.cumsum([0, *(len(a) for a, _, _ in rest)])
        A, B, C = (np.concatenate(part) for part in zip(*rest, strict=True))
        final = self._final(A, B, C, derivatives.conditions)
        self._final_inverse = _across_neutral(final) if neutral else np.linalg.inv(final)

    def solve(self, residuals: Residuals) -> Array:
        """Newton step (nw,): minus the inverse of the Jacobian times the residuals."""
        lay = self._layout
        d, share = self._elements.reduce(residuals)
        reduced = [
            chain.reduce(d[s]) for chain, s in zip(self._chains, lay.phase_slices, strict=True)
        ]
        right = np.concatenate([*(rest.ravel() for _, rest in reduced), -residuals.conditions])
        unknowns = self._final_inverse @ right
        remaining = unknowns[: len(unknowns) - lay.nc].reshape(-1, lay.nx)
        c = unknowns[len(unknowns) - lay.nc :]
        parts = [
            chain.expand(remaining[a : b + 1], c, eliminated)
            for chain, (eliminated, _), (a, b) in zip(
                self._chains, reduced, pairwise(self._ends), strict=True
            )
        ]
        nodes = np.concatenate([parts[0], *(part[1:] for part in parts[1:])])
        return lay.pack(nodes, self._elements.expand(nodes, c, share), c)

    @property
    def determinant(self) -> tuple[float, float]:
        """Sign and logarithm of the determinant, all nodes but the first eliminated.

        That is the determinant of the conditions by the first node and the constants, as single
        shooting has it: the same number on every mesh, to the accuracy of the mesh.
        """
        sign, log = np.linalg.slogdet(self._final_inverse)
        # The first node's columns go behind those of the nodes that are left; each that is not has
        # gone to the front already, past an odd number of rows and columns of blocks.
        parts = [(float(sign), -float(log)), ((-1.0) ** (self._layout.nx * self._ends[-1]), 0.0)]
        for chain in self._chains:
            for level in chain.levels:
                triangles = np.diagonal(level.R_inverse, axis1=1, axis2=2)
                sign = np.prod(np.sign(triangles)) * np.prod(np.linalg.slogdet(level.QT)[0])
                parts.append((float(sign), -float(np.log(np.abs(triangles)).sum())))
        return float(np.prod([sign for sign, _ in parts])), sum(log for _, log in parts)

    def _final(self, A: Array, B: Array, C: Array, conditions: Array) -> Array:
        """Dense matrix of the remaining nodes and the constants."""
        lay, count = self._layout, len(A)
        nx, width = lay.nx, (count + 1) * lay.nx
        final = np.zeros((width + lay.nc, width + lay.nc))
        rows = final[: count * nx].reshape(count, nx, -1)
        nodes = rows[:, :, :width].reshape(count, nx, count + 1, nx)
        e = np.arange(count)
        nodes[e, :, e] = A
        nodes[e, :, e + 1] = B
        rows[:, :, width:] = C
        points = (self._ends[:, None] * nx + np.arange(nx)).ravel()
        final[count * nx :, points] = conditions[:, : len(points)]
        final[count * nx :, width:] = conditions[:, len(points) :]
        return final


def _across_neutral(matrix: Array) -> Array:
    """Return the inverse of a matrix (n, n), less its smallest singular value if that is none."""
    if np.linalg.cond(matrix, 1) < 1 / NEUTRAL:
        return np.asarray(np.linalg.inv(matrix))
    left, singular, right = np.linalg.svd(matrix)
    if singular[-1] > NEARLY * singular[-2]:
        return np.asarray(np.linalg.inv(matrix))
    return np.asarray((right[:-1].T / singular[:-1]) @ left[:, :-1].T)


def _factor_chain(A: Array, B: Array, C: Array) -> tuple[_Chain, tuple[Array, Array, Array]]:
    """Reduce A_e x_e + B_e x_{e+1} + C_e c = d_e to few enough relations."""
    nx = A.shape[1]
    few = max(1, DENSE // nx - 1)
    levels = []
    while len(A) > few:
        pairs = len(A) // 2
        even = slice(0, 2 * pairs, 2), slice(1, 2 * pairs, 2)
        Q, R = np.linalg.qr(np.concatenate([B[even[0]], A[even[1]]], axis=1), mode="complete")
        QT = Q.swapaxes(1, 2)
        left = QT[:, :, :nx] @ A[even[0]]
        right = QT[:, :, nx:] @ B[even[1]]
        constants = QT[:, :, :nx] @ C[even[0]] + QT[:, :, nx:] @ C[even[1]]
        inverse = np.linalg.inv(R[:, :nx])
        levels.append(_Level(QT, inverse, left[:, :nx], right[:, :nx], constants[:, :nx]))
        A = np.concatenate([left[:, nx:], A[2 * pairs :]])
        B = np.concatenate([right[:, nx:], B[2 * pairs :]])
        C = np.concatenate([constants[:, nx:], C[2 * pairs :]])
    return _Chain(tuple(levels)), (A, B, C)
