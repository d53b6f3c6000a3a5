"""Whether a solution of the package is an equilibrium of its scene: integrated from its own start.

What grows along the ribbon is measured, by starts that are a little off, and the integration begins
again on the solution where it has grown by more than MOST: gaps are told over that growth.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from .curved import EITHER
from .described import AXES, knots, number, parts, strip_of
from .loaded import Point, Strip
from .rod import Array, dot
from .samples import Samples, boundary
from .wide import ETA, P, Wide

MOST = 1e3
AGAIN = ", taken anew"
OFF = 1e-6  # of starts by which growth is measured
CHECKED = 16  # places at least
RTOL = 1e-12
SAMPLES = 40  # of each phase: the sign of T
ZERO = 1e-7  # of moments: a T as small as that all along a phase is that of a mixture
LAYERS = 1.5  # stops for each width of a ribbon that has one: errors grow as exp(sqrt(24) s / w)


@dataclass(frozen=True)
class Confirmed:
    """What was found: gaps (relative, over their growth), where, and starts taken anew."""

    worst: float
    where: str
    restarts: int


def confirm(solution: Any) -> float:
    """Largest mismatch of a solution and its integration, over how much an error grows there.

    Positions and directors count as they are, forces and moments by one and their largest value.
    Infinite where a sheet of the law has the wrong sign; ValueError for what is not known here.
    """
    return examine(solution).worst


def examine(solution: Any) -> Confirmed:
    """Return the largest mismatch, and what it is."""
    scene = solution.posed.scene
    a, b = scene.interval
    strip = strip_of(scene)
    width = strip.width if isinstance(strip, Wide) else None
    given = Samples(solution, a, b, width)
    strip, held = with_reactions(strip, scene, given)
    phases = a + (b - a) * np.asarray(solution.trajectory.ends)
    stations = [p.at for p in strip.points]
    loads = getattr(scene, "loads", None)
    said = [getattr(scene, "width", None), getattr(loads, "pressure", None)]
    said += parts(getattr(loads, "force", None)) + parts(getattr(loads, "couple", None))
    said += parts(getattr(scene, "natural", None), ("curvature", "twist", "across"))
    bends = np.concatenate([knots(x) for x in said])
    bends = bends[(bends > a) & (bends < b)]
    count = CHECKED if width is None else max(CHECKED, int(LAYERS * (b - a) / width))
    stops = merged([phases, stations, bends, np.linspace(a, b, count + 1)])
    kinds, wrong = sheets(strip, given, phases, scene)
    if not strip.switched:  # but mixtures there may be, of which the solution tells
        kinds = [int(kind != 0) for kind in getattr(solution, "sheets", ())] or kinds
    if wrong:
        return Confirmed(np.inf, wrong, 0)
    found, sides = march(strip, given, stops, phases, kinds)
    found += boundary(scene, given, strip, sides) + held
    worst = max(found, key=lambda pair: pair[0] if np.isfinite(pair[0]) else np.inf)
    restarts = sum(AGAIN in where for _, where in found)
    return Confirmed(float(worst[0]), worst[1], restarts)


def merged(arclengths: list[Any]) -> list[float]:
    """Ascending arclengths, those that are the same but for rounding once."""
    found: list[float] = []
    for s in sorted(float(s) for some in arclengths for s in some):
        if not found or s - found[-1] > 1e-11:
            found.append(s)
    return found


def with_reactions(
    strip: Strip | Wide, scene: Any, given: Samples
) -> tuple[Strip | Wide, list[tuple[float, str]]]:
    """Add what supports between the ends take, as the solution has it; gaps of their places."""
    theta, points, held = scene.parameters, list(strip.points), []
    for support in getattr(scene, "supports", ()) or ():
        at = number(support.at, theta)
        place = np.array([number(v, theta, np.nan) for v in parts(support.position)])
        fall = given(at, -1)[12:15, 0] - given(at)[12:15, 0]
        for p in strip.points:
            if abs(p.at - at) < 1e-11 and not p.follows:
                fall = fall - np.array(p.force)
        points.append(Point(at, tuple(np.where(np.isnan(place), 0.0, fall))))
        gaps = np.nan_to_num(np.abs(given(at)[:3, 0] - place))
        held += [(float(g), f"support at {at}: {x}") for g, x in zip(gaps, AXES, strict=True)]
    return replace(strip, points=tuple(points)), held


def sheets(strip: Strip | Wide, given: Samples, phases: Array, scene: Any) -> tuple[list[int], str]:
    """Kinds of the phases, by T of the solution; what is wrong with them."""
    if not strip.switched:
        return [1] * (len(phases) - 1), ""
    chi = getattr(scene.law, "chi", 0)
    kinds = []
    _, size, _ = given.sizes
    for first, last in pairwise(phases):
        inside = first + (last - first) * (np.arange(SAMPLES) + 0.5) / SAMPLES
        T = np.array([strip.turn(given(s), np.array([s]))[0] for s in inside]) / size
        if chi:
            kinds.append(chi)
        elif np.abs(T).max() < ZERO:
            kinds.append(0)
        else:
            kinds.append(1 if T[np.abs(T).argmax()] > 0 else -1)
            if (kinds[-1] * T).min() < -ZERO:
                if planar(strip, given, inside, size):
                    kinds[-1] = EITHER
                    continue
                return kinds, f"T changes its sign between {first:.6g} and {last:.6g}"
    return kinds, ""


def planar(strip: Strip | Wide, given: Samples, inside: Array, size: float) -> bool:
    """Whether the ribbon only bends: then both sheets meet where T vanishes."""
    for s in inside:
        _, K12, K22, _ = strip.natural.moments(np.array([s]))
        y = given(s)
        sideways = [dot(y[9:12], y[15:18])[0] + 2 * K12[0], K22[0]]
        if isinstance(strip, Wide):
            sideways += [y[ETA, 0], y[P, 0]]
        if np.abs(sideways).max() > ZERO**2 * size:
            return False
    return True


def march(
    strip: Strip | Wide, given: Samples, stops: list[float], phases: Array, kinds: list[int]
) -> tuple[list[tuple[float, str]], tuple[Array, Array]]:
    """Gaps at all stops, over their growth; and the states at both ends."""
    force, moment, p = given.sizes
    rows = given.compared
    units = np.array([1.0] * 12 + [force] * 3 + [moment] * 3 + [1.0, p])[: len(rows), None]
    varied = rows[12:]  # all but places and directors

    def started(s: float, side: int) -> Array:
        y = np.repeat(given(s, side), 1 + len(varied), axis=1)
        y[varied, 1:] += np.diag(OFF * units[12:, 0])
        return y

    found = []
    first = y = started(stops[0], 1)
    if any(abs(p.at - stops[0]) < 1e-11 for p in strip.points):
        raise ValueError("a load at the very start is not known here")
    for s, after in pairwise(stops):
        kind = kinds[min(np.searchsorted(phases, (s + after) / 2) - 1, len(kinds) - 1)]
        y = strip.piece(y, s, after, int(kind), RTOL)
        told = given(after, -1)
        gap = np.abs((y[rows, :1] - told[rows]) / units).max()
        growth = max(1.0, np.abs((y[rows, 1:] - y[rows, :1]) / units).max() / OFF)
        again = growth > MOST
        found.append((gap / growth, f"s = {after:.6g}{AGAIN if again else ''}"))
        if again:
            y = started(after, -1)
        here = [p.at for p in strip.points if abs(p.at - after) < 1e-11]
        if here and after < stops[-1]:
            y = strip.jump(y, here[0])
        if strip.switched and np.abs(phases[1:-1] - after).min(initial=1) < 1e-11:
            found.append(switched(strip, kinds, phases, y, after, moment))
    return found, (first[:, :1], told)


def switched(
    strip: Strip | Wide, kinds: list[int], phases: Array, y: Array, s: float, moment: float
) -> tuple[float, str]:
    """T where the sheet changes, which is zero there."""
    i = int(np.abs(phases - s).argmin())
    if kinds[i - 1] == kinds[i] or EITHER in kinds[i - 1 : i + 1]:
        return 0.0, ""  # a station
    T = strip.turn(y, np.full(y.shape[1], s)) / moment
    growth = max(1.0, float(np.abs(T[1:] - T[0]).max() / OFF))
    return float(abs(T[0])) / growth, f"switch at {s:.6g}"
