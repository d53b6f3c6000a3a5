"""The tangent of a locus: the direction of the surface in which its test function stays zero."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution

from ..coordinates import reduced
from ..walk.points import FOLD
from .chart import Chart
from .laid import Laid
from .slices import Found
from .surface import Surface

DIFFERENCE = 1e-4  # half the arclength that derivatives of the test function are taken over
ALIKE = 0.9  # cosine of directions, above which they tell no plane


@dataclass(frozen=True, eq=False)
class Ahead:
    """Where a locus goes at one of its points; its equations have no determinant to tell."""

    direction: Array
    sign: float = 0.0
    log: float = 0.0

    def kernel(self) -> Array:
        """Raise LinAlgError: no null direction is known."""
        raise np.linalg.LinAlgError("no branch leaves a locus")


def laid_of(surface: Surface, solution: Solution, chart: Chart, found: Found) -> Laid:
    """Return how a locus lies at a point that was found on a slice.

    Its derivative across is known of the slice; that along is a difference of what is next to the
    surface, off which central differences are of second order too.
    """
    metric = surface.metric_at(solution, found.y)
    y1, y2 = (reduced(solution, part, surface.count) for part in (found.first, found.second))
    h = DIFFERENCE / metric.length(y1)
    ahead, behind = (chart.read(found.y + s * h * found.first).test for s in (1, -1))
    rate = (ahead - behind) / (2 * h)
    tangent = found.slope * found.first - rate * found.second
    t = found.slope * y1 - rate * y2
    length = metric.length(t)
    tangent, t = tangent / length, t / length
    across, n = found.second, y2
    if abs(metric.product(n, t)) > ALIKE * metric.length(n):
        across, n = found.first, y1
    part = metric.product(n, t)
    across, n = across - part * tangent, n - part * t
    across = across / metric.length(n)
    scale = 0.0 if chart.kind == FOLD else chart.scale
    return Laid(tangent, across, found.slope, found.sides, doubt=found.doubt, scale=scale)
