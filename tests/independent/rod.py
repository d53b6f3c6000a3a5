"""Laws and one step of DOP853 along a ribbon without loads, for any number of steps at a time.

Vectors are lab-frame columns (3, ...), frames (3, 3, ...) hold d1, d2, d3 in their rows; trailing
axes are steps that know nothing of each other. Units Dw = L = 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.integrate._ivp import dop853_coefficients as dop853

Array = NDArray[np.float64]

TINY = 1e-300
STAGES = dop853.N_STAGES


@dataclass(frozen=True)
class Law:
    """A law: kirchhoff (B2, B3), sadowsky, regularized (epsilon) or variational (delta).

    Sadowsky's and the regularized law are taken by sheets: a kind +1 or -1 is the sign of m2 of a
    phase, beyond which the law goes on analytically. Kind 0 is a mixture (Sadowsky only).
    """

    name: str
    number: float = 0.0
    stiffness: tuple[float, float] = (1.0, 2.0)

    @property
    def switched(self) -> bool:
        """Whether it has a jump or a kink at m2 = 0."""
        return self.name in ("sadowsky", "regularized")

    def strains(self, kind: Array, m: Array, n: Array) -> tuple[Array, Array]:
        """Strains (u2, u3) at moments m and forces n (3, ...) along the directors."""
        m2, m3 = m[1], m[2]
        if self.name == "kirchhoff":
            return m2 / self.stiffness[0], m3 / self.stiffness[1]
        M = np.hypot(m2, m3) + TINY
        if self.name == "variational":
            d = self.number
            q = np.hypot(m2, d * m3) + TINY
            both = (q + M) / 4
            return both * (m2 / q + m2 / M), both * (d * (d * m3 / q) + m3 / M)
        a = kind * m2  # mu
        if self.name == "regularized":
            # A little beyond its phase it has a pole, which Newton's method must not meet.
            a = np.where(a > -0.1 * self.number * np.abs(m3), a, np.abs(m2))
        far = M + np.abs(a)
        p = np.where(a >= 0, far, m3 * (m3 / far))  # mu + M
        u3 = m3 / M * p / 4
        if self.name == "regularized":
            return m2 / (2 * a + self.number * p) * p / M * p / 2, u3
        u2 = kind * p / M * p / 4
        mixed = kind == 0
        if mixed.any():
            u3 = np.where(mixed, m3 / 4, u3)
            K = np.where(mixed, stiffness(m, n), 1.0)
            u2 = np.where(mixed, n[1] * m3 / 2 / K, u2)
        return u2, u3

    def distance(self, kind: Array, m: Array, n: Array) -> Array:
        """How far the nearest singularity along s may be, to first order, or a rate's inverse."""
        u2, u3 = self.strains(kind, m, n)
        m2, m3 = m[1], m[2]
        rate2, rate3 = -n[0] - u3 * m[0], u2 * m[0]
        far = 1 / (np.hypot(u2, u3) + 1.0)
        if self.name == "kirchhoff":
            return far

        def near(value: Array, rate: Array) -> Array:
            return np.where(kind == 0, far, np.minimum(far, value / (rate + TINY)))

        far = near(np.hypot(m2, m3), np.hypot(rate2, rate3))
        d = self.number
        if self.name == "variational":
            far = near(np.hypot(m2, d * m3), np.hypot(rate2, d * rate3))
        elif self.name == "regularized":
            far = near(np.abs(m2) + d * np.abs(m3) / 2, np.hypot(rate2, d * rate3 / 2))
        if self.name != "sadowsky":
            # Where m2 stays small, near a mixture, m2'' = K u2: as stiff as the law is sharp.
            small = np.stack([m[0], np.abs(m2) + 1e-9 * np.abs(m3) + TINY, m3])
            stiff = np.abs(stiffness(m, n)) * self.strains(kind**2, small, n)[0] / small[1]
            far = np.minimum(far, 1.5 / np.sqrt(stiff + TINY))
        return far


def stiffness(m: Array, n: Array) -> Array:
    """K = n3 + m3 u3 - m1^2 / 4 of a mixture."""
    return n[2] + m[2] ** 2 / 4 - m[0] ** 2 / 4


def dot(a: Array, b: Array) -> Array:
    """Scalar products of vectors (3, ...)."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Array, b: Array) -> Array:
    """Vector products of vectors (3, ...)."""
    return np.stack(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


def along(frame: Array, v: Array) -> Array:
    """Components along the directors."""
    return np.stack([dot(d, v) for d in frame])


def rates(law: Law, kind: Array, n: Array, m: Array, y: Array) -> Array:
    """Rates of y (13, ...): way r gone, d1, d2, d3, energy; m is the moment where r = 0."""
    d1, d2, d3 = y[3:6], y[6:9], y[9:12]
    moment = m + cross(n, y[:3])
    frame = (d1, d2, d3)
    mixed = not kind.all()
    own = np.stack([dot(d1, moment) if mixed else 0 * y[0], dot(d2, moment), dot(d3, moment)])
    u2, u3 = law.strains(kind, own, along(np.stack(frame), n) if mixed else n)
    out = np.empty_like(y)
    out[:3] = d3
    out[3:6] = u3 * d2 - u2 * d3  # (A 1): d' = u x d
    out[6:9] = -u3 * d1
    out[9:12] = u2 * d1
    out[12] = (own[1] * u2 + own[2] * u3) / 2  # W = m . u / 2: homogeneous of degree two
    return out


def step(
    law: Law, kind: Array, n: Array, m: Array, frame: Array, h: Array
) -> tuple[Array, Array, Array]:
    """One step of length h: way gone (3, ...), frame at its end, energy."""
    shape = np.broadcast_shapes(m.shape[1:], frame.shape[2:], h.shape)
    y = np.zeros((13, *shape))
    y[3:12] = frame.reshape(9, *frame.shape[2:])
    n = np.broadcast_to(n.reshape(3, *[1] * (len(shape) + 1 - n.ndim), *n.shape[1:]), (3, *shape))
    m = np.broadcast_to(m, (3, *shape))
    k = np.empty((STAGES, *y.shape))
    for i in range(STAGES):
        at = y + h * np.tensordot(dop853.A[i, :i], k[:i], 1) if i else y
        k[i] = rates(law, kind, n, m, at)
    y = y + h * np.tensordot(dop853.B, k, 1)
    return y[:3], y[3:12].reshape(3, 3, *shape), y[12]


def shot(
    law: Law, n: Array, m0: Array, place: Array, frame: Array, length: float = 1.0
) -> Callable[[Array], tuple[Array, Array]]:
    """Places (k, 3) and frames (k, 3, 3) at arclengths (k,), integrated in one go."""

    def rate(_: float, y: Array) -> Array:
        kind = np.sign((m0 + np.cross(n, y[:3])) @ y[6:9]) or 1.0
        return rates(law, np.array(kind), n, m0, y)

    y = np.concatenate([np.zeros(3), np.ravel(frame), [0.0]])
    path = solve_ivp(rate, (0, length), y, "DOP853", rtol=2.3e-14, atol=1e-14, dense_output=True)

    def start(s: Array) -> tuple[Array, Array]:
        y = path.sol(np.asarray(s))
        return place + y[:3].T, np.moveaxis(y[3:12].reshape(3, 3, -1), 2, 0)

    return start
