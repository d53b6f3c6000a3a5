"""Generatrices as they are drawn: within a bound, smooth where eta leaps, and not crossing.

With b = d2 + eta d3 generatrices meet at the distance 1/|eta' + u1 (1 + eta^2)| along d2. Where u2
changes sign and u3 does not vanish, eta leaps from one sign to the other, which no ribbon of finite
width can follow: there |eta| is drawn at most LEAP_SLOPE |s - s*| / half_width, so that they fan
out from about a point of one edge, as they do on a real Moebius ribbon. However steep eta is beside
a leap, it is what is drawn that counts for the half-width.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ribbonopt.classes import dataclass

from .pieces import Array, Piece

ETA_BOUND = 1.0  # generatrices are drawn at most this oblique: the bound (4.1) of Sadowsky's ribbon
WIDTH_SHARE = 1 / 20  # half-width by default, of the length drawn
LEAST_SHARE = 1 / 200  # half-width by default at least, though generatrices cross
REGULAR_SLOPE = 0.8  # half_width |eta'| by default at most this
LEAP_SLOPE = 0.7  # half_width |eta'| where eta leaps
LEAST_LEAP = 1e-3
LEAP_SHARE = 1 / 5  # half-width by default at most, of the usual distance between leaps
ROUNDS = 20  # in which the half-width by default is found
ROUNDING, DIGITS = 1e-9, 7
FINE = 1e-6  # of the length: rows closer than this do not count for eta'


@dataclass(frozen=True, eq=False)
class Generatrices:
    """Those of all pieces of a ribbon, row after row.

    Attributes
    ----------
    s, eta, u1, widths : (k,) arrays
        Arclength, u3/u2 within ETA_BOUND, bending in the ribbon's own plane, relative width.
    near : (k,) array
        Distance along the piece from where eta leaps, infinite where it does not.
    steps : (k - 1,) array of bool
        Whether a row and the next are of one piece, and far enough apart for a slope.
    leaps : (P + 1,) array
        Arclengths of the ends of pieces at which eta leaps.
    """

    s: Array
    eta: Array
    u1: Array
    widths: Array
    near: Array
    steps: NDArray[np.bool_]
    leaps: Array

    @classmethod
    def of(cls, pieces: Sequence[Piece], closing: int) -> Generatrices:
        """Return those of pieces in order, of a ribbon that closes as `Surface.closing` says."""
        eta = [np.clip(piece.eta, -ETA_BOUND, ETA_BOUND) for piece in pieces]
        # Where the face turns over eta changes its sign.
        seam = closing != 0 and _leap(eta[-1][-1], closing * eta[0][0])
        leaps = [seam, *(_leap(a[-1], b[0]) for a, b in pairwise(eta)), seam]
        s = np.concatenate([piece.s for piece in pieces])
        near = [
            np.minimum(
                piece.s - piece.s[0] if before else np.inf,
                piece.s[-1] - piece.s if after else np.inf,
            )
            for piece, (before, after) in zip(pieces, pairwise(leaps), strict=True)
        ]
        sizes = [len(piece.s) for piece in pieces]
        where = np.array([s[0], *(piece.s[-1] for piece in pieces)])
        steps = np.diff(s) > FINE * (s[-1] - s[0])
        steps[np.cumsum(sizes)[:-1] - 1] = False
        return cls(
            s,
            np.concatenate(eta),
            np.concatenate([piece.u1 for piece in pieces]),
            np.concatenate([piece.widths for piece in pieces]),
            np.concatenate([np.broadcast_to(d, n) for d, n in zip(near, sizes, strict=True)]),
            steps,
            where[leaps],
        )

    def drawn(self, half_width: float) -> Array:
        """Return eta (k,) as drawn to a half-width."""
        bound = LEAP_SLOPE * self.near / (half_width * self.widths)
        return np.clip(self.eta, -bound, bound)

    def overlap(self, half_width: float) -> float:
        """Return the half-width over that at which generatrices cross: 1 where they touch."""
        eta = self.drawn(half_width)
        rows = np.flatnonzero(self.steps)
        slope = (eta[rows + 1] - eta[rows]) / (self.s[rows + 1] - self.s[rows])
        turning = self.u1 * (1 + eta**2)
        slope += (turning[rows] + turning[rows + 1]) / 2
        widths = np.maximum(self.widths[rows], self.widths[rows + 1])
        return half_width * float(np.abs(slope * widths).max(initial=0.0))

    def usual_half_width(self) -> float:
        """Return the half-width by default: as wide as `sweep` says, so that none cross.

        Rounded, so that it is the same of the same ribbon elsewhere or seen in a mirror.
        """
        length, widest = self.s[-1] - self.s[0], float(self.widths.max())
        apart = np.diff(self.leaps)
        usual = float(np.median(apart)) if len(apart) else np.inf
        found = min(WIDTH_SHARE * length, LEAP_SHARE * usual) / widest
        least = LEAST_SHARE * length / widest  # eta may be steep where there is no strain
        for _ in range(ROUNDS):
            # Narrower it shows more of what is steep beside leaps, never less: so none is too far.
            overlap = self.overlap(found)
            if found <= least or not overlap > REGULAR_SLOPE * (1 + ROUNDING):
                break
            found *= REGULAR_SLOPE / overlap
        return float(f"{max(found, least):.{DIGITS}g}")


def _leap(before: float, after: float) -> bool:
    return bool(abs(after - before) > LEAST_LEAP)
