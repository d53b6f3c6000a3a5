"""A ribbon as rows of numbers, whole bands in one: what is shown, exported and read by others.

All pictures, pages and files of a shape hold these rows; `Subject` has them piece by piece.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError
from ribbonopt.scene.units import Units
from ribbonopt.solution.solution import Solution

from .pieces import ROWS, Array
from .subject import Subject, subject_of
from .surface import Surface, sweep

LEAST_OF_MOST = 0.5  # of the median: a half-width for many is not less


@dataclass(frozen=True, eq=False)
class Shape:
    """A ribbon as rows in order of arclength, ready to be drawn, shown or exported.

    Lab frame; everything in the units of the scene. Rows where eta leaps, or pieces meet, repeat
    the arclength to 1e-9 of the length, one row for each side.

    Attributes
    ----------
    name : str
        The scene's.
    units : Units
        Of all numbers.
    s : (k,) array
        Arclength.
    r, d1, d2, d3 : (k, 3) arrays
        Centre line and directors.
    b : (k, 3) array
        Generatrix as drawn, d2 + eta d3 with eta bounded and smooth where it leaps; d2 of a rod.
    half_widths : (k,) array
        Half-width as drawn, along d2.
    u1, u2, u3, eta : (k,) arrays
        Strains as they are; eta = u3/u2, and 0 where there is none.
    n, m : (k, 3) arrays
        Force and moment that the part ahead exerts, those of images too.
    energy : (k,) array
        Strain energy per length; nan where the law has none.
    mirrored : (k,) array of bool
        Rows that follow by symmetry from those that were solved.
    starts : tuple of int
        First row of each piece; eta, n or strains may leap between pieces.
    closing : int
        0 for an open ribbon, 1 for a closed one, -1 where it closes with its face turned over.
    half_width : float
        As drawn where the relative width is 1.
    own : bool
        Whether that is half the width which the scene says.
    rod : bool
        Whether the law leaves u1 free and is no ribbon's, so that there are no generatrices.
    """

    name: str
    units: Units
    s: Array
    r: Array
    d1: Array
    d2: Array
    d3: Array
    b: Array
    half_widths: Array
    u1: Array
    u2: Array
    u3: Array
    eta: Array
    n: Array
    m: Array
    energy: Array
    mirrored: np.ndarray[tuple[int], np.dtype[np.bool_]]
    starts: tuple[int, ...]
    closing: int
    half_width: float
    own: bool
    rod: bool

    def points(self, fraction: float) -> Array:
        """Points (k, 3) at a fraction of the half-width: -1 and 1 the edges, 0 the centre line."""
        return np.asarray(self.r + fraction * self.half_widths[:, None] * self.b)


def shape_of(
    solution: Solution, half_width: float | None = None, complete: bool = True, rows: int = ROWS
) -> Shape:
    """Return the shape of a solution.

    Parameters
    ----------
    solution
        Converged or not; what there is is sampled.
    half_width
        Where the relative width is 1. Default: the ribbon's own where the scene says it, else one
        with which generatrices keep apart; see `sweep`.
    complete
        With the rest of a band, or of a strip, of which the solution is a piece by symmetry.
    rows
        About how many of what was solved; fewer of a piece among many.

    Raises
    ------
    ModelError
        If half_width is not a positive number.
    """
    subject = subject_of(solution, complete, rows)
    return shape_from(
        subject, sweep(subject.pieces, subject.drawn if half_width is None else half_width)
    )


def shape_from(subject: Subject, surface: Surface) -> Shape:
    """Return the shape of a subject with its surface."""
    pieces = [sheet.piece for sheet in surface.sheets]
    sizes = [len(piece.s) for piece in pieces]

    def rows(name: str) -> Array:
        return np.concatenate([getattr(piece, name) for piece in pieces])

    eta = np.concatenate([sheet.eta for sheet in surface.sheets])
    return Shape(
        name=subject.name,
        units=subject.units,
        b=rows("d2") + eta[:, None] * rows("d3"),
        half_widths=surface.half_width * rows("widths"),
        mirrored=np.repeat([piece.mirrored for piece in pieces], sizes),
        starts=tuple(np.cumsum([0, *sizes[:-1]]).tolist()),
        closing=surface.closing,
        half_width=surface.half_width,
        own=surface.half_width == subject.half_width,
        rod=subject.rod,
        s=rows("s"),
        r=rows("r"),
        d1=rows("d1"),
        d2=rows("d2"),
        d3=rows("d3"),
        u1=rows("u1"),
        u2=rows("u2"),
        u3=rows("u3"),
        eta=rows("eta"),
        n=rows("n"),
        m=rows("m"),
        energy=rows("energy"),
    )


def common_half_width(ribbons: Sequence[Solution | Subject]) -> float:
    """Return one half-width to draw all of some ribbons to, those of a branch or a batch.

    The least of what each would have, so that generatrices of none cross; but not less than half
    of what most have, so that one odd ribbon does not make hairlines of all. Ribbons whose own
    widths differ are better drawn each to its own: `Subject.half_width`.

    Raises
    ------
    ModelError
        If there is no ribbon.
    """
    if not ribbons:
        raise ModelError("found no ribbon; expected one at least, to find a half-width for")
    subjects = [r if isinstance(r, Subject) else subject_of(r, complete=True) for r in ribbons]
    found = [s.drawn or sweep(s.pieces).half_width for s in subjects]
    return max(min(found), LEAST_OF_MOST * float(np.median(found)))
