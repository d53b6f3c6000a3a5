"""Meshes that share the error evenly: where nodes go, and how many elements a tolerance needs.

The local error of an element of width h falls like rho^(-p) with the order p of the scheme, where
rho is the size of the ellipse in which the solution is analytic: as h^p where the next singularity
is far away, slower next to one (a layer, or the end of a phase). `rho` is read from the decay of
the Legendre coefficients; the width that is wanted there follows, and widths grow from there.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ribbonopt.arrays import Array

SIZES = tuple(sorted({2 * round(5 * 2 ** (k / 4)) for k in range(-4, 29)}))  # even
FLOOR, WORST = 1e-16, 1e16  # local errors below are rounding, above they say nothing more
NARROWEST, WIDEST = 2.0**-10, 4.0  # of the change of an element's width in one step
GRADING = 1.0  # growth of the widths with the distance
NEAREST, FARTHEST = 1.2, 1e4  # of the sizes rho of ellipses
UNSEEN = 1.01  # rho where there is a singularity so near that no stage has met it
_HALVES = 0.5 ** np.arange(12, 1, -1)
_FAR = np.append(0.0, 0.5 ** np.arange(34, 1, -1))
# Where in an element widths are looked at: close together at its ends and in its middle.
PLACES = np.sort(
    np.concatenate([[0, 0.5, 1], _HALVES, 0.5 - _HALVES[:-1], 0.5 + _HALVES, 1 - _HALVES[:-1]])
)


def analyticity(coefficients: Array) -> Array:
    """Size rho (N,) of the ellipse where each element's solution is analytic, from its decay.

    `coefficients` (N, K) are the sizes of its Legendre coefficients, degree increasing. With fewer
    than four nothing is known: the singularity is taken to be far away.
    """
    count, degree = coefficients.shape
    if degree < 4:
        return np.full(count, FARTHEST)
    largest = np.maximum(coefficients.max(axis=1), np.finfo(float).tiny / FLOOR)
    # Pairs, because every other coefficient may vanish by symmetry.
    high = np.maximum(coefficients[:, -2:].max(axis=1), FLOOR * largest)
    low = np.maximum(coefficients[:, -4:-2].max(axis=1), FLOOR * largest)
    return np.asarray(np.clip(np.sqrt(low / high), NEAREST, FARTHEST))


def wanted_widths(widths: Array, local: Array, rho: Array, order: int, target: float) -> Array:
    """Width (N,) that each element should have at its singularity for a local error `target`."""
    least = np.finfo(float).tiny  # where no error is left at all
    larger = (np.clip(local, FLOOR, WORST) / max(target, least)) ** (1 / (order + 1))
    # The singularity lies beyond an end of the element, by (rho + 1/rho)/2 - 1 half widths.
    after = np.maximum(rho * larger, NEAREST)
    change = _distance(rho) / _distance(after)
    return np.asarray(widths * np.clip(change, NARROWEST, WIDEST))


def graded(
    widths: Array,
    wanted: Array,
    around: Array | None = None,
    limit: Callable[[Array], Array] | None = None,
) -> tuple[Array, Array]:
    """Positions (k,) from 0 to 1, and how many elements (k,) are wanted before each.

    An element that should be narrower is so around its middle, or at the end of the phase if it is
    the first or last; from there widths grow with the distance. `limit` are the largest widths at
    relative positions; it is looked at around the places `around` too.
    """
    nodes = np.append(0.0, np.cumsum(widths))
    positions = nodes[:-1, None] + widths[:, None] * PLACES
    peak = nodes[:-1] + widths / 2
    peak[0], peak[-1] = nodes[0], nodes[-1]
    near = np.abs(positions - peak[:, None]) <= wanted[:, None]
    width = np.where(near, wanted[:, None], np.maximum(wanted, widths)[:, None]).ravel()
    s = positions.ravel()
    if around is not None and limit is not None:
        close = np.clip(around[:, None] + np.concatenate([-_FAR, _FAR]), 0.0, 1.0).ravel()
        every = np.sort(np.concatenate([s / s[-1], close]))
        width = np.minimum(np.interp(every, s / s[-1], width), s[-1] * limit(every))
        s = s[-1] * every
    width = np.minimum.accumulate(width - GRADING * s) + GRADING * s
    width = np.minimum.accumulate((width + GRADING * s)[::-1])[::-1] - GRADING * s
    share = np.append(0.0, np.cumsum(np.diff(s) * (1 / width[1:] + 1 / width[:-1]) / 2))
    return s / s[-1], share


def redistributed(positions: Array, share: Array, count: int) -> Array:
    """Return relative widths (count,) that divide what is wanted evenly."""
    nodes = np.interp(np.linspace(0, share[-1], count + 1), share, positions)
    nodes[0], nodes[-1] = 0.0, 1.0
    return np.diff(nodes)


def size_for(count: int) -> int:
    """Return the number of elements that is built for a number wanted: few sizes serve all."""
    return next((size for size in SIZES if size >= count), SIZES[-1])


def _distance(rho: Array) -> Array:
    """Distance from the end of an element to its singularity, in half widths."""
    return np.asarray((rho + 1 / rho) / 2 - 1)
