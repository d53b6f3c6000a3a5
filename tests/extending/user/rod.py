"""A linear rod that bends about all three axes, with natural strains k."""

from dataclasses import dataclass

import casadi as ca

from ribbonopt.mechanics.laws.law import ConstitutiveLaw


@dataclass(frozen=True)
class Rod:
    B1: float = 3.0
    B2: float = 1.0
    B3: float = 0.8
    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    type: str = "rod"

    def constitutive(self, numbers, position):
        return RodLaw(*(ca.vertcat(*(numbers[f"{x}{i}"] for i in (1, 2, 3))) for x in "Bk"))


@dataclass(frozen=True, eq=False)
class RodLaw(ConstitutiveLaw):
    B: ca.SX
    k: ca.SX
    components = (0, 1, 2)
    developable = False
    linear_at_zero = True
    natural = True

    def strain(self, stress):
        return stress.m / self.B + self.k

    def moment(self, u):
        return self.B * (u - self.k)

    def energy(self, u):
        return ca.dot(self.B, (u - self.k) ** 2) / 2

    def complementary_energy(self, stress):
        return ca.dot(stress.m, stress.m / self.B / 2 + self.k)
