"""Arclength: how far apart two points of a curve are, whatever their layouts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

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
        return float(np.linalg.norm(y / self.sizes))

    def product(self, a: Array, b: Array) -> float:
        """Scalar product of two differences."""
        return float((a / self.sizes) @ (b / self.sizes))

    def dual(self, y: Array) -> Array:
        """Row (m,) that gives the scalar product with y."""
        return y / self.sizes**2
