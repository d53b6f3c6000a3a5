"""Frequencies of small vibrations about an equilibrium by shooting: no energy, no mass matrix.

Equations of motion of r, directors, n, m (lab frame) at frequency omega, linearised by imaginary
parts (see `marched`): n' = -f - rho omega^2 dr, m' = n x d3 - omega^2 J_i (dphi . d_i) d_i. Start
clamped; omega is where the determinant of the six end values by n(0), m(0) vanishes. About states
in the plane of x and z, loaded in it, the determinant is a product of one in the plane and one out
of it. Units Dw = L = 1; rho = 1 per length where the width is one.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import brentq

from .marched import TINY, Numbers, marched, newton

STEPS = 80
#: rows and columns of what stays in the plane of x and z, and of what leaves it
IN_PLANE, OUT_OF_PLANE = [0, 2, 4], [1, 3, 5]


@dataclass(frozen=True)
class Ribbon:
    """A ribbon that starts at the origin, clamped; its end is clamped at a place, or free.

    `law` is (B2, B3) of a rod, or the number delta of the smooth law of ribbons. `weight` is a
    force per length where the width is one, and follows the width; `curl` a natural
    curvature; `taper` the part of the width lost from end to end; `inertia` (J1, J3) per length.
    """

    law: tuple[float, float] | float = (1.0, 2.0)
    start: Numbers = field(default_factory=lambda: np.eye(3))
    place: tuple[float, float, float] | None = None
    end: Numbers = field(default_factory=lambda: np.eye(3))
    tip: tuple[float, float, float] = (0.0, 0.0, 0.0)
    weight: tuple[float, float, float] = (0.0, 0.0, 0.0)
    weighted: bool = True
    curl: float = 0.0
    taper: float = 0.0
    inertia: tuple[float, float] = (0.0, 0.0)
    steps: int = STEPS

    def strains(self, m2: Numbers, m3: Numbers) -> tuple[Numbers, Numbers]:
        """Strains (u2, u3) at moments of the directors, of a width of one."""
        if isinstance(self.law, tuple):
            return m2 / self.law[0] + self.curl, m3 / self.law[1]
        d = self.law
        q, M = np.sqrt(m2**2 + d**2 * m3**2), np.sqrt(m2**2 + m3**2)
        u2, u3 = (q + M) / 4 * (m2 / q + m2 / M), (q + M) / 4 * (d**2 * m3 / q + m3 / M)
        return u2 + self.curl, u3

    def rates(self, s: float, y: Numbers, squared: Numbers) -> Numbers:
        """Rates of r, d1, d2, d3, n, m (18, ...) at squared frequencies."""
        d1, d2, d3, n, m = (y[i : i + 3] for i in (3, 6, 9, 12, 15))
        width = 1 - self.taper * s
        u2, u3 = self.strains((m * d2).sum(0) / width, (m * d3).sum(0) / width)
        out = np.empty_like(y)
        out[:3] = d3
        out[3:6] = u3 * d2 - u2 * d3
        out[6:9] = -u3 * d1
        out[9:12] = u2 * d1
        load = np.reshape(self.weight, (3, *[1] * (y.ndim - 1)))
        out[12:15] = -load * (width if self.weighted else 1.0) - 1j * squared * width * y[:3].imag
        out[15:] = np.cross(n, d3, axis=0)
        J1, J3 = self.inertia
        about3, about1 = (d1.imag * d2.real).sum(0), (d2.imag * d3.real).sum(0)
        out[15:] -= 1j * squared * (J3 * about3 * d3.real + J1 * about1 * d1.real)
        return out

    def shot(self, p: Numbers, squared: Numbers) -> tuple[Numbers, Numbers]:
        """End values (6,) at loads p (6,) of the start, and slopes (6, 6, k) at squares (k,)."""
        k = len(squared)
        y = np.zeros((18, 6, k), complex)
        y[3:12] = np.reshape(self.start, (9, 1, 1))
        y[12:] = np.reshape(p, (6, 1, 1)) + 1j * TINY * np.eye(6)[:, :, None]
        y = marched(lambda s, y: self.rates(s, y, squared), y, (0.0, 1.0), self.steps)
        if self.place is None:
            values = y[12:]
            held = np.concatenate([self.tip, np.zeros(3)])
        else:
            frame = np.reshape(self.end, (3, 3, 1, 1))
            turned = sum(np.cross(frame[i], y[3 + 3 * i : 6 + 3 * i], axis=0) for i in range(3)) / 2
            values = np.concatenate([y[:3], turned])
            held = np.concatenate([self.place, np.zeros(3)])
        return values[:, 0, 0].real - held, values.imag / TINY

    def solved(self, p: Numbers) -> Numbers:
        """Loads n(0), m(0) (6,) of the equilibrium near some."""
        still = np.zeros(1)
        return newton(
            lambda p: self.shot(p, still)[0], p, lambda p: self.shot(p, still)[1][:, :, 0]
        )

    def determinants(self, p: Numbers, squared: Numbers, part: list[int] | None = None) -> Numbers:
        """Determinants (k,) at squared frequencies (k,), of all or of a part, each of size one."""
        J = np.moveaxis(self.shot(p, np.atleast_1d(squared))[1], 2, 0)
        if part is not None:
            J = J[:, part][:, :, part]
        return np.linalg.det(J / np.abs(J).max((1, 2), keepdims=True))

    def frequencies(
        self, p: Numbers, most: float, part: list[int] | None = None, grid: int = 200
    ) -> Numbers:
        """Signed roots of squared frequencies, ascending, up to `most`.

        The grid is even in the frequency itself; two roots between neighbours are missed.
        """
        omega = np.linspace(-most / 4, most, grid)
        squared = omega * np.abs(omega)
        values = self.determinants(p, squared, part)
        places = np.flatnonzero(values[1:] * values[:-1] < 0)
        return np.array([self._between(p, squared[i], squared[i + 1], part) for i in places])

    def near(self, p: Numbers, omega: float, part: list[int] | None = None) -> float:
        """Signed root of the squared frequency within a millionth of a frequency."""
        ends = (omega * abs(omega) * (1 + x) for x in (-2e-6, 2e-6))
        return self._between(p, *ends, part)

    def _between(self, p: Numbers, low: float, high: float, part: list[int] | None) -> float:
        def determinant(x: float) -> float:
            return float(self.determinants(p, np.array([x]), part)[0])

        root = brentq(determinant, low, high, xtol=1e-9, rtol=1e-14)
        return float(np.sign(root) * np.sqrt(abs(root)))
