"""Loci in the plane of a map: where they go, and whether a special point is on a known one."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.plain import Row
from ribbonopt.scene.maps import MapPlan
from ribbonopt.studies.continuation.walk.points import POINT

from .lines import PARTS, smooth

CUSP = "cusp"
TWICE = 1e-9  # of the square: points nearer than this are one
ON = 1e-5  # of the square: a special point so near to a locus is on it
INSIDE = 1e-9  # of the square: what is on the border is inside
CURVED = 0.5  # of what a curve leaves its chord by: it is known no better between points


@dataclass(frozen=True, eq=False)
class Locus:
    """A locus in the unit square.

    Attributes
    ----------
    number : int
        Of the locus, from 1.
    kind : str
        What it is a locus of.
    rows : tuple of Row
        Its points in order, from one end to the other.
    points : Array
        Where they are (k, 2); coordinates are shares of the ranges.
    ending : str
        How it has ended.
    """

    number: int
    kind: str
    rows: tuple[Row, ...]
    points: Array
    ending: str

    @classmethod
    def of(cls, number: int, kind: str, rows: Sequence[Row], plan: MapPlan, ending: str) -> Locus:
        """Join the points of both ways, each of them once."""
        ways: dict[int, list[Row]] = {}
        for row in rows:
            ways.setdefault(row["branch"], []).append(row)
        back, *on = [ways[way] for way in sorted(ways)]
        order = [*back[::-1], *(row for way in on for row in way)] if on else back
        points = np.array([at(row, plan) for row in order]).reshape(-1, 2)
        gaps = np.hypot(*np.diff(points, axis=0).T)
        keep = np.concatenate([[True], gaps > TWICE])
        # Of two at one place the one that is special says more.
        for i in np.nonzero(~keep)[0]:
            if order[i]["kind"] != POINT:
                order[i - 1] = order[i]
        kept = tuple(row for row, fine in zip(order, keep, strict=True) if fine)
        return cls(number, kind, kept, points[keep], ending)

    @cached_property
    def curve(self) -> Array:
        """A smooth curve (m, 2) through its points, with corners at cusps."""
        corners = [i for i, row in enumerate(self.rows) if row["kind"] == CUSP]
        return smooth(self.points, corners)

    @property
    def special(self) -> list[Row]:
        """Rows of cusps and whatever else is named on it."""
        return [row for row in self.rows if row["kind"] != POINT]

    def goes_through(self, place: Array) -> bool:
        """Whether a point (2,) of the square is on it, as far as it is known between its points."""
        if len(self.curve) < 2:
            return bool(np.hypot(*(self.points - place).T).min() <= ON)
        starts, ways = self.curve[:-1], np.diff(self.curve, axis=0)
        squares = np.maximum((ways**2).sum(axis=1), np.finfo(float).tiny)
        share = np.clip(((place - starts) * ways).sum(axis=1) / squares, 0, 1)
        gaps = np.hypot(*(starts + share[:, None] * ways - place).T)
        nearest = int(gaps.argmin())
        return bool(gaps[nearest] <= max(ON, CURVED * self._bend(nearest // PARTS)))

    def _bend(self, i: int) -> float:
        """How far the curve after point i leaves its chord."""
        part = self.curve[PARTS * i : PARTS * (i + 1) + 1]
        way = part[-1] - part[0]
        length = max(float(np.hypot(*way)), np.finfo(float).tiny)
        aside = (part - part[0]) @ np.array([-way[1], way[0]]) / length
        return float(np.abs(aside).max())


def at(row: Row, plan: MapPlan) -> tuple[float, float]:
    """Return where the point of a row is, in shares of the ranges."""
    (left, right), (low, high) = plan.ranges
    return (row[plan.x] - left) / (right - left), (row[plan.y] - low) / (high - low)


def value_of(place: Array, plan: MapPlan) -> tuple[float, float]:
    """Return the values of both numbers at a point (2,) of the square."""
    (left, right), (low, high) = plan.ranges
    x, y = (float(share) for share in place)
    return left + x * (right - left), low + y * (high - low)


def inside(place: Array) -> bool:
    """Return whether a point (2,) is in the square."""
    return bool(((place >= -INSIDE) & (place <= 1 + INSIDE)).all())


def told_of(what: str, row: Row, plan: MapPlan, came: Row) -> str:
    """Return what failed, where, and by what."""
    where = f"{plan.x} = {row[plan.x]:.6g}, {plan.y} = {row[plan.y]:.6g}"
    return f"{what} at {where}: {came['message'] or came['status']}"
