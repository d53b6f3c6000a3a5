"""What to doubt of an answer: its shape, and whether Sadowsky's model applies to the ribbon.

L >> w >> h, and generatrices that turn slowly: that needs the sizes of the ribbon, so only scenes
in SI are judged. Sadowsky's energy is the limit of
Wunderlich's for |eta'| w << 1: per length they differ by the factor (1/x) ln((2 + x)/(2 - x)), with
x = eta' w, and at |x| = 2 the generatrices meet on an edge.
"""

from __future__ import annotations

import math

import numpy as np

from ribbonopt.accuracy.spin import spin_problems
from ribbonopt.arrays import Array
from ribbonopt.mechanics.laws.catalogue import is_developable
from ribbonopt.mechanics.outputs import sheet_slopes
from ribbonopt.mechanics.widths import widths
from ribbonopt.scene import RibbonSizes
from ribbonopt.scene.limits import STRETCH
from ribbonopt.scene.sized import OfWidth
from ribbonopt.solution.solution import Solution

from .convexity import leap_problems
from .law_sizes import law_problems
from .shape import contact_problems, planar_problems
from .unknown_bars import unknown_bars
from .zero_moment import zero_moment_problems

SLENDER = 10.0  # least ratio of length to width, and of width to thickness
WIDEST = 1 / math.sqrt(3)  # w / L of a Moebius band in space (Schwartz 2023)
NOTABLE, MEETING = 0.5, 2.0  # |eta'| w
STEEP = 0.5  # |w'|: each edge leaves the tangent by 14 degrees
ROWS = 2001
BESIDE, ROUNDED = 1e-5, 1e-9  # of the length, for differences; of slopes of a sheet
FLAT = 1e-9  # of the largest moment, or of D w / L: below it m3 counts as zero


def warnings_of(solution: Solution) -> list[str]:
    """Return a sentence for each reason to doubt the answer or, with sizes, the model."""
    ribbon, converged = solution.scene.ribbon, solution.status.converged
    result = []
    if ribbon is not None:
        s = np.linspace(*solution.scene.interval, ROWS)
        width = ribbon.width * widths(solution.scene, s)
        result += [*_slenderness(ribbon, width), *_width_of_loop(solution, float(width.min()))]
        result += _taper(s, width)
        doubtful = converged and not isinstance(solution.scene.law, OfWidth)
        result += _generatrices(solution, s, width) if doubtful else []
    result += law_problems(solution)
    if converged:
        result += unknown_bars(solution)
        result += _stretch(solution)
        result += zero_moment_problems(solution)
        result += leap_problems(solution)
        result += spin_problems(solution)
        result += [*planar_problems(solution), *contact_problems(solution)]
    return result


def wunderlich_factor(x: float) -> float:
    """Wunderlich's energy per length over Sadowsky's, at x = eta' w; |x| < 2."""
    return 1.0 if x == 0 else math.log((2 + x) / (2 - x)) / x


def _slenderness(ribbon: RibbonSizes, width: Array) -> list[str]:
    ratios = {
        ("length", "width"): ribbon.length / float(width.max()),
        ("width", "thickness"): float(width.min()) / ribbon.thickness,
    }
    return [
        f"the {large} is only {ratio:.3g} times the {small}; the model is for L >> w >> h"
        for (large, small), ratio in ratios.items()
        if ratio < SLENDER
    ]


def _taper(s: Array, width: Array) -> list[str]:
    """Say where the width changes too fast along s for a law of each section by itself."""
    slopes = np.abs(np.gradient(width, s))
    row = int(slopes.argmax())
    if slopes[row] <= STEEP:
        return []
    return [
        f"the width changes by {slopes[row]:.3g} per length at s = {s[row]:.4g}; the model is for "
        "widths that hardly change over the width itself (|w'| << 1)"
    ]


def _stretch(solution: Solution) -> list[str]:
    """Say where the centre line stretches by more than a linear law is for."""
    stretch = np.abs(solution.at_stages["extension"])
    if float(stretch.max()) <= STRETCH:
        return []
    return [
        f"the centre line stretches or shrinks by up to {stretch.max():.3g} of its length; the law "
        f"of stretch is linear, for up to {STRETCH:g}: raise membrane.stretching"
    ]


def _width_of_loop(solution: Solution, width: float) -> list[str]:
    """Compare the least width of a Moebius band with what no band can have all along."""
    loop = solution.scene.boundary.loop
    if loop is None or loop.half_twists % 2 == 0:
        return []
    start, end = solution.scene.interval
    share = width / (loop.pieces * (end - start))
    if share < WIDEST:
        return []
    return [
        f"no embedded developable Moebius band is that wide: w/L = {share:.3g}, and "
        f"w/L < 1/sqrt(3) = {WIDEST:.3g}"
    ]


def _generatrices(solution: Solution, s: Array, width: Array) -> list[str]:
    """Compare with Wunderlich's energy where the generatrices turn fastest."""
    if not is_developable(solution.scene):
        return []
    products = np.abs(generatrix_slopes(solution, s)) * width
    row = int(products.argmax())
    x, place = float(products[row]), f"at s = {s[row]:.4g}"
    if x >= MEETING:
        return [
            f"the generatrices meet inside the ribbon {place} (|eta'| w = {x:.3g}, beyond 2): "
            "Sadowsky's model is out of its range"
        ]
    if x <= NOTABLE:
        return []
    more = wunderlich_factor(x) - 1
    return [
        f"Wunderlich's energy per length is {more:.1%} above Sadowsky's {place} "
        f"(|eta'| w = {x:.3g})"
    ]


def generatrix_slopes(solution: Solution, s: Array) -> Array:
    """Slopes eta' (k,) at arclengths s (k,), by the moments; zero where |eta| > 1 or not twisted.

    Sadowsky's law has |eta| = tan(phi / 2) with tan phi = m3 / |m2|, so that on either sheet
    eta' = phi' (1 + eta^2) / 2; by eqs. (2.2), (2.7) m2' = u1 m3 - u3 m1 - (1 + e) n1
    and m3' = u2 m1 - u1 m2. Where m2 changes sign eta leaps, and laws that smooth the leap are not
    blamed for it. With natural strains they are differences of eta between places on one sheet.
    """
    if solution.scene.natural is not None:
        return _by_differences(solution, s)
    o = solution.outputs(s)
    largest = max(float(np.hypot(o["m2"], o["m3"]).max()), solution.units.moment)
    rows = (np.abs(o["m3"]) > FLAT * largest) & (np.abs(o["eta"]) <= 1 + 1e-9)
    m1, m2, m3, n1, e = (o[name][rows] for name in ("m1", "m2", "m3", "n1", "extension"))
    u1, u2, u3 = (o[name][rows] for name in ("u1", "u2", "u3"))
    size = np.hypot(m2, m3)
    bent, twisted = u1 * m3 - u3 * m1 - (1 + e) * n1, u2 * m1 - u1 * m2  # m2' and m3'
    turn = (m2 * twisted - m3 * bent) / size**2
    result = np.zeros(len(s))
    result[rows] = (1 + (m3 / (size + np.abs(m2))) ** 2) / 2 * turn
    return result


def _by_differences(solution: Solution, s: Array) -> Array:
    """Return the slopes (k,) from eta on either side, zero where not both are on one sheet."""
    start, end = solution.scene.interval
    reach = BESIDE * (end - start)
    places = np.clip([s - reach, s + reach], start, end)
    before, after = (solution.outputs(at) for at in places)
    one = (before["u2"] > 0) == (after["u2"] > 0)
    one &= np.maximum(sheet_slopes(before), sheet_slopes(after)) <= 1 + ROUNDED
    change = (after["eta"] - before["eta"]) / (places[1] - places[0])
    return np.where(one, change, 0.0)
