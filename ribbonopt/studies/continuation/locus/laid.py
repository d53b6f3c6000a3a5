"""What is known of a point of a locus beside its solution; kept with its trajectory."""

from __future__ import annotations

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass


@dataclass(frozen=True, eq=False)
class Laid:
    """How a locus lies on the surface of equilibria at one of its points.

    Attributes
    ----------
    tangent : (n + 2,) array
        Along the locus, of unit length in the metric of the point.
    across : (n + 2,) array
        Tangent to the surface, across the locus.
    slope : float
        Derivative of the test function across.
    sides : pair of (n + 2,) arrays or None
        Equilibria on both sides of the locus, across; None where that is not known.
    error : float or None
        Bound of the error of l1; None where it is not known.
    doubt : float
        What of that error no finer scheme tells, as it comes from interpolation.
    scale : float
        Logarithm of what the test function is relative to.
    negative : int or None
        Negative directions beside; None where they are not counted.
    """

    tangent: Array
    across: Array
    slope: float = 1.0
    sides: tuple[Array, Array] | None = None
    error: float | None = None
    doubt: float = 0.0
    scale: float = 0.0
    negative: int | None = None
