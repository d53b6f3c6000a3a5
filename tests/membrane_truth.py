"""Ribbons that give in their own plane, integrated by DOP853 with a rotation matrix.

The laws are written here again, as sums in m1, m2, m3; nothing of the package is used.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

Array = np.ndarray
Law = Callable[[float, float], tuple[float, float]]  # (m2, m3) to (u2, u3)


def rod(B2: float, B3: float) -> Law:
    return lambda m2, m3: (m2 / B2, m3 / B3)


def sheet(chi: int) -> Law:
    """One side of Sadowsky's law, beyond its end too."""

    def strains(m2: float, m3: float) -> tuple[float, float]:
        M = np.hypot(m2, m3)
        return chi * (M + chi * m2) ** 2 / (4 * M), m3 * (M + chi * m2) / (4 * M)

    return strains


def smoothed(delta: float) -> Law:
    """Gradient of (q + M)^2 / 8."""

    def strains(m2: float, m3: float) -> tuple[float, float]:
        M, q = np.hypot(m2, m3), np.hypot(m2, delta * m3)
        half = (M + q) / 4
        return half * (m2 / M + m2 / q), half * (m3 / M + delta**2 * m3 / q)

    return strains


class End(NamedTuple):
    """Where an integration got to."""

    s: float
    r: Array
    frame: Array
    n: Array
    m: Array

    def off(self, place: Array, frame: Array) -> float:
        return float(max(np.abs(self.r - place).max(), np.abs(self.frame - frame).max()))


def turned(u: Array) -> Array:
    x, y, z = u
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def integrated(
    laws: tuple[Law, ...],
    n: Array,
    m: Array,
    length: float = 1.0,
    *,
    B1: float = np.inf,
    EA: float = np.inf,
    force: Callable[[float], Array] = lambda s: np.zeros(3),
    frame: Array | None = None,
) -> End:
    """Integrate r' = (1 + e) R e3, R' = R [u], n' = -f, m' = n x r' from the origin.

    Each law is followed until m2 changes its sign, the last one to the end.
    """

    def rates(s: float, y: Array, law: Law) -> Array:
        R, load, moment = y[3:12].reshape(3, 3), y[12:15], y[15:18]
        (_, _, n3), (m1, m2, m3) = R.T @ load, R.T @ moment
        u = np.array([m1 / B1, *law(m2, m3)])
        along = (1 + n3 / EA) * R[:, 2]
        turn = R @ turned(u)
        return np.concatenate([along, turn.ravel(), -force(s), np.cross(load, along)])

    def bending(s: float, y: Array, law: Law) -> float:
        return float(y[15:18] @ y[3:12].reshape(3, 3)[:, 1])

    at, start = 0.0, np.eye(3) if frame is None else frame
    y = np.concatenate([np.zeros(3), start.ravel(), n, m])
    for i, law in enumerate(laws):
        more: dict[str, Any] = {}
        if i < len(laws) - 1:
            bending.terminal = True  # type: ignore[attr-defined]
            more = {"events": bending}
        found = solve_ivp(
            rates, (at, length), y, "DOP853", args=(law,), rtol=1e-13, atol=1e-13, **more
        )
        at, y = float(found.t[-1]), found.y[:, -1]
    return End(at, y[:3], y[3:12].reshape(3, 3), y[12:15], y[15:18])
