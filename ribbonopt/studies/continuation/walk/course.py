"""Whether a point is where the branch was going: angle, bend and distance of a step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ribbonopt.arrays import Array

from .metric import Metric
from .points import Point, S
from .protocol import Equations

AIM = 0.02  # wanted distance of a prediction from the curve, in arclength
FARTHEST = 5.0  # times that: a point that is further off is none of this curve
COSINE = 0.7  # least one of the angle between tangents one step apart
SKEW, WANTED_SKEW = 0.2, 0.05  # of the way against the mean of the tangents: most, and wanted
STRAIGHT, EVEN = 0.99, 0.005  # cosine and skew of steps that are taken without a look between


@dataclass(frozen=True, eq=False)
class Leaving:
    """Coordinates (m,) of a point, of its tangent, and of where that leads."""

    here: Array
    tangent: Array
    expected: Array


@dataclass(frozen=True)
class Course:
    """How a step went.

    Attributes
    ----------
    off : float
        Distance from the prediction, in arclength.
    cosine : float
        Of the angle between the tangents.
    skew : float
        Difference of the direction of the way from that of the mean of both tangents: of third
        order on a curve, large where the point is on another one.
    """

    off: float
    cosine: float
    skew: float

    @property
    def trouble(self) -> str:
        """Why the point may be none of the branch, "" if it is one."""
        if self.cosine < COSINE or self.off > FARTHEST * AIM:
            return "the branch bends too sharply"
        return "the step does not follow the branch" if self.skew > SKEW else ""

    @property
    def same(self) -> bool:
        """Whether the point is where the branch was going."""
        return not self.trouble

    @property
    def sharp(self) -> bool:
        """Whether it bends so that another branch may have been met, which crosses this one."""
        return self.cosine < STRAIGHT or self.skew > EVEN

    @property
    def growth(self) -> float:
        """Factor of the next step."""
        return float(np.sqrt(min(AIM / max(self.off, 1e-12), WANTED_SKEW / max(self.skew, 1e-12))))


def leaving(equations: Equations[S], point: Point[S], expected: Array) -> Leaving:
    """Return the coordinates of a point and of expected unknowns (n + k,), in its layout."""
    parts = (point.unknowns, point.tangent, expected)
    return Leaving(*(equations.reduced(point.solution, part) for part in parts))


def joined(left: Leaving, there: Array, tangent: Array, metric: Metric) -> Course:
    """Return how the step to a point with coordinates and tangent (m,) went."""
    way, mean = there - left.here, left.tangent + tangent
    length, size = metric.length(way), metric.length(mean)
    skew = metric.length(way / length - mean / size) if length and size else 0.0
    return Course(
        off=metric.length(there - left.expected),
        cosine=metric.product(left.tangent, tangent),
        skew=skew,
    )
