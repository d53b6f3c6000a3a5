"""The ribbon as a surface: swept by its generatrices r + v (d2 + eta d3), |v| <= half_width.

With u1 = 0 and b = d2 + eta d3, b' = eta' d3: along a generatrix the normal is d1 everywhere, and
the surface is regular while half_width |eta'| < 1 (section 2 of the paper); u1 leaves the normal as
it is, with eta' + u1 (1 + eta^2) in the place of eta'. Where u2 changes sign
and u3 does not vanish, eta leaps from one sign to the other, which no ribbon of finite width can
follow: there |eta| is drawn at most LEAP_SLOPE |s - s*| / half_width, so that the generatrices fan
out from about a point of one edge, as they do on a real Moebius ribbon.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError

from .pieces import Array, Piece

ETA_BOUND = 1.0  # generatrices are drawn at most this oblique: the bound (4.1) of Sadowsky's ribbon
WIDTH_SHARE = 1 / 20  # half-width by default, of the length drawn
LEAST_SHARE = 1 / 200  # half-width by default at least, though generatrices cross
REGULAR_SLOPE = 0.8  # half_width |eta'| by default at most this
LEAP_SLOPE = 0.7  # half_width |eta'| where eta leaps
LEAST_LEAP = 1e-3
LEAP_SHARE = 1 / 5  # half-width by default at most, of the usual distance between leaps
CLOSE = 1e-4  # of the length: ends nearer than this meet
FINE = 1e-6  # of the length: rows closer than this do not count for eta'


@dataclass(frozen=True)
class Sheet:
    """The surface along one piece.

    Attributes
    ----------
    piece : Piece
        Its rows (k).
    eta : (k,) array
        u3/u2 as drawn: within ETA_BOUND, and 0 where it leaps.
    half_width : float
        Of the whole ribbon, where its width is 1 in units of its own.
    """

    piece: Piece
    eta: Array
    half_width: float

    def points(self, fraction: float) -> Array:
        """Points (k, 3) at a fraction of the half-width: -1 and 1 the edges, 0 the centre line."""
        b = self.piece.d2 + self.eta[:, None] * self.piece.d3
        across = fraction * self.half_width * self.piece.widths[:, None]
        return np.asarray(self.piece.r + across * b)


@dataclass(frozen=True)
class Surface:
    """A ribbon with its generatrices.

    Attributes
    ----------
    half_width : float
        The length of a generatrix along d2, on either side of the centre line, where the width of
        the ribbon is 1 in units of its own.
    sheets : tuple of Sheet
        In order of arclength.
    bounded : bool
        Whether |eta| exceeds ETA_BOUND somewhere.
    leaps : bool
        Whether eta leaps somewhere.
    crossing : bool
        Whether generatrices cross within the half-width.
    """

    half_width: float
    sheets: tuple[Sheet, ...]
    bounded: bool
    leaps: bool
    crossing: bool

    @property
    def widest(self) -> float:
        """The largest half-width."""
        return self.half_width * _widest(tuple(sheet.piece for sheet in self.sheets))

    def at(self, s: float) -> tuple[Sheet, int]:
        """Return the sheet and the row of it nearest to an arclength."""
        sheet = next((sheet for sheet in self.sheets if sheet.piece.s[-1] >= s), self.sheets[-1])
        return sheet, int(np.abs(sheet.piece.s - s).argmin())

    @property
    def tapers(self) -> bool:
        """Whether the width is not the same all along."""
        pieces = [sheet.piece.widths for sheet in self.sheets]
        return bool(max(w.max() for w in pieces) > min(w.min() for w in pieces))

    @property
    def closing(self) -> int:
        """1 for a ribbon that ends where it starts, -1 with its face turned over; else 0."""
        return _closing(tuple(sheet.piece for sheet in self.sheets))

    @property
    def closed(self) -> bool:
        """Whether the ribbon ends where it starts."""
        return self.closing != 0

    @property
    def one_sided(self) -> bool:
        """Whether the ribbon closes with its face turned over."""
        return self.closing < 0


def sweep(pieces: tuple[Piece, ...], half_width: float | None = None) -> Surface:
    """Sweep the generatrices of a ribbon.

    Parameters
    ----------
    pieces
        In order of arclength.
    half_width
        Where the width is 1. Default: a twentieth of the length where it is largest, or less (to a
        two-hundredth) so that no generatrices cross and those that fan out where eta leaps leave
        room between.

    Raises
    ------
    ModelError
        If half_width is not positive.
    """
    if half_width is not None and not half_width > 0:
        raise ModelError(f"half_width is expected to be positive, found {half_width}")
    regular = _regular_half_width(pieces)
    leaps = [_leap(a, b) for a, b in pairwise(pieces)]
    seam = _leap_at_seam(pieces)
    leaps = [seam, *leaps, seam]
    w = half_width
    if w is None:
        length = pieces[-1].s[-1] - pieces[0].s[0]
        where = [pieces[0].s[0], *(piece.s[-1] for piece in pieces)]
        apart = np.diff(np.array(where)[leaps])
        usual = float(np.median(apart)) if len(apart) else np.inf
        widest = _widest(pieces)
        w = min(WIDTH_SHARE * length / widest, LEAP_SHARE * usual / widest, REGULAR_SLOPE * regular)
        w = max(w, LEAST_SHARE * length / widest)  # eta may be steep where there is no strain
    sheets = tuple(
        Sheet(piece, _drawn_eta(piece, w, *ends), w)
        for piece, ends in zip(pieces, pairwise(leaps), strict=True)
    )
    bounded = any(bool((np.abs(p.eta) > ETA_BOUND + 1e-9).any()) for p in pieces)
    return Surface(w, sheets, bounded, any(leaps), w > regular)


def _widest(pieces: tuple[Piece, ...]) -> float:
    return max(float(piece.widths.max()) for piece in pieces)


def _regular_half_width(pieces: tuple[Piece, ...]) -> float:
    """Return the half-width up to which no generatrices cross, apart from leaps of eta."""
    length = pieces[-1].s[-1] - pieces[0].s[0]
    steepest = 0.0
    for piece in pieces:
        rows = np.diff(piece.s) > FINE * length
        eta = _bounded(piece.eta)
        slope = np.diff(eta)[rows] / np.diff(piece.s)[rows] + (piece.u1 * (1 + eta**2))[1:][rows]
        slope = np.abs(slope) * piece.widths[1:][rows]
        steepest = max(steepest, float(slope.max()))
    return 1 / max(steepest, 1e-300)


def _bounded(eta: Array) -> Array:
    return np.clip(eta, -ETA_BOUND, ETA_BOUND)


def _leap(a: Piece, b: Piece, sign: int = 1) -> bool:
    return bool(np.abs(sign * _bounded(b.eta)[0] - _bounded(a.eta)[-1]) > LEAST_LEAP)


def _leap_at_seam(pieces: tuple[Piece, ...]) -> bool:
    """Whether eta leaps where a closed ribbon returns; it changes sign as the face turns over."""
    sign = _closing(pieces)
    return sign != 0 and _leap(pieces[-1], pieces[0], sign)


def _closing(pieces: tuple[Piece, ...]) -> int:
    """Return 1 for a ribbon that returns to its start, -1 with its face turned over, else 0."""
    first, last = pieces[0], pieces[-1]
    gap = float(np.linalg.norm(first.r[0] - last.r[-1]))
    facing = float(first.d1[0] @ last.d1[-1])
    if gap > CLOSE * (last.s[-1] - first.s[0]) or abs(facing) < 0.999:
        return 0
    return 1 if facing > 0 else -1


def _drawn_eta(piece: Piece, w: float, leaps_before: bool, leaps_after: bool) -> Array:
    eta = _bounded(piece.eta)
    for leaps, s in ((leaps_before, piece.s[0]), (leaps_after, piece.s[-1])):
        if leaps:
            bound = LEAP_SLOPE * np.abs(piece.s - s) / (w * piece.widths)
            eta = np.clip(eta, -bound, bound)
    return eta
