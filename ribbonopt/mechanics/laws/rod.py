"""The ordinary rod: linear, bending about d1 as well, with strains k that it has without stress.

W = sum of B_i (u_i - k_i)^2 / 2, so that u_i = m_i / B_i + k_i and W_Leg = sum of
m_i^2 / (2 B_i) + m_i k_i. With u1 not zero there are no generatrices and no ribbon surface.
"""

from __future__ import annotations

import casadi as ca

from ribbonopt.classes import dataclass

from .law import ConstitutiveLaw, Stress


@dataclass(frozen=True, eq=False)
class RodLaw(ConstitutiveLaw):
    """Linear rod of stiffnesses B (3,), in units of Dw, and natural strains k (3,)."""

    B: ca.SX
    k: ca.SX
    components = (0, 1, 2)
    developable = False
    linear_at_zero = True

    @property
    def natural(self) -> bool:  # type: ignore[override]
        """Whether k is other than zero, or a symbol, which may be."""
        return not self.k.is_zero()

    @property
    def spins(self) -> bool:  # type: ignore[override]
        """Whether it is the same about all axes across d3, or of symbols, and may be."""
        if not (self.B.is_constant() and self.k.is_constant()):
            return True
        return bool(ca.is_equal(self.B[0], self.B[1]) and self.k[:2].is_zero())

    def in_plane(self) -> ConstitutiveLaw:
        from .bent import BentLaw  # few scenes are held in a plane

        return BentLaw(self, self.B[1], self.k[1])

    def strain(self, stress: Stress) -> ca.SX:
        return stress.m / self.B + self.k

    def moment(self, u: ca.SX) -> ca.SX:
        return self.B * (u - self.k)

    def energy(self, u: ca.SX) -> ca.SX:
        return ca.dot(self.B, (u - self.k) ** 2) / 2

    def complementary_energy(self, stress: Stress) -> ca.SX:
        return ca.dot(stress.m, stress.m / self.B / 2 + self.k)
