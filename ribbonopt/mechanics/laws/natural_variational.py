"""The smooth law with natural strains: both |T| and R are blunted by delta.

    q = sqrt(T^2 + delta^2 (c^2 + 4 K22^2)), p = sqrt(D^2 + c^2 + 4 delta^2 K22^2),
    u2 = (q + p)/4 (T/q + D/p), u3 = (q + p)/4 (delta^2 c/q + c/p), W_Leg = (q + p)^2 / 8 - C:
one eighth of a squared norm of what is affine in the moments, so convex. Where K22 = 0 it is the
law without natural strains, shifted. Where not, strips that stay planar leap at T = 0 and at R = 0
(a fold of a tape spring ends there), of which this is smooth too.
"""

from __future__ import annotations

import casadi as ca

from ribbonopt.classes import dataclass

from .implicit import ImplicitLaw
from .law import ConstitutiveLaw, RibbonLaw, Stress
from .natural import NaturalStrains
from .natural_sadowsky import NaturalSadowskyLaw
from .natural_sides import WORDS, NaturalSides
from .parts import Singular, Switch
from .relations import GUARD, Components, norm


@dataclass(frozen=True, eq=False)
class NaturalVariationalLaw(RibbonLaw):
    """See `variational`; delta -> 0 is Sadowsky's law with these natural strains."""

    delta: ca.SX
    k: NaturalStrains
    natural = True
    closed_moment = False
    switch_name = WORDS

    def in_plane(self) -> ConstitutiveLaw:
        from .bent import BentLaw  # few scenes are held in a plane

        return BentLaw.naturally_bent(self, self.k)

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        T, D, c, _ = self.k.combined(m2, m3)
        q, p = self._norms(m2, m3)
        size = (q + p) / 4
        return size * (T / q + D / p), size * c * (self.delta**2 / q + 1 / p)

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        # For guesses only: those of the sharp law, of whose kinks this one is a blunt version.
        return NaturalSadowskyLaw(self.k).moments(u2, u3)

    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        m2, m3 = self.moments(u2, u3)
        return m2 * u2 + m3 * u3 - self.complementary(m2, m3)

    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        q, p = self._norms(m2, m3)
        return (q + p) ** 2 / 8 - self.k.constant

    def implicit(self, stress: Stress) -> ImplicitLaw:
        """Return the equations for the strains and both norms, q and p from their squares."""
        m2, m3 = stress.m[1], stress.m[2]
        z, (T, D, c, _), norms = ca.SX.sym("u", 4), self.k.combined(m2, m3), self._norms(m2, m3)
        u2, u3, q, p = ca.vertsplit(z)
        size = norms[0] + norms[1]  # brings all equations to the size of the strains
        squares = self._squares(m2, m3)
        equations = ca.vertcat(
            (q**2 - squares[0]) / size,
            (p**2 - squares[1]) / size,
            (4 * q * p * u2 - (q + p) * (T * p + D * q)) / size**2,
            (4 * q * p * u3 - c * (q + p) * (self.delta**2 * p + q)) / size**2,
        )
        estimate = ca.vertcat(self.strain(stress)[1:], *norms)
        return ImplicitLaw(z, equations, ca.vertcat(-q, -p), estimate)

    def sheet_slope(self, stress: Stress, u: ca.SX) -> ca.SX:
        return self.k.slope(u[1], u[2])

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        T, D, c, _ = self.k.combined(stress.m[1], stress.m[2])
        leap = self.switching(stress).leap
        blunt = norm(c, 2 * self.delta * self.k.K22)
        return Singular(D, blunt, leap), Singular(T, self.delta * leap, leap)

    def switching(self, stress: Stress) -> Switch:
        return NaturalSides(self.k).switching(stress)

    def _squares(self, m2: ca.SX, m3: ca.SX) -> Components:
        T, D, c, _ = self.k.combined(m2, m3)
        dull = (2 * self.delta * self.k.K22) ** 2
        return T**2 + (self.delta * c) ** 2 + dull, D**2 + c**2 + dull

    def _norms(self, m2: ca.SX, m3: ca.SX) -> Components:
        q, p = self._squares(m2, m3)
        return ca.sqrt(q + GUARD**2), ca.sqrt(p + GUARD**2)
