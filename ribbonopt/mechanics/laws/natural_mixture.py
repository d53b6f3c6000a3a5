"""Arcs of both sheets of a ribbon with natural strains: T = 0, u3 = c / 4.

From T = 0 along the arc, K being K11 + K22: n1 + m1 u3 = K' and, that differentiated,
u2 (n3 + m3 u3 - m1^2 / 4) = 2 n2 u3 + m2 u3^2 + m1 K12' / 2 - K''. Off the arc T is linear in s.
With a width w forces and moments are those over w, and K' is (w K)' / w. Loads along the ribbon
act as in `mixture.MixtureLaw`.
"""

from __future__ import annotations

import casadi as ca

from ribbonopt.classes import dataclass

from .law import ConstitutiveLaw, Stress
from .natural import mixed_energy
from .natural_sides import NaturalSides
from .parts import Singular


@dataclass(frozen=True, eq=False)
class NaturalMixtureLaw(ConstitutiveLaw):
    """The mixture of both sheets; see `mixture.MixtureLaw`, which has no natural strains."""

    sides: NaturalSides
    natural = True

    def strain(self, stress: Stress) -> ca.SX:
        n, m, k = stress.n, stress.m, self.sides.k
        u3 = (m[2] + 2 * k.K12) / 4
        turning = (2 * n[1] + u3 * m[1]) * u3 + m[0] * k.rate(k.K12) / 2
        turning -= k.rate(k.K11 + k.K22, 2)
        if stress.load is not None:
            turning -= stress.load[0]
        if stress.couple is not None:
            turning -= 2 * u3 * stress.couple[0] + m[0] * stress.couple[2] / 4
        return ca.vertcat(0, turning / self.sides.stiffness(stress), u3)

    def moment(self, u: ca.SX) -> ca.SX:
        k = self.sides.k
        return ca.vertcat(-k.K11 - k.K22, 4 * u[2] - 2 * k.K12)

    def energy(self, u: ca.SX) -> ca.SX:
        return mixed_energy(self.sides.k, u[1], u[2])

    def complementary_energy(self, stress: Stress) -> ca.SX:
        T, _, _, R = self.sides.k.combined(stress.m[1], stress.m[2])
        return (ca.fabs(T) + R) ** 2 / 8 - self.sides.k.constant

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        leap = self.sides.switching(stress).leap
        return (Singular(self.sides.stiffness(stress), ca.SX(0), leap),)
