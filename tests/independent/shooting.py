"""Shooting: Newton's method for what is unknown at the start of a ribbon."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from .path import rotation
from .rod import Array

DIFFERENCE = 1e-7
MOST = 40


@dataclass
class Shooting:
    """Newton's method for what is unknown at the start of a ribbon.

    `equations` takes unknowns (n, k) and returns residuals (n, k).
    """

    equations: Callable[[Array], Array]
    steps: list[float] = field(default_factory=list)
    slopes: Array = field(default_factory=lambda: np.empty((0, 0)))

    def solve(self, y: Sequence[float] | Array, tolerance: float = 1e-13) -> Array:
        """Return the unknowns (n,); ArithmeticError if there are none near."""
        y = np.asarray(y, float)
        residual = self._linearised(y)
        for _ in range(MOST):
            change = np.linalg.solve(self.slopes, -residual)
            size = float(np.abs(change / (1 + np.abs(y).max())).max())
            if self.steps and size < 1e-9 and size >= self.steps[-1] / 4:
                return y  # rounding
            self.steps.append(size)
            share = 1.0
            while True:
                try:
                    after = self._linearised(y + share * change)
                    if size < 1e-6 or np.linalg.norm(after) < np.linalg.norm(residual):
                        break
                except (ArithmeticError, ValueError, np.linalg.LinAlgError):
                    pass
                share /= 2
                if share < 1e-3:
                    raise ArithmeticError(f"Newton's method is stuck, residual {residual}")
            y, residual = y + share * change, after
            if size < tolerance:
                return y
        raise ArithmeticError(f"Newton's method did not converge: last steps {self.steps[-3:]}")

    def _linearised(self, y: Array) -> Array:
        eta = DIFFERENCE * (1 + np.abs(y))
        found = self.equations(np.column_stack([y, y[:, None] + np.diag(eta)]))
        if not np.isfinite(found).all():
            raise ArithmeticError("numbers that are not finite")
        self.slopes = (found[:, 1:] - found[:, :1]) / eta
        return found[:, 0]


def held(y: Array, place: Array, frame: Array) -> Array:
    """Residuals (6, k) of a clamp at a place (3,) with a frame (3, 3)."""
    here = y[3:12].reshape(3, 3, -1)
    there = np.broadcast_to(np.asarray(frame)[:, :, None], here.shape)
    return np.concatenate([y[:3] - np.reshape(place, (3, 1)), rotation(here, there)])
