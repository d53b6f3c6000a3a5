"""A quadratic form along a chain of elements, each a step from the state before to that behind.

The form is sum_e (x_e, y_e) Q_e (x_e, y_e) / 2 and a form of both ends, under x_{e+1} = A_e x_e +
B_e y_e and conditions C (x_0, x_N) = 0; independent are x_0 and all y.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass


@dataclass(frozen=True, eq=False)
class ChainForm:
    """A quadratic form of N elements with nx states and m own variables each, and its metric.

    Attributes
    ----------
    Q : (N, nx + m, nx + m) array
        Hessians of the elements.
    A, B : (N, nx, nx), (N, nx, m) arrays
        The states behind an element.
    ends : (2 nx, 2 nx) array
        Hessian in (x_0, x_N).
    C : (k, 2 nx) array
        Independent conditions on (x_0, x_N).
    mass : (m,) array
        The metric is |x_0|^2 + sum_e mass . y_e^2.
    """

    Q: Array
    A: Array
    B: Array
    ends: Array
    C: Array
    mass: Array

    def gauged(self, number: float) -> ChainForm:
        """Return the same form, `number` |x|^2 / 2 at every node passed on to the next element."""
        nx = self.A.shape[1]
        step = np.concatenate([self.A, self.B], axis=2)
        Q = self.Q + number * step.swapaxes(1, 2) @ step
        Q[:, :nx, :nx] -= number * np.eye(nx)
        ends = self.ends + number * np.diag(np.repeat([1.0, -1.0], nx))
        return replace(self, Q=Q, ends=ends)

    def nodes(self, x0: Array, y: Array) -> Array:
        """States (N + 1, nx) from x_0 and the own variables (N, m)."""
        x, moved = np.empty((len(y) + 1, len(x0))), (self.B @ y[..., None])[..., 0]
        x[0] = x0
        for e, A in enumerate(self.A):
            x[e + 1] = A @ x[e] + moved[e]
        return x

    def times(self, x0: Array, y: Array) -> tuple[Array, Array]:
        """Product (nx,), (N, m) of the form, without its conditions, and independent variables."""
        x, nx = self.nodes(x0, y), len(x0)
        along = (self.Q @ np.concatenate([x[:-1], y], axis=1)[..., None])[..., 0]
        first, last = np.split(self.ends @ np.concatenate([x[0], x[-1]]), 2)
        behind = np.empty_like(x)
        behind[-1] = last
        for e in reversed(range(len(y))):
            behind[e] = along[e, :nx] + behind[e + 1] @ self.A[e]
        return behind[0] + first, along[:, nx:] + (behind[1:, None] @ self.B)[:, 0]
