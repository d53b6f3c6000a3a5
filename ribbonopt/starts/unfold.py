"""A band with dihedral symmetry unfolded from its fundamental piece: a guess for more of the loop.

Piece j of the band is the first one turned about e_y by the angle 2 pi i / k (j = 2 i), or, for
j = 2 i + 1, the flip of its predecessor about the axis between them: `mechanics.ends.loops`.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.checks.arcs import Arcs, arcs_of, leaps, sign_changes
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.rotations import turns_about
from ribbonopt.mechanics.section import RodFields
from ribbonopt.problem import Posed
from ribbonopt.solution.solution import Solution


@dataclass(frozen=True, eq=False)
class Unfolded:
    """Part of a band, placed at a position and a frame of its start.

    Attributes
    ----------
    piece : Solution
        The fundamental piece.
    half_twists : int
        Of the whole band.
    count : int
        Pieces in this part: 2 |half_twists| for all of it.
    position, frame : (3,), (3, 3) arrays
        Where it starts, lab frame.
    """

    piece: Solution
    half_twists: int
    count: int
    position: Array
    frame: Array

    def fields(self, fraction: Array) -> RodFields:
        """Fields at fractions (k,) of the length, increasing from 0 to 1."""
        where = fraction * self.count
        index = np.minimum(where.astype(int), self.count - 1)
        local = where - index
        odd = index % 2 == 1
        local = np.where(odd, 1 - local, local)
        first = self.piece.fields(local)
        start = self.piece.fields(np.zeros(1))
        turn = np.pi / abs(self.half_twists)
        flip = _flip(np.array([-np.cos(turn), 0.0, np.sin(turn)]))
        r, frames, n, m = first.r, first.frames, first.n, first.m
        # Reversed: d3 turns round and d2, along the axis, stays; n and m act from the other side.
        flipped = (r @ flip, np.einsum("ij,kjl->kil", flip, frames) * [-1.0, 1.0, -1.0])
        r = np.where(odd[:, None], flipped[0], r)
        frames = np.where(odd[:, None, None], flipped[1], frames)
        n = np.where(odd[:, None], -n @ flip, n)
        m = np.where(odd[:, None], -m @ flip, m)
        # Each two pieces: a turn about e_y, and half a turn of the band about its tangent.
        pairs = index // 2
        turns = turns_about(2 * turn * pairs[:, None] * np.eye(3)[1])
        half = np.where(pairs % 2 == 1, -1.0, 1.0)[:, None, None]
        frames = (turns @ frames) * np.concatenate([half, half, np.ones_like(half)], axis=2)
        r, n, m = (np.einsum("kij,kj->ki", turns, v) for v in (r, n, m))
        placed = self.frame @ start.frames[0].T
        return RodFields(
            self.position + (r - start.r[0]) @ placed.T,
            placed @ frames,
            n @ placed.T,
            m @ placed.T,
        )

    @property
    def arcs(self) -> Arcs | None:
        """Arcs of this part, from those of the piece; None where the law leaps nowhere."""
        piece = self.piece
        if piece.sheets:
            own = arcs_of(piece)
        elif not leaps(piece):
            return None
        else:
            own = sign_changes(piece)
        kinds: list[int] = []
        switches: list[float] = []
        for j in range(self.count):
            # A flip about d2 reverses m2, and so does half a turn of the band about its tangent.
            sign = (-1) ** ((j + 1) // 2)
            step = -1 if j % 2 else 1
            here = np.concatenate([own.switches, [1.0]])
            ends = here if step > 0 else np.append(1 - own.switches[::-1], 1.0)
            for kind, end in zip(own.kinds[::step], ends, strict=True):
                if kinds and kinds[-1] == sign * kind:
                    switches.pop()
                else:
                    kinds.append(sign * kind)
                switches.append((j + float(end)) / self.count)
        return Arcs(tuple(kinds), np.array(switches[:-1]))


def unfolded(piece: Solution, posed: Posed) -> Unfolded:
    """Return what a scene asks for of a band, unfolded from its fundamental piece."""
    loop = posed.scene.boundary.loop
    assert loop is not None
    return Unfolded(piece, loop.half_twists, loop.fundamental.pieces // loop.pieces, *posed.start)


def _flip(axis: Array) -> Array:
    """Rotation (3, 3) by pi about an axis through the origin."""
    return np.asarray(2 * np.outer(axis, axis) - np.eye(3))
