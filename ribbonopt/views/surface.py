"""The ribbon as a surface: swept by its generatrices r + v (d2 + eta d3), |v| <= half_width.

With u1 = 0 and b = d2 + eta d3, b' = eta' d3: along a generatrix the normal is d1 everywhere, and
the surface is regular while half_width |eta'| < 1 (section 2 of the paper); u1 leaves the normal as
it is, with eta' + u1 (1 + eta^2) in the place of eta'. How eta is drawn: `generatrices`.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError

from .generatrices import ETA_BOUND, Generatrices
from .pieces import Array, Piece

CLOSE = 1e-4  # of the length: ends nearer than this meet


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
        room between. How steep eta is beside a leap does not count: it is drawn smooth there.

    Raises
    ------
    ModelError
        If half_width is not a positive number.
    """
    if half_width is not None and not 0 < half_width < np.inf:
        raise ModelError(f"half_width is expected to be positive, found {half_width}")
    lines = Generatrices.of(pieces, _closing(pieces))
    w = lines.usual_half_width() if half_width is None else half_width
    ends = np.cumsum([len(piece.s) for piece in pieces])[:-1]
    drawn = np.split(lines.drawn(w), ends)
    sheets = tuple(Sheet(piece, eta, w) for piece, eta in zip(pieces, drawn, strict=True))
    bounded = any(bool((np.abs(p.eta) > ETA_BOUND + 1e-9).any()) for p in pieces)
    return Surface(w, sheets, bounded, len(lines.leaps) > 0, lines.overlap(w) > 1)


def _widest(pieces: tuple[Piece, ...]) -> float:
    return max(float(piece.widths.max()) for piece in pieces)


def _closing(pieces: tuple[Piece, ...]) -> int:
    """Return 1 for a ribbon that returns to its start, -1 with its face turned over, else 0."""
    first, last = pieces[0], pieces[-1]
    gap = float(np.linalg.norm(first.r[0] - last.r[-1]))
    facing = float(first.d1[0] @ last.d1[-1])
    if gap > CLOSE * (last.s[-1] - first.s[0]) or abs(facing) < 0.999:
        return 0
    return 1 if facing > 0 else -1
