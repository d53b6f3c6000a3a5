"""A smooth law that keeps an energy: W_Leg = (q + M)^2 / 8, q = sqrt(m2^2 + delta^2 m3^2)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import casadi as ca

from ribbonopt.classes import dataclass

from .implicit import ImplicitLaw, norm_form
from .law import ConstitutiveLaw, RibbonLaw, Stress
from .relations import Components, inverse, norm

if TYPE_CHECKING:
    from .natural import NaturalStrains


@dataclass(frozen=True, eq=False)
class VariationalLaw(RibbonLaw):
    """delta = 1 is a rod with B2 = B3 = 1, delta -> 0 is Sadowsky. Not in the paper."""

    delta: ca.SX
    closed_moment = False

    def naturally(self, natural: NaturalStrains) -> ConstitutiveLaw:
        from .natural_variational import NaturalVariationalLaw

        return NaturalVariationalLaw(self.delta, natural)

    def in_plane(self) -> ConstitutiveLaw:
        from .bent import BentLaw  # few scenes are held in a plane

        return BentLaw(self)

    def implicit(self, stress: Stress) -> ImplicitLaw:
        return norm_form(self.delta, self.strain(stress), stress.m)

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        M, q = norm(m2, m3), norm(m2, self.delta * m3)
        common = (q + M) / (4 * q * M)
        return m2 * (q + M) * common, m3 * (q + self.delta**2 * M) * common

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        return inverse(self.strains, u2, u3)

    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        # The Legendre transform back: errors of the moments enter in second order only.
        m2, m3 = self.moments(u2, u3)
        return m2 * u2 + m3 * u3 - self.complementary(m2, m3)

    def layers(self, m2: ca.SX, m3: ca.SX) -> tuple[Components, ...]:
        return ((m2, self.delta * m3),)  # q = 0

    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        return (norm(m2, m3) + norm(m2, self.delta * m3)) ** 2 / 8
