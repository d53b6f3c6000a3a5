"""Arclength: how far apart two points of a curve are, whatever their layouts."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ribbonopt.arrays import Array


@dataclass(frozen=True, eq=False)
class Metric:
    """Arclength in the coordinates that `Equations.reduced` gives; the last is the position.

    Attributes
    ----------
    sizes : (m,) array
        Differences of the coordinates that count as one.
    """

    sizes: Array

    def length(self, y: Array) -> float:
        """Length of a difference (m,)."""
        scaled = y / self.sizes
        return math.sqrt(scaled @ scaled)

    def product(self, a: Array, b: Array) -> float:
        """Scalar product of two differences."""
        return float((a / self.sizes) @ (b / self.sizes))

    def dual(self, y: Array) -> Array:
        """Row (m,) that gives the scalar product with y."""
        return y / self.sizes**2
