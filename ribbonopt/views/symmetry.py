"""The rows of a closed band that follow from those of the piece that was solved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.checks.flip import Flip, at_ends, flip_at
from ribbonopt.checks.topology import ClosedBand
from ribbonopt.solution.solution import Solution

from .pieces import Piece


def other_half(solution: Solution) -> Flip | None:
    """Return the flip that gives the other half of a strip, if its end is on an axis of one."""
    end, (start, last) = solution.scene.boundary.end, solution.scene.interval
    if solution.posed.loaded or solution.scene.boundary.pieces != 2:
        return None
    if end.support != "flip" or end.axis not in ("d1", "d2"):
        return None
    return flip_at(at_ends(solution), np.array([start, last]), 1, end.axis)


def continued(band: ClosedBand, solved: tuple[Piece, ...]) -> tuple[Piece, ...]:
    """Return the pieces that follow those that were solved, in order of arclength."""
    if band.flip is None:
        return ()
    pair = (*solved, *(image(band.flip, piece) for piece in reversed(solved)))
    pieces = list(pair)
    for _ in range(band.copies - 1):
        pair = tuple(turned(band, piece) for piece in pair)
        pieces += pair
    return tuple(pieces[len(solved) :])


def image(flip: Flip, piece: Piece) -> Piece:
    """Return the piece that follows by a flip, in order of increasing arclength."""
    sign = -1.0 if flip.along_d2 else 1.0
    return Piece(
        s=(2 * flip.end - piece.s)[::-1],
        u1=-sign * piece.u1[::-1],
        u2=sign * piece.u2[::-1],
        u3=piece.u3[::-1],
        eta=sign * piece.eta[::-1],
        r=flip.carry(piece.r)[::-1],
        d1=sign * flip.rotate(piece.d1)[::-1],
        d2=-sign * flip.rotate(piece.d2)[::-1],
        d3=-flip.rotate(piece.d3)[::-1],
        mirrored=True,
        width=piece.widths[::-1],
        # What acts on a section from ahead acts on its image from behind.
        n=-flip.rotate(piece.n)[::-1],
        m=-flip.rotate(piece.m)[::-1],
        energy=piece.energy[::-1],
    )


def turned(band: ClosedBand, piece: Piece) -> Piece:
    """Return the next image of a piece under the turn of a band, two flips further on.

    The first flip is about d1. If the last is about d2 the two reverse d1 and d2, and u1
    and u2 with them.
    """
    assert band.flip is not None
    start, end = band.solution.scene.interval
    sign = -1.0 if band.flip.along_d2 else 1.0
    return replace(
        piece,
        s=piece.s + 2 * (end - start),
        u1=sign * piece.u1,
        u2=sign * piece.u2,
        eta=sign * piece.eta,
        r=piece.r @ band.turn.T + band.shift,
        d1=sign * piece.d1 @ band.turn.T,
        d2=sign * piece.d2 @ band.turn.T,
        d3=piece.d3 @ band.turn.T,
        n=piece.n @ band.turn.T,
        m=piece.m @ band.turn.T,
        mirrored=True,
    )
