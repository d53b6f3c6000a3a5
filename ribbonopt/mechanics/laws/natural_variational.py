"""The smooth law with natural strains: |T| becomes q = sqrt(T^2 + delta^2 c^2).

    u2 = (q + R)/4 (T/q + D/R), u3 = (q + R)/4 (delta^2 c/q + c/R), W_Leg = (q + R)^2 / 8 - C:
one eighth of a squared norm of what is affine in the moments, so convex.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from .implicit import ImplicitLaw
from .law import RibbonLaw, Stress
from .natural import NaturalStrains
from .natural_sadowsky import NaturalSadowskyLaw, where_equal
from .natural_sides import WORDS, NaturalSides
from .parts import Singular, Switch
from .relations import Components, norm


@dataclass(frozen=True, eq=False)
class NaturalVariationalLaw(RibbonLaw):
    """See `variational`; delta -> 0 is Sadowsky's law with these natural strains."""

    delta: ca.SX
    k: NaturalStrains
    natural = True
    closed_moment = False
    switch_name = WORDS

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        T, D, c, R = self.k.combined(m2, m3)
        q = norm(T, self.delta * c)
        size = (q + R) / 4
        return size * (T / q + D / R), size * (self.delta**2 * c / q + c / R)

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        # For guesses only: those of the sharp law, of whose kinks this one is a blunt version.
        return NaturalSadowskyLaw(self.k).moments(u2, u3)

    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        m2, m3 = self.moments(u2, u3)
        return m2 * u2 + m3 * u3 - self.complementary(m2, m3)

    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        T, _, c, R = self.k.combined(m2, m3)
        return (norm(T, self.delta * c) + R) ** 2 / 8 - self.k.constant

    def implicit(self, stress: Stress) -> ImplicitLaw:
        """Return the equations for the strains and both norms, q and R from their squares."""
        z, (T, D, c, size) = ca.SX.sym("u", 4), self.k.combined(stress.m[1], stress.m[2])
        u2, u3, q, R = ca.vertsplit(z)
        size = size + ca.fabs(T)  # brings all equations to the size of the strains
        equations = ca.vertcat(
            (q**2 - T**2 - (self.delta * c) ** 2) / size,
            (R**2 - D**2 - c**2) / size,
            (4 * q * R * u2 - (q + R) * (T * R + D * q)) / size**2,
            (4 * q * R * u3 - c * (q + R) * (self.delta**2 * R + q)) / size**2,
        )
        estimate = ca.vertcat(self.strain(stress)[1:], norm(T, self.delta * c), norm(D, c))
        return ImplicitLaw(z, equations, ca.vertcat(-q, -R), estimate)

    def sheet_slope(self, stress: Stress, u: ca.SX) -> ca.SX:
        return self.k.slope(u[1], u[2])

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        T, _, c, _ = self.k.combined(stress.m[1], stress.m[2])
        equal = where_equal(self.k, stress)
        return equal, Singular(T, self.delta * c, equal.size)

    def switching(self, stress: Stress) -> Switch:
        return NaturalSides(self.k).switching(stress)
