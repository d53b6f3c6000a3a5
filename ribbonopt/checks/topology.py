"""Half twists of closed bands: k = 2 (Tw + Wr), a whole number that no smooth motion changes.

Tw is the twist of the directors in turns, Wr the writhe of the centre line (Calugareanu, White,
Fuller); k is odd for one-sided bands and negative for left-handed ones. A solution is a whole band,
or a piece of one that symmetries carry on: a half (one flip), or the fundamental piece of a band
with dihedral symmetry (a flip at each end; the two together are a turn by 2 pi / k).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.scene import Loop
from ribbonopt.solution.solution import Solution

from .flip import TOLERANCE, Flip, at_ends, find_flip, flip_at
from .polygons import half_twists, writhe, writhe_and_crossings

POINTS = (100, 200, 400, 800)  # of the closed polygon, until its writhe is stable
STABLE = 0.01  # change of the writhe against half the points
CLEAR = 0.01  # as far as that there is no doubt, though the line be not exact
WHOLE = 0.05  # farthest from a whole number that counts as one


@dataclass(frozen=True, eq=False)
class ClosedBand:
    """A closed band, and the piece of it that was solved.

    The piece, and its image under `flip` where there is one, are followed by their images under
    x -> turn x + shift, `copies` in all.

    Attributes
    ----------
    gap : (3,) array
        From the start to where the loop returns, relative to its length.
    tilt : float
        Largest difference of a director there from what closes.
    """

    solution: Solution
    gap: Array
    tilt: float
    flip: Flip | None = None
    copies: int = 1
    turn: Array = field(default_factory=lambda: np.eye(3))
    shift: Array = field(default_factory=lambda: np.zeros(3))

    @property
    def pieces(self) -> int:
        """How many times the solved piece makes the band."""
        return self.copies * (1 if self.flip is None else 2)

    @property
    def twist(self) -> float:
        """Twist of the whole band, in turns."""
        return self.pieces * self.solution.twist

    def line(self, count: int, *, quick: bool = False) -> Array:
        """At least `count` points (k, 3) of the centre line, evenly spaced, the first not again.

        `quick` for those on the polynomials of the mesh, which is less exact between its nodes.
        """
        # An even number, so that every other point is a polygon of the same band.
        rows = 2 * -(-count // (2 * self.pieces))
        fraction, trajectory = np.linspace(0.0, 1.0, rows + 1), self.solution.trajectory
        r = trajectory.line(fraction, quick=quick) * self.solution.units.length
        points = r[:-1]
        if self.flip is not None:
            points = np.concatenate([points, self.flip.carry(r[:0:-1])])
        images = [points]
        for _ in range(self.copies - 1):
            images.append(images[-1] @ self.turn.T + self.shift)
        return np.concatenate(images)

    def half_twists(self, asked: int | None = None) -> tuple[int, float]:
        """Nearest whole number of half twists, and how far from it their count is.

        Where that is in doubt, or not what was `asked`, the line is followed exactly.
        """
        found, off = self._half_twists(quick=True)
        clear = off <= CLEAR and asked in (None, found)
        return (found, off) if clear else self._half_twists(quick=False)

    def _half_twists(self, *, quick: bool) -> tuple[int, float]:
        """Return the same of a line that is exact, or `quick`."""
        for count in POINTS:
            r = self.line(count, quick=quick)
            found = writhe(r)
            if abs(found - writhe(r[::2])) < STABLE:
                break
        return half_twists(self.twist, found)


def closure(solution: Solution) -> ClosedBand | None:
    """Band of which a solution is the whole, or a piece by symmetry; None if it is not closed."""
    loop = solution.scene.boundary.loop
    if loop is not None:
        band = declared(solution, loop)
        return band if is_closed(band, TOLERANCE) else None
    ends, (start, last) = at_ends(solution), solution.scene.interval
    returns = np.linalg.norm(ends["r"][1] - ends["r"][0]) <= TOLERANCE * (last - start)
    for sign in (1.0, -1.0) if returns else ():
        whole = _whole(solution, ends, sign)
        if is_closed(whole, TOLERANCE):
            return whole
    flip = find_flip(solution)
    if flip is None or not _carries_loads(solution, flip):
        return None
    return ClosedBand(solution, np.zeros(3), 0.0, flip)


def _carries_loads(solution: Solution, flip: Flip) -> bool:
    """Whether a flip carries what acts between the ends: an image need not have its share."""
    posed = solution.posed
    carried = (load.is_carried(about_d2=flip.along_d2) for load in posed.loads)
    return not posed.stations and all(carried)


def count_half_twists(solution: Solution) -> int | None:
    """Half twists of a solution that is a closed band, or a piece of one; None for all others."""
    band = closure(solution)
    if band is None:
        return None
    loop = solution.scene.boundary.loop
    count, off = _counted(band, None if loop is None else loop.half_twists)
    return count if off <= WHOLE else None


def loop_problems(solution: Solution, loop: Loop, allowed: float) -> list[str]:
    """Return what is not as a scene's loop asks: whether it closes, and its half twists.

    `allowed` is the gap, relative to the length, that the accuracy of the solution explains.
    """
    band = declared(solution, loop)
    tolerance = max(TOLERANCE, allowed)
    if not is_closed(band, tolerance):
        x, y, z = band.gap
        return [
            f"the loop does not close: it returns ({x:.3g}, {y:.3g}, {z:.3g}) of its length away "
            f"from its start, its directors off by {band.tilt:.2g}; start from another guess"
        ]
    asked = loop.half_twists
    found, off = _counted(band, asked)
    if not off <= WHOLE:
        return [
            f"the half twists of the loop cannot be counted (off by {off:.2g}); refine the mesh"
        ]
    if found == asked:
        return []
    twists = "half twist" if abs(found) == 1 else "half twists"
    return [
        f"the loop has {found} {twists}, asked were {asked}: start from guess: "
        f"{{moebius: {{half_twists: {asked}}}}}, or from a saved result that has them"
    ]


def _counted(band: ClosedBand, asked: int | None) -> tuple[int, float]:
    """Return the half twists of a band, and how far from whole.

    Of one that passes through itself those nearest to what is asked.
    """
    found, off = band.half_twists(asked)
    if asked is not None and found != asked:
        # Passing through itself a line gains or loses four: the figure of eight has 2 or -2.
        rest, crossings = writhe_and_crossings(band.line(POINTS[1]))
        if crossings:
            least = 2 * (band.twist + rest) - 2 * crossings
            nearest = min(
                (least + 4 * k for k in range(crossings + 1)), key=lambda n: abs(n - asked)
            )
            return round(nearest), abs(nearest - round(nearest))
    return found, off


def is_closed(band: ClosedBand, tolerance: float) -> bool:
    """Whether position and directors return, to a tolerance."""
    return bool(np.linalg.norm(band.gap) <= tolerance and band.tilt <= tolerance)


def declared(solution: Solution, loop: Loop) -> ClosedBand:
    """ClosedBand that a scene says a solution is, or is a piece of, closed or not."""
    start, end = solution.scene.interval
    s, ends = np.array([start, end]), at_ends(solution)
    if loop.piece == "whole":
        return _whole(solution, ends, -1.0 if loop.half_twists % 2 else 1.0)
    copies = loop.pieces // 2
    odd = loop.piece == "fundamental" or loop.half_twists % 2
    first, last = flip_at(ends, s, 0, "d1"), flip_at(ends, s, 1, "d2" if odd else "d1")
    # The flip at the start, then that at the end, carries a piece to the next but one.
    turn = last.matrix @ first.matrix
    shift = last.carry(first.carry(np.zeros((1, 3))))[0]
    r = r0 = ends["r"][0]
    for _ in range(copies):
        r = turn @ r + shift
    gap = (r - r0) / (2 * copies * (end - start))
    tilt = np.abs(np.linalg.matrix_power(turn, copies) - np.eye(3)).max()
    return ClosedBand(solution, gap, float(tilt), last, copies, turn, shift)


def _whole(solution: Solution, ends: Mapping[str, Array], sign: float) -> ClosedBand:
    """Band of a whole loop whose d1 and d2 return with a sign; `ends` are its outputs there."""
    start, end = solution.scene.interval
    gap = (ends["r"][1] - ends["r"][0]) / (end - start)
    pairs = (("d1", sign), ("d2", sign), ("d3", 1.0))
    tilt = max(np.abs(ends[d][1] - factor * ends[d][0]).max() for d, factor in pairs)
    return ClosedBand(solution, gap, float(tilt))
