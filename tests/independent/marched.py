"""Order 8 in equal steps along an arclength, for numbers that may be complex: exact slopes.

What is integrated is analytic, so that a state with an imaginary part of 1e-30 carries the solution
of the linearised equations there, to rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate._ivp import dop853_coefficients as dop853

#: real or complex
Numbers = NDArray[Any]
Rates = Callable[[float, Numbers], Numbers]

#: imaginary parts that are slopes
TINY = 1e-30


def marched(rates: Rates, y: Numbers, ends: tuple[float, float], steps: int) -> Numbers:
    """State (n, ...) at the second of two arclengths from that at the first."""
    s, h = ends[0], (ends[1] - ends[0]) / steps
    stages = dop853.N_STAGES
    k = np.empty((stages, *y.shape), y.dtype)
    for j in range(steps):
        s = ends[0] + j * h
        for i in range(stages):
            at = y + h * np.tensordot(dop853.A[i, :i], k[:i], 1) if i else y
            k[i] = rates(s + dop853.C[i] * h, at)
        y = y + h * np.tensordot(dop853.B, k, 1)
    return y


def newton(
    equations: Callable[[Numbers], Numbers],
    y: Numbers,
    slopes: Callable[[Numbers], Numbers] | None = None,
    size: float = 1e-13,
    most: int = 60,
) -> Numbers:
    """Root (n,) of equations (n,) -> (n,); slopes by central differences where none are given."""
    y = np.asarray(y, float)
    best = np.inf
    for _ in range(most):
        J = slopes(y) if slopes else differences(equations, y)
        change = np.linalg.solve(J, -equations(y))
        rate = float(np.abs(change).max() / (1 + np.abs(y).max()))
        y = y + change * min(1.0, 0.3 / rate)
        if rate < size or (rate < 1e-10 and rate >= best):
            return y
        best = min(best, rate)
    raise ArithmeticError(f"Newton's method did not converge: last step {rate:.1e}")


def differences(equations: Callable[[Numbers], Numbers], y: Numbers) -> Numbers:
    """Slopes (n, n) by central differences."""
    columns = []
    for i in range(len(y)):
        eta = 1e-6 * (1 + abs(y[i]))
        up, down = y.copy(), y.copy()
        up[i] += eta
        down[i] -= eta
        columns.append((equations(up) - equations(down)) / (2 * eta))
    return np.stack(columns, axis=1)
