"""The linear rod of section 2, with u1 = 0: m2 = B2 u2, m3 = B3 u3."""

from __future__ import annotations

import casadi as ca

from ribbonopt.classes import dataclass

from .law import ConstitutiveLaw, RibbonLaw
from .relations import Components


@dataclass(frozen=True, eq=False)
class KirchhoffLaw(RibbonLaw):
    """Linear rod of stiffnesses B2 (bending) and B3 (twist), in units of Dw."""

    B2: ca.SX
    B3: ca.SX
    linear_at_zero = True
    developable = False

    def in_plane(self) -> ConstitutiveLaw:
        from .bent import BentLaw  # few scenes are held in a plane

        return BentLaw(self, self.B2)

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        return m2 / self.B2, m3 / self.B3

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        return self.B2 * u2, self.B3 * u3

    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        return (self.B2 * u2**2 + self.B3 * u3**2) / 2

    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        return (m2**2 / self.B2 + m3**2 / self.B3) / 2
