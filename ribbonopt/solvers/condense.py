"""Linear algebra of a chain of elements: stages eliminated by element, nodes by cyclic reduction.

1. Stages. The transcription eliminates what it has inside each element, if anything; what is left
   couples neighbouring nodes: A_e x_e + B_e x_{e+1} + C_e c = d_e.
2. Nodes. Pairs of neighbours are merged by eliminating the node they share, all pairs of a level at
   once (`ribbonopt.solvers.chain`): cost linear in the number of elements, few numpy calls.
3. When few nodes are left, they, the constants and the conditions make one small dense system.

The factors are kept: a new right-hand side costs matrix-vector products only.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.transcription.residuals import Derivatives, Residuals

from .chain import Chain

if TYPE_CHECKING:
    from ribbonopt.transcription.structure import Blocks

    from .protocols import Condensed

NEUTRAL, NEARLY = 1e-8, 1e-4  # singular value that counts as none, over the largest and the next


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
        self._chain = Chain(*self._elements.relations, lay.elements)
        self._final = self._final_of(*self._chain.relations, derivatives.conditions)
        self._neutral, self._unused = neutral, only is not None and not neutral
        if not self._unused:
            _ = self._final_inverse  # tells what is singular now

    def solve(self, residuals: Residuals) -> Array:
        """Newton step (nw,): minus the inverse of the Jacobian times the residuals."""
        lay = self._layout
        d, share = self._elements.reduce(residuals)
        d = self._chain.reduce(d)
        left = d[self._chain.schedule.elements].ravel()
        unknowns = self._solve_final(np.concatenate([left, -residuals.conditions]))
        c = unknowns[len(unknowns) - lay.nc :]
        remaining = unknowns[: len(unknowns) - lay.nc].reshape(-1, lay.nx)
        nodes = self._chain.expand(remaining, c, d)
        return lay.pack(nodes, self._elements.expand(nodes, c, share), c)

    @property
    def determinant(self) -> tuple[float, float]:
        """Sign and logarithm of the determinant, all nodes but the first eliminated.

        That is the determinant of the conditions by the first node and the constants, as single
        shooting has it: the same number on every mesh, to the accuracy of the mesh.
        """
        sign, log = np.linalg.slogdet(self._final)
        # The first node's columns go behind those of the nodes that are left; each that is not has
        # gone with the rows of its element.
        behind = (-1.0) ** (self._layout.nx * len(self._chain.schedule.elements))
        signs, logs = zip(
            (behind, 0.0), *(level.determinant for level in self._chain.levels), strict=True
        )
        return float(sign * np.prod(signs)), float(log + sum(logs))

    @cached_property
    def _final_inverse(self) -> Array:
        inverse = _across_neutral if self._neutral else np.linalg.inv
        return np.asarray(inverse(self._final), dtype=float)

    def _solve_final(self, right: Array) -> Array:
        """Remaining nodes and constants; for one right-hand side an inverse is too much."""
        if self._unused:
            self._unused = False
            return np.asarray(np.linalg.solve(self._final, right), dtype=float)
        return self._final_inverse @ right

    def _final_of(self, A: Array, B: Array, C: Array, conditions: Array) -> Array:
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
        at = self._chain.schedule.nodes.searchsorted(lay.point_elements)
        points = (at[:, None] * nx + np.arange(nx)).ravel()
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
