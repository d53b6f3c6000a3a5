"""Sano and Wada's ribbon: W = (B2 u2^2 + B3 u3^2 + u3^4 / (c + u2^2)) / 2, c = 1 / zeta^2.

In units 1 / zeta of strains, a = zeta u2 and b = zeta u3: the quartic energy of
phi = 2 / (1 + a^2).
"""

from __future__ import annotations

from dataclasses import replace

import casadi as ca

from ribbonopt.classes import dataclass

from .quartic import Quartic, Stiffening
from .quartic_law import QuarticLaw


@dataclass(frozen=True, eq=False)
class SanoLaw(QuarticLaw):
    """Stiffnesses B2 and B3 in units of Dw, and the length zeta."""

    B2: ca.SX
    B3: ca.SX
    zeta: ca.SX

    @property
    def unit(self) -> ca.SX:
        """The strain 1 / zeta."""
        return 1 / self.zeta

    @property
    def quartic(self) -> Quartic:
        return Quartic(self.B2, self.B3, 0.0, PHI)

    def at_width(self, width: ca.SX) -> SanoLaw:
        # zeta is as the square of the width over the thickness.
        return replace(self, zeta=self.zeta * width**2)


def phi(a: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Return phi = 2 / (1 + a^2), phi' and phi''."""
    d = 1 + a**2
    return 2 / d, -4 * a / d**2, (12 * a**2 - 4) / d**3


PHI = Stiffening(phi, (2.0, -2.0, 2.0), reach=0.7)
