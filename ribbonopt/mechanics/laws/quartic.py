"""Ribbons that stretch across: a rod whose energy has a quartic term, and its inverse.

    W(a, b) = B2 a^2 / 2 + B3 b^2 / 2 + q^2 phi(a) / 4,    q = p a^2 + b^2,

a being bending and b twist, phi even and positive, falling as 2 / a^2. With A the derivative of W
along a and B along b,

    A = B2 a + p q a phi + q^2 phi' / 4,    B = (B3 + p a^2 phi) b + phi b^3,

so that B gives the twist at a given bending in closed form, and A = m2 is one equation in a. At a
given m3 it falls with a > 0 at most once, and then rises; it falls where |m3| is beyond `limit`:
there W is not convex at a = 0, and a leaps where m2 changes sign.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import casadi as ca

from ribbonopt.classes import dataclass

from .relations import Components

Number = ca.SX | float
Values = tuple[ca.SX, ca.SX, ca.SX]  # phi, phi', phi''

STEPS = 4  # of Newton's method
CUBIC = 3  # steps of the same for the cubic that it begins with
QUANTUM = 2.0**-40  # to which their result is known, before the last two steps
TINY = 1e-300


@dataclass(frozen=True)
class Stiffening:
    """The function phi of a quartic law.

    `values` returns phi, phi' and phi'' at a; `series` are its coefficients of 1, a^2 and a^4, good
    for a first guess up to |a| = `reach`.
    """

    values: Callable[[ca.SX], Values]
    series: tuple[float, float, float]
    reach: float


class Slopes(NamedTuple):
    """A and B, and their derivatives along a and b."""

    A: ca.SX
    B: ca.SX
    Aa: ca.SX
    Ab: ca.SX
    Bb: ca.SX


@dataclass(frozen=True, eq=False)
class Quartic:
    """The energy W(a, b) of the module: its numbers and its phi."""

    B2: Number
    B3: Number
    p: Number
    phi: Stiffening

    def energy(self, a: ca.SX, b: ca.SX) -> ca.SX:
        """Return W(a, b)."""
        phi, _, _ = self.phi.values(a)
        q = self.p * a**2 + b**2
        return (self.B2 * a**2 + self.B3 * b**2 + q**2 * phi / 2) / 2

    def moments(self, a: ca.SX, b: ca.SX) -> Components:
        """Return A and B."""
        A, B, *_ = self._slopes(a, b, self.phi.values(a))
        return A, B

    def _slopes(self, a: ca.SX, b: ca.SX, values: Values) -> Slopes:
        """Return A and B with their derivatives; `values` are those of phi at a."""
        (phi, phi1, phi2), p = values, self.p
        q, stiff = p * a**2 + b**2, self.B3 + p * a**2 * phi
        return Slopes(
            A=self.B2 * a + q * (p * a * phi + q * phi1 / 4),
            B=b * (stiff + b**2 * phi),
            Aa=self.B2 + 2 * (p * a) ** 2 * phi + q * (p * phi + 2 * p * a * phi1 + q * phi2 / 4),
            Ab=b * (2 * p * a * phi + q * phi1),
            Bb=stiff + 3 * b**2 * phi,
        )

    def _twist(self, a: Number, m3: ca.SX, phi: Number) -> ca.SX:
        """Return b at a given bending, and phi there: the one root of B = m3."""
        stiff = self.B3 + self.p * a**2 * phi
        scale = ca.sqrt(3 * phi / stiff)
        return 2 * ca.sinh(ca.asinh(1.5 * m3 / stiff * scale) / 3) / scale

    @property
    def limit(self) -> tuple[Number, Number]:
        """Twist and twisting moment at which W ceases to be convex at a = 0.

        There B2 + 2 p c0 b^2 / 2 + 2 c1 b^4 / 4 = 0, c being the coefficients of phi.
        """
        c0, c1, _ = self.phi.series
        x = 2 * self.B2 / (ca.sqrt((self.p * c0) ** 2 - 2 * c1 * self.B2) - self.p * c0)
        b = ca.sqrt(x)
        return b, b * (self.B3 + c0 * x)

    def inverse(self, m2: ca.SX, m3: ca.SX, side: int = 0) -> Components:
        """Return a and b at given moments: the steps are written once, then copied.

        Of a `side` (+1, -1) those with a on it, beyond m2 = 0 too where a leaps.

        Newton's method finds them to `QUANTUM`. From there it takes two steps with one matrix, and
        only these are differentiated: first and second derivatives are then exact, as those of the
        first step are in A and B, and those of the second in their first and second derivatives.
        """
        a, b = _inverse(self.phi, side)(self.B2, self.B3, self.p, m2, m3)
        return a, b

    def steps(self, m2: ca.SX, m3: ca.SX, side: int) -> Components:
        """Return the same, written anew."""
        a0, b0 = (_held(value) for value in self._near(m2, m3, side))
        at = self._slopes(a0, b0, self.phi.values(a0))
        det = _nonzero(at.Aa * at.Bb - at.Ab**2)
        d2, d3 = m2 - at.A, m3 - at.B
        a, b = a0 + (at.Bb * d2 - at.Ab * d3) / det, b0 + (at.Aa * d3 - at.Ab * d2) / det
        A, B = self.moments(a, b)
        d2, d3 = m2 - A, m3 - B
        return a + (at.Bb * d2 - at.Ab * d3) / det, b + (at.Aa * d3 - at.Ab * d2) / det

    def _near(self, m2: ca.SX, m3: ca.SX, side: int) -> Components:
        """Return a and b at moments, nearly; derivatives are of no use.

        The root in a > 0 of A(a, b(a)) = x is where this rises, below `high`.
        """
        own = ca.if_else(m2 < 0, -1, 1)
        sign = ca.if_else(ca.fabs(m3) > self.limit[1], side, own) if side else own
        x, low = sign * m2, ca.SX(0)
        high = ca.fabs(m2) / self.B2 + ca.fabs(m3) / (2 * self.B2**0.75)
        small, large = self._cubic(x, m3), self._homogeneous(x, m3)
        a = ca.fmin(ca.if_else(small < self.phi.reach, small, large), high)
        for _ in range(STEPS):
            values = self.phi.values(a)
            twist = self._twist(a, m3, values[0])
            at = self._slopes(a, twist, values)
            excess, slope = at.A - x, at.Aa - at.Ab**2 / at.Bb
            above = ca.logic_and(excess > 0, slope > 0)
            low, high = ca.if_else(above, low, a), ca.if_else(above, a, high)
            step = a - excess / _nonzero(slope)
            inside = ca.logic_and(slope > 0, ca.logic_and(step >= low, step <= high))
            next_ = ca.if_else(inside, step, (low + high) / 2)
            a, twist = next_, twist - at.Ab / at.Bb * (next_ - a)
        # What follows squares the error of a and of b: along the tangent will do for b.
        return sign * a, twist

    def _homogeneous(self, x: ca.SX, m3: ca.SX) -> ca.SX:
        """Return about the a of large moments, where phi = 2 / a^2; Sadowsky's if that is the law.

        It is that of m3 = 0, x / c, and of x = 0, where c a^4 = b^4 and m3 = (d + 2 sqrt(c)) b.
        """
        c, d = self.B2 + self.p**2, self.B3 + 2 * self.p
        y = 4 * m3 / ((d + 2 * ca.sqrt(c)) * ca.sqrt(ca.sqrt(c)))
        size = ca.sqrt((x / c) ** 2 + y**2) + TINY
        return (size + x / c) ** 2 / (4 * size)

    def _cubic(self, x: ca.SX, m3: ca.SX) -> ca.SX:
        """Return the largest a at which A(a, b(a)) = x for its first two terms, k a + c a^3.

        Infinite where c < 0. Newton's method from above: k a + c a^3 is convex.
        """
        (c0, c1, c2), p = self.phi.series, self.p
        y = self._twist(0.0, m3, c0) ** 2
        k = self.B2 + y * (p * c0 + y * c1 / 2)
        c = c0 * p**2 + y * (2 * p * c1 + y * c2)
        c -= 2 * y * (p * c0 + y * c1) ** 2 / (self.B3 + 3 * c0 * y)
        safe = ca.if_else(c > 0, c, 1)
        root = ca.sign(x) * ca.exp(ca.log((ca.fabs(x) + TINY) / safe) / 3)
        a = ca.if_else(k > 0, ca.fmin(root, x / _nonzero(k)), ca.sqrt(ca.fmax(-k, 0) / safe) + root)
        a = ca.fmax(a, 0)
        for _ in range(CUBIC):
            a = (2 * safe * a**3 + x) / _nonzero(3 * safe * a**2 + k)
        return ca.if_else(ca.logic_and(c > 0, a >= 0), a, ca.inf)


@cache
def _inverse(phi: Stiffening, side: int) -> ca.Function:
    """Return a and b as a function of B2, B3, p, m2 and m3."""
    symbols = B2, B3, p, m2, m3 = [ca.SX.sym(name) for name in ("B2", "B3", "p", "m2", "m3")]
    return ca.Function("inverse", symbols, Quartic(B2, B3, p, phi).steps(m2, m3, side))


def _held(value: ca.SX) -> ca.SX:
    """Return a value to `QUANTUM`, odd in it, without derivatives: those of steps, zero."""
    return ca.sign(value) * ca.floor(ca.fabs(value) / QUANTUM) * QUANTUM


def _nonzero(value: ca.SX) -> ca.SX:
    return ca.if_else(value == 0, TINY, value)
