"""The special point on one slice of the surface: along it both parameters move on a curve.

A fold is regular on the surface, and found by secants. At a branch point the surface is crossed by
another one: Newton's method fails next to it, or lands on that. So the determinant is read at six
places beside, and its root is that of the polynomial through them.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from ..walk.points import FOLD
from .chart import Chart, Sample

SIDE = 0.005  # arclength to what is given of both sides of a fold
REACH = 0.5  # arclength across, within which a special point is looked for
FIRST = 0.001  # arclength between the first two places: folds may be narrow on the surface
APART = 1e-4  # arclength between places that a polynomial goes through
SETTLED = 1e-9  # change of the place of a fold, in arclength: there parameters change by its square
ROUNDS = 12
NARROW = 0.0025  # spacing of the places beside a branch point; halved while these are too far
NARROWEST = 6e-4
OFFSETS = (-3, -2, -1, 1, 2, 3)  # of these, in spacings
CENTRED = 0.6  # of the spacing: how far the root may be from the middle
REUSED = 0.25  # of the spacing: places that are this near are not read twice
KNOTS = 4  # that guesses are interpolated from
DOUBT = 1e-10  # of what counts as one: change of a parameter by the outermost places, at most
SPREAD = 1e-9  # relative change of states by the outermost places: more, and no curve joins them
GONE = (
    "no branch point was found near by: where the symmetry is broken by which branches cross, it "
    "dissolves into a fold and nothing"
)
DIFFERENCES = 4e-10  # relative error of tangents, as derivatives by parameters are differences
TRUSTED = 0.05  # of that change: error of what all places say, whose order is higher by two or four
OFF = 0.3  # most distance of a point from its guess, of the arclength to the nearest known one


@dataclass(frozen=True, eq=False)
class Found:
    """The special point on a slice.

    Attributes
    ----------
    y, first, second : (n + 2,) arrays
        Unknowns, and both tangents of the surface.
    slope : float
        Derivative of the test function across.
    sides : pair of (n + 2,) arrays
        Points of the surface on both sides.
    doubt : float
        Error that the interpolation may leave in l1.
    """

    y: Array
    first: Array
    second: Array
    slope: float
    sides: tuple[Array, Array]
    doubt: float = 0.0


class LostError(Exception):
    """There is no special point on a slice; says why."""


def found_on(chart: Chart, s: float, guess: Array, way: Array) -> Found:
    """Return the special point on the slice at s, near a guess (n + 2,).

    `way` (n + 2,) goes across, in which t grows by one; nothing but guesses depends on it.

    Raises
    ------
    LostError
        If the test function has no zero near by.
    LinAlgError
        If the surface is not found, or singular.
    """
    one = _Slice(chart, s, guess, way)
    return one.fold() if chart.kind == FOLD else one.crossing()


class _Slice:
    """One slice: what is known of it, by the place across."""

    def __init__(self, chart: Chart, s: float, guess: Array, way: Array) -> None:
        self.chart, self.s, self.guess, self.way = chart, s, guess, way
        self.middle = chart.place(guess)[1]
        self.known: dict[float, Sample] = {}

    def at(self, t: float) -> Sample:
        """Return the surface at a place."""
        if t not in self.known:
            first = self.guess + (t - self.middle) * self.way
            guess = self.unknowns(t) if self.known else first
            self.known[t] = self.chart.sample(guess, self.s, t)
        return self.known[t]

    def unknowns(self, t: float, count: int = KNOTS) -> Array:
        """Interpolate the unknowns (n + 2,) by points and tangents next to a place (Hermite)."""
        knots = sorted(self.known.values(), key=lambda one: abs(one.t - t))[:count]
        places = np.array([one.t for one in knots])
        found = np.zeros_like(knots[0].y)
        for i, one in enumerate(knots):
            others = np.delete(places, i)
            weight = float(np.prod((t - others) / (places[i] - others))) ** 2
            slope = 2 * float((1 / (places[i] - others)).sum())
            step = t - places[i]
            found += weight * ((1 - slope * step) * one.y + step * one.second)
        return found

    def fold(self) -> Found:
        """Return the fold on this slice."""
        nearest = self.at(self.middle)
        self.at(self.middle + FIRST)
        for _ in range(ROUNDS):
            root, slope = _root(self._apart(), nearest.t)
            nearest = min(self.known.values(), key=lambda one: abs(one.test))
            if slope and abs(nearest.test / slope) < APART:
                root = nearest.t - nearest.test / slope
            if root is None or abs(root - self.middle) > REACH:
                break
            if abs(root - nearest.t) <= SETTLED:
                sides = self._beside(nearest, -SIDE), self._beside(nearest, SIDE)
                return Found(nearest.y, nearest.first, nearest.second, slope, sides)
            self.at(root)
        raise LostError("no fold was found near by")

    def _beside(self, one: Sample, off: float) -> Array:
        """Return the surface at a distance across from a sample."""
        return self.chart.corrected(one.y + off * one.second, self.s, one.t + off)

    def _apart(self) -> list[Sample]:
        """Return samples of the least test functions, far enough from each other."""
        found: list[Sample] = []
        for one in sorted(self.known.values(), key=lambda one: abs(one.test)):
            if all(abs(one.t - other.t) > APART for other in found):
                found.append(one)
        return found[:KNOTS]

    def crossing(self) -> Found:
        """Return the branch point on this slice."""
        t, h = self.middle, NARROW
        for _ in range(ROUNDS):
            pair = [self.at(t + offset * h) for offset in (-1.5, 1.5)]
            root, _ = _root(pair, t)
            if root is None or abs(root - self.middle) > REACH:
                raise LostError(GONE)
            change, t = root - t, root
            if abs(change) <= 4 * h:
                break
        for _ in range(ROUNDS):
            values = [self._near(t + offset * h, REUSED * h) for offset in OFFSETS]
            root, slope = _root(values, t)
            if root is None or abs(root - self.middle) > REACH:
                raise LostError(GONE)
            change, t = root - t, root
            if abs(change) > CENTRED * h:
                continue
            y, doubt, spread = self._between(values, t)
            if h / 2 < NARROWEST and spread > SPREAD:
                raise LostError(GONE)
            doubt = max(doubt, spread / SPREAD * DOUBT)
            if doubt <= DOUBT or h / 2 < NARROWEST:
                first, second = (_interpolated(values, t, name) for name in ("first", "second"))
                sides = values[0].y, values[-1].y
                steep = max(abs(float(one.second[-2])) for one in values)
                doubt = TRUSTED * doubt * self.chart.spans[0] + DIFFERENCES * h * steep
                return Found(y, first, second, slope, sides, doubt)
            h /= 2
        raise LostError(GONE)

    def _between(self, values: list[Sample], t: float) -> tuple[Array, float, float]:
        """Return the unknowns at a root, and what the outermost places change of them.

        That of the parameters, of what counts as one, and of the states, relative.
        """
        y, coarser = self.unknowns(t, len(values)), self.unknowns(t, len(values) - 2)
        inner, _ = _root(values[1:-1], t)
        off = np.abs(y - coarser)[-2:]
        if inner is not None:
            off += abs(inner - t) * np.abs(_interpolated(values, t, "second")[-2:])
        states, others = (self.chart.line.reduced(some)[:-2] for some in (y, coarser))
        spread = float((np.abs(states - others) / (1 + np.abs(states))).max())
        return y, float((off / np.array(self.chart.spans)).max()), spread

    def _near(self, t: float, within: float) -> Sample:
        nearest = min(self.known, key=lambda place: abs(place - t))
        return self.known[nearest] if abs(nearest - t) <= within else self.at(t)


def _root(samples: list[Sample], near: float) -> tuple[float | None, float]:
    """Return the root next to a place of the polynomial through test functions; its slope there."""
    places = np.array([one.t for one in samples]) - near
    scale = float(np.abs(places).max()) or 1.0
    heights = np.array([one.test for one in samples])
    size = float(np.abs(heights).max()) or 1.0
    coefficients = np.linalg.solve(np.vander(places / scale, increasing=True), heights / size)
    found = np.polynomial.polynomial.polyroots(coefficients) if coefficients[1:].any() else None
    roots = np.empty(0) if found is None else found
    real = np.array([z.real for z in roots if abs(z.imag) <= 1e-9])
    if not len(real):
        return None, 0.0
    root = float(real[np.abs(real).argmin()])
    derivative = np.polynomial.polynomial.polyder(coefficients)
    slope = float(np.polynomial.polynomial.polyval(root, derivative)) * size / scale
    return near + scale * root, slope


def _interpolated(samples: list[Sample], t: float, name: str) -> Array:
    """Interpolate a vector of samples at a place (Lagrange)."""
    places = np.array([one.t for one in samples])
    found = np.zeros_like(samples[0].y)
    for i, one in enumerate(samples):
        others = np.delete(places, i)
        found += float(np.prod((t - others) / (places[i] - others))) * getattr(one, name)
    return found
