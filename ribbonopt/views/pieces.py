"""A solution as pieces to draw: rows along s, split where u2 changes sign while u3 does not vanish.

There eta = u3/u2 leaps from one sign to the other, whether u2 jumps (Sadowsky's law at m2 = 0) or
passes through 0 (the other laws). They are split as well where something acts at a single place.
Rows approach the ends of each piece from inside, so that a jump at an end shows its own side only,
and they crowd there, where regularised laws change quickly. With natural strains u2 may leap from
and to any value: pieces are the phases, where there are any.
"""

from __future__ import annotations

from dataclasses import field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ribbonopt.classes import dataclass
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.mechanics.widths import widths
from ribbonopt.solution.acting import at_places
from ribbonopt.solution.solution import Solution

Array = NDArray[np.float64]

ROWS = 241  # evenly spaced rows over the whole interval
INSET = 1e-9  # of the length: distance of the outermost rows from the ends of a piece
SHORTEST = 1e-6  # of the length: shorter pieces are left out
NO_TWIST = 1e-9  # of the largest strain: below it u3 counts as zero
STRAIGHT = 1e-3  # strain times length: of smaller ones than this the largest counts as such
NO_BEND = 1e-12  # of the largest strain: below it u2 counts as zero


@dataclass(frozen=True)
class Piece:
    """Rows along a stretch of ribbon on which u2 keeps its sign (or u3 vanishes).

    Attributes
    ----------
    s, u1, u2, u3 : (k,) arrays
        Arclength and strains.
    eta : (k,) array
        u3/u2, and 0 where the ribbon is straight, planar or purely twisted, and of a rod with u1.
    r, d1, d2, d3 : (k, 3) arrays
        Centre line and directors, lab frame.
    mirrored : bool
        Whether these rows follow by symmetry from those that were solved.
    width : (k,) array, or 1
        Of the ribbon, in units of its own.
    n, m : (k, 3) arrays
        Force and moment, lab frame, in the units of the scene.
    energy : (k,) array
        Strain energy per length; nan where the law has none.
    """

    s: Array
    u1: Array
    u2: Array
    u3: Array
    eta: Array
    r: Array
    d1: Array
    d2: Array
    d3: Array
    mirrored: bool = False
    width: Array | float = 1.0
    n: Array = field(default_factory=lambda: np.empty((0, 3)))
    m: Array = field(default_factory=lambda: np.empty((0, 3)))
    energy: Array = field(default_factory=lambda: np.empty(0))

    @property
    def widths(self) -> Array:
        """The width in every row, (k,)."""
        return np.broadcast_to(self.width, self.s.shape)


def in_plane(pieces: tuple[Piece, ...]) -> float:
    """Return the largest bending of a ribbon in its own plane, u1, over its largest strain."""
    largest = [max(float(np.abs(getattr(p, u)).max()) for p in pieces) for u in ("u1", "u2", "u3")]
    return largest[0] / max(*largest, np.finfo(float).tiny)


def is_rod(solution: Solution) -> bool:
    """Whether a law that is no ribbon's leaves u1 free: it is drawn as a strip along d2.

    Generatrices of a ribbon stay what they are where it bends in its own plane too.
    """
    law = capabilities(solution.scene)
    return 0 in law.components and not law.developable


def sample_pieces(solution: Solution, rows: int = ROWS) -> tuple[Piece, ...]:
    """Sample a solution along its interval, about `rows` rows in all."""
    start, end = solution.scene.interval
    length = end - start
    s = _grid(start, end, rows, INSET * length)
    values = solution.outputs(s)
    # A straight ribbon has strains of rounding, and no generatrices but those across.
    scale = max(_scale(values), STRAIGHT / length)
    crossings = [] if is_rod(solution) else _crossings(solution, s, values, scale)
    cuts = sorted({*crossings, *_places(solution)})
    if not cuts:
        return (_piece(solution, s, values, scale),)
    pieces = []
    for a, b in pairwise([start, *cuts, end]):
        if b - a > SHORTEST * length:
            s = _grid(a, b, max(9, round(rows * (b - a) / length)), INSET * length)
            pieces.append(_piece(solution, s, solution.outputs(s), scale))
    return tuple(pieces)


def _grid(a: float, b: float, rows: int, inset: float) -> Array:
    """Evenly spaced rows in the open interval (a, b), and a geometric approach to both its ends."""
    even = np.linspace(a, b, rows)
    approach = np.geomspace(inset, (even[1] - a) / 2, 14)
    return np.concatenate([a + approach, even[1:-1], b - approach[::-1]])


def _piece(solution: Solution, s: Array, values: dict[str, Array], scale: float) -> Piece:
    u1, u2, u3 = (values[name] for name in ("u1", "u2", "u3"))
    r, d1, d2, d3 = (values[name] for name in ("r", "d1", "d2", "d3"))
    width = widths(solution.scene, s)
    eta = np.zeros(len(s)) if is_rod(solution) else _eta(u2, u3, scale)
    n, m, energy = values["n"], values["m"], values["energy"]
    if not capabilities(solution.scene).variational:
        energy = np.full(len(s), np.nan)  # found is m . u / 2, which is no energy of such a law
    return Piece(s, u1, u2, u3, eta, r, d1, d2, d3, width=width, n=n, m=m, energy=energy)


def _scale(values: dict[str, Array]) -> float:
    return float(max(np.abs(values["u2"]).max(), np.abs(values["u3"]).max()))


def _eta(u2: Array, u3: Array, scale: float) -> Array:
    none = (np.abs(u3) <= NO_TWIST * scale) | (np.abs(u2) <= NO_BEND * scale)
    return np.where(none, 0.0, u3 / np.where(none, 1.0, u2))


def _crossings(solution: Solution, s: Array, values: dict[str, Array], scale: float) -> list[float]:
    """Arclengths at which u2 changes sign and u3 does not vanish, or leaps as phases say."""
    if solution.scene.natural is not None and solution.sheets:
        return [float(s) for s in solution.switch_points]
    up = values["u2"] > NO_BEND * scale
    twisted = np.abs(values["u3"]) > NO_TWIST * scale
    steady = np.abs(values["u2"]) > NO_BEND * scale
    rows = np.flatnonzero(steady & twisted)
    return [_bisect(solution, s[i], s[j], up[i]) for i, j in pairwise(rows) if up[i] != up[j]]


def _places(solution: Solution) -> list[float]:
    """Arclengths at which a load or a support acts: n jumps there, strains may."""
    if not solution.posed.stations:
        return []
    return list(dict.fromkeys(place.at for place in at_places(solution)))


def _bisect(solution: Solution, a: float, b: float, up: bool) -> float:
    """Arclength in (a, b) where u2 leaves the sign it has at a, to INSET."""
    length = solution.scene.interval[1] - solution.scene.interval[0]
    while b - a > INSET * length / 4:
        s = np.linspace(a, b, 33)
        left = np.flatnonzero((solution.outputs(s[1:-1])["u2"] > 0) != up)
        i = int(left[0]) + 1 if len(left) else 32
        a, b = s[i - 1], s[i]
    return float(a + b) / 2
