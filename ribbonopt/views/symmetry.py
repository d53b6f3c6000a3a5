"""The rows of a second half that follow from those of the first by a flip."""

from __future__ import annotations

from ribbonopt.symmetry import Flip

from .pieces import Piece


def image(flip: Flip, piece: Piece) -> Piece:
    """Return the piece that follows by symmetry, in order of increasing arclength."""
    sign = -1.0 if flip.along_d2 else 1.0
    return Piece(
        s=(2 * flip.end - piece.s)[::-1],
        u2=sign * piece.u2[::-1],
        u3=piece.u3[::-1],
        eta=sign * piece.eta[::-1],
        r=flip.carry(piece.r)[::-1],
        d1=sign * flip.rotate(piece.d1)[::-1],
        d2=-sign * flip.rotate(piece.d2)[::-1],
        d3=-flip.rotate(piece.d3)[::-1],
        mirrored=True,
    )
