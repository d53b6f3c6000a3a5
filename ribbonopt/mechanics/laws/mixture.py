"""Arcs on which m2 stays zero, a fine mixture of the two sides of a law that leaps there.

With u3 = f(m3), the twist of both sides where m2 = 0, the strain u2 keeps m2 at zero along the arc;
no moment gives it: from n1 + m1 u3 = 0, differentiated,

    u2 = (2 n2 u3 - f1) / K,    K = n3 + m3 u3 - f'(m3) m1^2.

Under a couple c per length n1 + c2 + m1 u3 is what is kept, and u2 has - (2 u3 c1 + f' m1 c3) / K.
With a term in m2 (zero along the arc) it keeps n1 + m1 u3 where it is even off the arc, so that m2
is linear in s there and zero along the arc if that and m2 are zero at one point of it.
"""

from __future__ import annotations

from abc import abstractmethod

import casadi as ca

from .law import ConstitutiveLaw, Stress
from .parts import Singular


class MixtureLaw(ConstitutiveLaw):
    """A mixture of both sides of a law."""

    @abstractmethod
    def twist(self, m3: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Return u3 where m2 = 0, and its derivative along m3."""

    def strain(self, stress: Stress) -> ca.SX:
        u3, slope = self.twist(stress.m[2])
        turning = (2 * stress.n[1] + u3 * stress.m[1]) * u3
        if stress.load is not None:
            turning -= stress.load[0]
        if stress.couple is not None:
            turning -= 2 * u3 * stress.couple[0] + slope * stress.m[0] * stress.couple[2]
        return ca.vertcat(0, turning / self.stiffness(stress), u3)

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        return (Singular(self.stiffness(stress), ca.SX(0), ca.fabs(stress.m[2])),)

    def drift(self, stress: Stress) -> ca.SX:
        """Minus the rate of m2 along it: n1 + c2 + m1 u3, a constant, zero where it is one."""
        u3, _ = self.twist(stress.m[2])
        found = stress.n[0] + stress.m[0] * u3
        return found if stress.couple is None else found + stress.couple[1]

    def stiffness(self, stress: Stress) -> ca.SX:
        """K, which must not be negative."""
        u3, slope = self.twist(stress.m[2])
        return stress.n[2] + stress.m[2] * u3 - slope * stress.m[0] ** 2
