"""Smooth laws of ribbons that may stretch, typed anew: extensible (RIBEXT), and Sano's and Wada's.

In strains over a unit, a = u2 / k and b = u3 / k, both have the energy over k^2
alpha a^2 / 2 + beta b^2 / 2 + (nu a^2 + b^2)^2 phi(a) / 4, where phi is even in a.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial

import numpy as np

from .rod import Array

TERMS = 14
FAR = 400.0  # of s^4: series below it, all of whose terms are positive, exponentials above
IMAGINARY = 1e-30
OFTEN = 200


def of_boundary_layers(a: Array) -> Array:
    """Phi of RIBEXT: (1/2 - (cosh s - cos s) / (s (sinh s + sin s))) / s^4, s^2 = |a| / 2.

    As a quotient of series in x = s^4 nothing cancels.
    """
    x = a * a / 4
    near = np.where(x.real < FAR, x, 1)
    above, below = 0 * near, 0 * near
    for k in reversed(range(TERMS)):
        above = above * near + 2 * (k + 1) / factorial(4 * k + 6)
        below = below * near + 1 / factorial(4 * k + 1)
    far = np.where(x.real < FAR, FAR, x)
    s = np.sqrt(np.sqrt(far))
    small = np.exp(-s)
    ratio = (1 - 2 * small * np.cos(s) + small**2) / (s * (1 + 2 * small * np.sin(s) - small**2))
    return np.where(x.real < FAR, above / below, (0.5 - ratio) / far)


@dataclass(frozen=True)
class Plate:
    """Numbers of the energy; `softening`: c of phi = 2 / (c + a^2), else that of RIBEXT."""

    unit: float
    alpha: float
    beta: float
    nu: float = 0.0
    softening: float | None = None

    def phi(self, a: Array) -> Array:
        """Return phi (...)."""
        if self.softening is None:
            return of_boundary_layers(a)
        return 2 / (self.softening + a * a)

    def slope(self, a: Array, b: Array) -> tuple[Array, Array]:
        """Moments over the unit, at strains over the unit (...): derivatives of the energy."""
        moved = self.phi(a + 1j * IMAGINARY)
        phi, slope = moved.real, moved.imag / IMAGINARY
        q = self.nu * a**2 + b**2
        return self.alpha * a + self.nu * a * q * phi + q**2 * slope / 4, b * (self.beta + q * phi)

    def energy(self, a: Array, b: Array) -> Array:
        """Energy over the unit squared (...)."""
        q = self.nu * a**2 + b**2
        return (self.alpha * a**2 + self.beta * b**2) / 2 + q**2 * self.phi(a) / 4

    def twist(self, a: Array, m3: Array) -> Array:
        """Strain b of a moment m3 >= 0 over the unit at a: Newton's method falls to it."""
        phi = self.phi(a)
        P = self.beta + self.nu * a**2 * phi
        b = np.minimum(m3 / P, np.cbrt(m3 / phi))
        for _ in range(OFTEN):
            after = (m3 + 2 * phi * b**3) / (P + 3 * phi * b**2)
            near = np.abs(after - b) <= 1e-9 * b  # the next step is beyond rounding
            b = after
            if near.all():
                break
        return b

    def strains(self, m2: Array, m3: Array) -> tuple[Array, Array]:
        """Strains u2 and u3 (k,) at moments (k,): Newton's method, kept between bounds."""
        up, side = np.abs(m2) / self.unit, np.abs(m3) / self.unit
        low, high = np.zeros_like(up), up / self.alpha + side + 1e-300
        most = high
        M = np.hypot(up, side)
        a = np.clip((M + up) ** 2 / (4 * M + 1e-300), 1e-3 * high, high)
        for _ in range(OFTEN):
            b = self.twist(a, side)
            gap = self.slope(a, b)[0] - up
            eta = 1e-6 * (a + 1e-8)
            steep = (self.slope(a + eta, self.twist(a + eta, side))[0] - up - gap) / eta
            low, high = np.where(gap < 0, a, low), np.where(gap < 0, high, a)
            with np.errstate(all="ignore"):
                after = a - gap / steep
            inside = (after >= low) & (after <= high) & (steep > 0)
            after = np.where(inside, after, (low + high) / 2)
            near = np.abs(after - a) <= 1e-11 * a + 1e-17 * most
            a = after
            if near.all():
                break
        b = self.twist(a, side)
        return self.unit * np.copysign(a, m2), self.unit * np.copysign(b, m3)

    def mixed(self, m3: Array) -> tuple[Array, Array, Array]:
        """Return u3, du3/dm3 and the energy (k,) of a mixture of both sides, where m2 = 0.

        Both have the same u3 and energy there, and opposite u2.
        """
        h = 1e-5 * np.abs(m3)
        none = 1e-200 * self.unit * np.ones_like(m3)
        u2, u3 = self.strains(none, m3)
        at = [self.strains(none, m3 + i * h)[1] for i in (-2, -1, 1, 2)]
        slope = (at[0] - 8 * at[1] + 8 * at[2] - at[3]) / (12 * h)
        return u3, slope, self.unit**2 * self.energy(u2 / self.unit, u3 / self.unit)


def extensible(width: float, thickness: float, ratio: float) -> Plate:
    """RIBEXT of a width and a thickness (units of L) and Poisson's ratio."""
    unit = thickness / (width**2 * np.sqrt(12 * (1 - ratio**2)))
    return Plate(unit, 1 - ratio**2, 2 * (1 - ratio), ratio)


def sano(B2: float, B3: float, zeta: float) -> Plate:
    """Sano's and Wada's: W = (B2 u2^2 + B3 u3^2 + u3^4 / (1 / zeta^2 + u2^2)) / 2."""
    return Plate(1.0, B2, B3, 0.0, 1 / zeta**2)
