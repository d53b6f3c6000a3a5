"""The extensible ribbon, RIBEXT of Audoly and Neukirch: a strip of finite width and thickness.

In units k* = h / (w^2 sqrt(12 (1 - nu^2))) of strains, a = u2 / k* and b = u3 / k*,

    W / (Dw k*^2) = (1 - nu^2) a^2 / 2 + (1 - nu) b^2 + (nu a^2 + b^2)^2 phi(a) / 4,

phi being what is left of the stretching of a strip that bends across too: with s = sqrt(|a| / 2)

    phi = (1/2 - R / s) / s^4,    R = (cosh s - cos s) / (sinh s + sin s).

A rod for k* -> infinity, Sadowsky's ribbon for k* -> 0.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import factorial

import casadi as ca

from ribbonopt.classes import dataclass

from .quartic import Quartic, Stiffening
from .quartic_law import QuarticLaw

TERMS = 14  # of the series of phi in a^2, whose radius is |a| = 22.4
SERIES = 6.0  # |a| below which it is used: beyond, few digits cancel


@dataclass(frozen=True, eq=False)
class ExtensibleLaw(QuarticLaw):
    """A ribbon of a width and a thickness, in units of L, and Poisson's ratio."""

    width: ca.SX
    thickness: ca.SX
    poisson_ratio: ca.SX

    @property
    def unit(self) -> ca.SX:
        """The strain k*."""
        return self.thickness / (self.width**2 * ca.sqrt(12 * (1 - self.poisson_ratio**2)))

    @property
    def quartic(self) -> Quartic:
        nu = self.poisson_ratio
        return Quartic(1 - nu**2, 2 * (1 - nu), nu, PHI)

    def at_width(self, width: ca.SX) -> ExtensibleLaw:
        return replace(self, width=self.width * width)


def coefficients(count: int) -> tuple[float, ...]:
    """Return coefficients of 1, a^2, a^4, ... of phi.

    With R / s = 1/2 - phi s^4 = sum of r_k s^4k, from (sinh s + sin s) R = cosh s - cos s.
    """
    r: list[Fraction] = []
    for k in range(count + 1):
        known = (r[j] / factorial(4 * (k - j) + 1) for j in range(k))
        r.append(Fraction(1, factorial(4 * k + 2)) - sum(known, Fraction(0)))
    return tuple(float(-c / 4**k) for k, c in enumerate(r[1:]))


COEFFICIENTS = coefficients(TERMS)


def phi(a: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Return phi, phi' and phi'': by the series near 0, else without overflow.

    R' = 1 - R Q, Q' = T - Q^2 with Q = (cosh s + cos s) / D, T = (sinh s - sin s) / D and
    D = sinh s + sin s; all are multiplied by 2 exp(-s).
    """
    near = ca.fabs(a) < SERIES
    s = ca.sqrt(ca.if_else(near, SERIES, ca.fabs(a)) / 2)
    E = ca.exp(-s)
    cos, sin, square = 2 * E * ca.cos(s), 2 * E * ca.sin(s), E**2
    D = 1 - square + sin
    R, Q, T = (1 + square - cos) / D, (1 + square + cos) / D, (1 - square - sin) / D
    R1 = 1 - R * Q
    R2 = R * (Q**2 - T) - R1 * Q
    # f = 1/2 - R / s and its derivatives along s, then those of f / s^4, then along a = 2 s^2.
    f = 0.5 - R / s
    f1 = (R / s - R1) / s
    f2 = ((R1 - R / s) * 2 / s - R2) / s
    g, g1, g2 = f, f1 - 4 * f / s, f2 - 8 * f1 / s + 20 * f / s**2
    far = [g, g1 / (4 * s) * ca.sign(a), (g2 - g1 / s) / (16 * s**2)]
    x = ca.if_else(near, a, 0)
    close = [_polynomial(c, x**2) for c in _derived(COEFFICIENTS)]
    close[1] *= x
    values = (ca.if_else(near, c, v / s**4) for c, v in zip(close, far, strict=True))
    first, second, third = values
    return first, second, third


def _derived(c: tuple[float, ...]) -> tuple[tuple[float, ...], ...]:
    """Return coefficients in a^2 of phi, phi' / a and phi''."""
    first = tuple(2 * k * v for k, v in enumerate(c))[1:]
    return c, first, tuple((2 * k + 1) * v for k, v in enumerate(first))


def _polynomial(c: tuple[float, ...], x: ca.SX) -> ca.SX:
    value = ca.SX(c[-1])
    for coefficient in reversed(c[:-1]):
        value = value * x + coefficient
    return value


PHI = Stiffening(phi, (COEFFICIENTS[0], COEFFICIENTS[1], COEFFICIENTS[2]), reach=15.0)
