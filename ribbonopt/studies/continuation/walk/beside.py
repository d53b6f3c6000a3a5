"""Points of a branch at arclengths beside one of its points, and roots of what they tell.

Next to a fold or a branch point Newton's method fails, or lands on the branch that crosses. So a
test function is never read there but at six arclengths beside the place; its root is that of the
polynomial through them, and the unknowns at the root are interpolated alike.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Generic

import numpy as np

from ribbonopt.arrays import Array

from .linearised import Linearised
from .points import Point, S
from .protocol import Equations
from .tangents import near

OFFSETS = (-3, -2, -1, 1, 2, 3)  # of the arclengths that are read, in units of the spacing
FEWEST = 4  # of them
FIRST, NARROWER, NARROWEST = 1 / 8, 0.3, 1e-3  # spacing: of the whole; of the one before; at least
SAME = 0.2  # of the spacing: points that are this near are not read twice
ROUNDS = 8
SETTLED = 1e-11  # change of the root from one round to the next, in arclength
DOUBTED = 1e-7  # the same, above which there is no root
OFF = 0.3  # most distance of a point from its guess, of the arclength to the nearest known point
ENOUGH = 1e-11  # last relative step of Newton's method: rounding may leave no smaller ones
KNOTS = 4  # points that a guess is interpolated from
PART = 2 / 3  # of the way between two points: where it is looked whether one curve joins them
STRAY = 2e-3  # of that way: distance from the cubics there, above which none that is smooth does


@dataclass(frozen=True, eq=False)
class Probe(Generic[S]):
    """A point of the branch at an arclength beyond another, with its tangent."""

    arc: float
    solution: S
    unknowns: Array
    tangent: Array
    near: Linearised


class Beside(Generic[S]):
    """The branch beside two of its points, of one layout, by arclength along the first tangent."""

    def __init__(self, equations: Equations[S], a: Point[S], b: Point[S]) -> None:
        """Take two points."""
        self.equations, self.a = equations, a
        self.along = equations.reduced(a.solution, a.tangent)
        gap = equations.reduced(a.solution, b.unknowns - a.unknowns)
        self.whole = equations.metric.product(gap, self.along)
        self.ends = self._known(0.0, a), self._known(self.whole, b)
        self.known = {probe.arc: probe for probe in self.ends}

    def at(self, arc: float, within: float) -> Probe[S] | None:
        """Return the branch at an arclength, or within some of it; None where it is not found."""
        nearest = min(self.known, key=lambda s: abs(s - arc))
        if abs(nearest - arc) <= within:
            return self.known[nearest]
        equations, a = self.equations, self.a
        guess = self.unknowns(arc)
        trial = equations.correct_along(a, a.tangent, arc, guess, ENOUGH)
        off = equations.metric.length(equations.reduced(a.solution, trial.unknowns - guess))
        if not (trial.converged and off <= OFF * abs(arc - nearest)):
            return None
        try:
            found, tangent = near(equations, trial.solution, trial.unknowns, self.along)
        except np.linalg.LinAlgError:
            return None
        probe = Probe(arc, trial.solution, trial.unknowns, tangent, found)
        self.known[arc] = probe
        return probe

    def unknowns(self, arc: float) -> Array:
        """Interpolate the unknowns by points and tangents next to an arclength (Hermite)."""
        knots = self._nearest(arc)
        places = np.array([probe.arc for probe in knots])
        found = np.zeros_like(self.a.unknowns)
        for i, probe in enumerate(knots):
            others = np.delete(places, i)
            weight = float(np.prod((arc - others) / (places[i] - others))) ** 2
            slope = 2 * float((1 / (places[i] - others)).sum())
            step = arc - places[i]
            found += weight * (1 - slope * step) * probe.unknowns
            found += weight * step * self._slope(probe)
        return found

    def tangent(self, arc: float) -> Array:
        """Interpolate the tangent at an arclength, of unit length."""
        knots = self._nearest(arc)
        places = np.array([probe.arc for probe in knots])
        found = np.zeros_like(self.a.unknowns)
        for i, probe in enumerate(knots):
            others = np.delete(places, i)
            found += float(np.prod((arc - others) / (places[i] - others))) * self._slope(probe)
        length = self.equations.metric.length(self.equations.reduced(self.a.solution, found))
        return np.asarray(found / length)

    def reach(self, arc: float) -> float:
        """Distance from an arclength, on both sides of which the branch is known."""
        return min(arc - min(self.known), max(self.known) - arc)

    def root(self, test: Callable[[Probe[S]], float]) -> float | None:
        """Return the arclength where a test function vanishes, None where that is not found.

        The function has values of opposite sign at both ends.
        """
        values = {probe.arc: test(probe) for probe in self.ends}
        centre, spacing = _crossing(values), FIRST * self.whole
        change = np.inf
        for _ in range(ROUNDS):
            arcs = (centre + offset * spacing for offset in OFFSETS)
            read = dict.fromkeys(self.at(arc, SAME * spacing) for arc in arcs)
            probes = [probe for probe in read if probe is not None]
            values |= {probe.arc: test(probe) for probe in probes}
            found = _polynomial_root(probes, values, centre, 4 * spacing)
            if found is None:
                bracket = _bracket(values)
                if bracket is None:
                    return None
                low, high = bracket
                centre, spacing = (low + high) / 2, (high - low) / 7
                if spacing < 1e-3 * NARROWEST:
                    return None
                continue
            change, centre = abs(found - centre), found
            if change <= SETTLED:
                break
            narrower = max(NARROWER * spacing, min(NARROWEST, spacing))
            if narrower == spacing and change <= DOUBTED:
                break  # rounding: no spacing tells it better
            spacing = narrower
        return centre if change <= DOUBTED else None

    def _known(self, arc: float, point: Point[S]) -> Probe[S]:
        found, tangent = near(self.equations, point.solution, point.unknowns, self.along)
        return Probe(arc, point.solution, point.unknowns, tangent, found)

    def _nearest(self, arc: float) -> list[Probe[S]]:
        return sorted(self.known.values(), key=lambda probe: abs(probe.arc - arc))[:KNOTS]

    def _slope(self, probe: Probe[S]) -> Array:
        """Differentiate the unknowns by the arclength along the first tangent."""
        along = self.equations.reduced(self.a.solution, probe.tangent)
        return probe.tangent / self.equations.metric.product(along, self.along)


def strays(equations: Equations[S], a: Point[S], b: Point[S]) -> bool:
    """Whether the branch from a point leaves the cubics that join it to another of its layout.

    A branch that crosses can be tangent enough at the other point to be taken for the same one: it
    has left this one between them. On one curve the distance is of fourth order in the step.
    """
    metric, along = equations.metric, equations.reduced(a.solution, a.tangent)
    gap = b.unknowns - a.unknowns
    whole = metric.product(equations.reduced(a.solution, gap), along)
    begin, end = (
        p.tangent * whole / metric.product(equations.reduced(a.solution, p.tangent), along)
        for p in (a, b)
    )
    x = PART
    guess = a.unknowns + x * x * (3 - 2 * x) * gap + x * (1 - x) * ((1 - x) * begin - x * end)
    trial = equations.correct_along(a, a.tangent, x * whole, guess, ENOUGH)
    off = metric.length(equations.reduced(a.solution, trial.unknowns - guess))
    return not (trial.converged and off <= STRAY * abs(whole))


def _crossing(values: dict[float, float]) -> float:
    """Where the straight line through the two values of opposite sign vanishes, well inside."""
    (a, fa), (b, fb) = sorted(values.items())
    part = float(np.clip(fa / (fa - fb), 0.25, 0.75))
    return a + part * (b - a)


def _bracket(values: dict[float, float]) -> tuple[float, float] | None:
    """Neighbours between which a function changes its sign, None for none."""
    places = sorted(values)
    return next(((a, b) for a, b in pairwise(places) if values[a] * values[b] <= 0), None)


def _polynomial_root(
    probes: list[Probe[S]], values: dict[float, float], centre: float, reach: float
) -> float | None:
    """Return the root nearest to a centre of the polynomial through some values, None for none."""
    if len(probes) < FEWEST:
        return None
    places = np.array([probe.arc for probe in probes])
    heights = np.array([values[arc] for arc in places])
    polynomial = np.polynomial.Polynomial.fit(places, heights, len(places) - 1)
    roots = polynomial.roots()
    real = roots[np.abs(roots.imag) <= 1e-9 * reach].real
    near_by = real[np.abs(real - centre) <= reach]
    return float(near_by[np.abs(near_by - centre).argmin()]) if len(near_by) else None
