"""Folds and branch points of strips in a plane by shooting: clamps a chord apart, turned by angles.

theta is the angle of the tangent (sin theta, 0, cos theta), m the moment about y:
theta' = m / B + c, m' = n_z sin theta - n_x cos theta, n' = -f. Unknown: m(0), n(0). A
point is singular where the determinant of the three end values by the three unknowns vanishes;
where a reflection about the middle holds, that of the block which breaks it. Units Dw = L = 1,
angles in radians.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .marched import TINY, Numbers, marched, newton

STEPS = 100


@dataclass(frozen=True)
class Strip:
    """What is given: shortening d, angles a0, a1 that work against a bow to +x, and the rest.

    `weight` is a force per length along x, `curl` a natural curvature, `taper` the part of
    the width that is lost from end to end.
    """

    d: float = 0.1
    a0: float = 0.0
    a1: float = 0.0
    weight: float = 0.0
    curl: float = 0.0
    taper: float = 0.0
    steps: int = STEPS

    def rates(self, s: float, y: Numbers) -> Numbers:
        """Rates of x, z, theta, m, n_x, n_z."""
        out = np.zeros_like(y)
        sin, cos = np.sin(y[2]), np.cos(y[2])
        out[0], out[1] = sin, cos
        out[2] = y[3] / (1 - self.taper * s) + self.curl
        out[3] = y[5] * sin - y[4] * cos
        out[4] = -self.weight
        return out

    def end(self, p: Numbers, s: float = 1.0) -> Numbers:
        """State (6, ...) at s of what starts with m, n_x, n_z = p (3, ...)."""
        y = np.zeros((6, *p.shape[1:]), np.result_type(p, type(self.a0)))
        y[2] = -self.a0
        y[3:] = p
        return marched(self.rates, y, (0.0, s), max(2, round(s * self.steps)))

    def slopes(self, p: Numbers, s: float = 1.0) -> tuple[Numbers, Numbers]:
        """State (6,) at s, and its slopes (6, 3) by p."""
        y = self.end(np.reshape(p, (3, 1)) + 1j * TINY * np.eye(3), s)
        return y[:, 0].real, y.imag / TINY

    def equations(self, p: Numbers) -> tuple[Numbers, float]:
        """What is to vanish at the far end, and the determinant."""
        y, J = self.slopes(p)
        J = J[:3]
        return y[:3] - np.array([0.0, 1 - self.d, self.a1]), float(np.linalg.det(J))

    def solved(self, p: Numbers) -> Numbers:
        """Unknowns (3,) of the equilibrium near some."""
        return newton(
            lambda p: self.equations(p)[0], np.asarray(p, float), lambda p: self.slopes(p)[1][:3]
        )


def fold(strip: Strip, p: Numbers, turned: float, by: str = "a0") -> tuple[float, Numbers]:
    """Value of a quantity of the strip at its fold, and the unknowns there, from near ones."""

    def equations(q: Numbers) -> Numbers:
        values, determinant = replace(strip, **{by: float(q[3])}).equations(q[:3])
        return np.append(values, determinant)

    q = newton(equations, np.append(p, turned))
    return float(q[3]), q[:3]


def mirror(strip: Strip, m0: float, nz: float, a: float, which: str) -> tuple[float, Numbers]:
    """Angle of both clamps where the symmetric branch folds, or another crosses it: `which`."""

    def half(q: Numbers) -> tuple[Numbers, Numbers]:
        same = replace(strip, a0=float(q[2]), a1=float(q[2]))
        return same.slopes(np.array([q[0], 0.0, q[1]]), 0.5)

    def equations(q: Numbers) -> Numbers:
        y, J = half(q)
        block = J[np.ix_([1, 2], [0, 2])] if which == "fold" else J[np.ix_([0, 3], [0, 1])]
        return np.array([y[2], y[1] - (1 - strip.d) / 2, np.linalg.det(block)])

    q = newton(equations, np.array([m0, nz, a]))
    return float(q[2]), q[:2]
