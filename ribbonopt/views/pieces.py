"""A solution as pieces to draw: rows along s, split where u2 changes sign while u3 does not vanish.

There eta = u3/u2 leaps from one sign to the other, whether u2 jumps (Sadowsky's law at m2 = 0) or
passes through 0 (the other laws). They are split as well where something acts at a single place.
Rows are even along the whole; they approach the ends of each piece from inside, so that a jump at
an end shows its own side only, and they crowd there, where regularised laws change quickly. With
natural strains u2 may leap from and to any value: pieces are the phases, where there are any.
"""

from __future__ import annotations

from dataclasses import field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ribbonopt.classes import dataclass
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.mechanics.laws.law import ConstitutiveLaw
from ribbonopt.mechanics.outputs import OWN
from ribbonopt.mechanics.widths import widths
from ribbonopt.solution.acting import at_places
from ribbonopt.solution.many import many_outputs
from ribbonopt.solution.solution import Solution

from .crossings import crossings

Array = NDArray[np.float64]

ROWS = 241  # evenly spaced rows over the whole interval
INSET = 1e-9  # of the length: distance of the outermost rows from the ends of a piece
APPROACH = 14  # rows towards an end
OWN_ROWS = 8  # distances of even rows: shorter pieces have that many of their own
APART = 0.75  # of that distance: even rows nearer to a cut are left out
SHORTEST = 1e-6  # of the length: shorter pieces are left out
NO_TWIST = 1e-9  # of the largest strain: below it u3 counts as zero
STRAIGHT = 1e-3  # strain times length: of smaller ones than this the largest counts as such
NO_BEND = 1e-12  # of the largest strain: below it u2 counts as zero
NAMES = ("r", "d1", "d2", "d3", "n", "m", "u1", "u2", "u3", "energy")
OWN_ETA = OWN + "eta"  # of laws that have u3/u2 among their own states


@dataclass(frozen=True)
class Piece:
    """Rows along a stretch of ribbon on which u2 keeps its sign (or u3 vanishes).

    Attributes
    ----------
    s, u1, u2, u3 : (k,) arrays
        Arclength and strains.
    eta : (k,) array
        u3/u2, and 0 where the ribbon is straight, planar or purely twisted, and of a rod with u1.
        Where both vanish, what the law has beside them: that of Wunderlich's goes through.
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
        found = self.width
        return found if isinstance(found, np.ndarray) else np.full(self.s.shape, found)


def in_plane(pieces: tuple[Piece, ...]) -> float:
    """Return the largest bending of a ribbon in its own plane, u1, over its largest strain."""
    largest = [max(float(np.abs(getattr(p, u)).max()) for p in pieces) for u in ("u1", "u2", "u3")]
    return largest[0] / max(*largest, np.finfo(float).tiny)


def is_rods(law: ConstitutiveLaw) -> bool:
    """Whether a law that is no ribbon's leaves u1 free: it is drawn as a strip along d2.

    Generatrices of a ribbon stay what they are where it bends in its own plane too.
    """
    return 0 in law.components and not law.developable


def sample_pieces(
    solution: Solution, law: ConstitutiveLaw | None = None, rows: int = ROWS
) -> tuple[Piece, ...]:
    """Sample a solution along its interval, about `rows` rows in all.

    `law` is that of its scene, where it is known.
    """
    start, end = map(float, solution.scene.interval)
    length, law = end - start, law or capabilities(solution.scene)
    s = _grid(start, end, rows, INSET * length)
    values = _values(solution, s)
    # A straight ribbon has strains of rounding, and no generatrices but those across.
    strained = float(max(np.abs(values["u2"]).max(), np.abs(values["u3"]).max()))
    scale = max(strained, STRAIGHT / length)
    crossed = () if is_rods(law) else _crossings(solution, s, values, scale)
    cuts = sorted({start, *crossed, *_places(solution), end})
    if len(cuts) > 2:
        keep, more = _between(cuts, s, rows)
        added = _values(solution, more)
        s = np.concatenate([s[keep], more])
        order = np.argsort(s)
        s = s[order]
        values = {k: np.concatenate([v[keep], added[k]])[order] for k, v in values.items()}
    eta = np.zeros(len(s)) if is_rods(law) else _eta(values, scale, strained > STRAIGHT / length)
    if not law.variational:
        values["energy"] = np.full(len(s), np.nan)  # m . u / 2 was found, which is no energy of it
    columns = {"s": s, "eta": eta, "width": widths(solution.scene, s), **values}
    ends = np.searchsorted(s, cuts).tolist()
    return tuple(_piece(columns, slice(a, b)) for a, b in pairwise(ends) if b > a)


def _piece(columns: dict[str, Array], rows: slice) -> Piece:
    part = {name: column[rows] for name, column in columns.items()}
    return Piece(
        s=part["s"],
        u1=part["u1"],
        u2=part["u2"],
        u3=part["u3"],
        eta=part["eta"],
        r=part["r"],
        d1=part["d1"],
        d2=part["d2"],
        d3=part["d3"],
        width=part["width"],
        n=part["n"],
        m=part["m"],
        energy=part["energy"],
    )


def _values(solution: Solution, s: Array) -> dict[str, Array]:
    found = many_outputs(solution, s)
    return {name: found[name] for name in (*NAMES, OWN_ETA) if name in found}


def _grid(a: float, b: float, rows: int, inset: float) -> Array:
    """Evenly spaced rows in the open interval (a, b), and a geometric approach to both its ends."""
    even = np.linspace(a, b, rows)
    approach = _approach(inset, even[1] - a)
    return np.concatenate([a + approach, even[1:-1], b - approach[::-1]])


def _approach(inset: float, step: float) -> Array:
    return np.asarray(inset * (step / 2 / inset) ** np.linspace(0, 1, APPROACH))


def _between(cuts: list[float], s: Array, rows: int) -> tuple[NDArray[np.bool_], Array]:
    """Return which rows s (k,) of the whole serve pieces between cuts, and what they need beside.

    Pieces too short for them have rows of their own.
    """
    start, end = cuts[0], cuts[-1]
    length, step = end - start, (end - start) / (rows - 1)
    approach = _approach(INSET * length, step)
    keep, more = np.zeros(len(s), dtype=bool), [np.empty(0)]
    for a, b in pairwise(cuts):
        if b - a > OWN_ROWS * step:
            low = a if a == start else a + APART * step
            high = b if b == end else b - APART * step
            keep |= (s > low) & (s < high)
            more += [] if a == start else [a + approach]
            more += [] if b == end else [b - approach]
        elif b - a > SHORTEST * length:
            more.append(_grid(a, b, OWN_ROWS + 1, INSET * length))
    return keep, np.concatenate(more)


def _eta(values: dict[str, Array], scale: float, bent: bool) -> Array:
    u2, u3 = values["u2"], values["u3"]
    none = (np.abs(u3) <= NO_TWIST * scale) | (np.abs(u2) <= NO_BEND * scale)
    beside = values[OWN_ETA] if bent and OWN_ETA in values else 0.0
    return np.where(none, beside, u3 / np.where(none, 1.0, u2))


def _crossings(
    solution: Solution, s: Array, values: dict[str, Array], scale: float
) -> tuple[float, ...]:
    """Arclengths at which u2 changes sign and u3 does not vanish, or leaps as phases say."""
    if solution.scene.natural is not None and solution.sheets:
        return tuple(map(float, solution.switch_points))
    up = values["u2"] > NO_BEND * scale
    twisted = np.abs(values["u3"]) > NO_TWIST * scale
    steady = np.abs(values["u2"]) > NO_BEND * scale
    rows = np.flatnonzero(steady & twisted)
    at = np.flatnonzero(up[rows[:-1]] != up[rows[1:]])
    if not len(at):
        return ()

    def told(places: Array) -> tuple[Array, Array]:
        found = many_outputs(solution, places)
        return found["u2"], found["switching"]

    start, end = solution.scene.interval
    before, after = rows[at], rows[at + 1]
    found = crossings(told, (s[before], s[after]), up[before], INSET * (end - start) / 2)
    return tuple(found.tolist())


def _places(solution: Solution) -> list[float]:
    """Arclengths at which a load or a support acts: n jumps there, strains may."""
    if not solution.posed.stations:
        return []
    return list(dict.fromkeys(place.at for place in at_places(solution)))
