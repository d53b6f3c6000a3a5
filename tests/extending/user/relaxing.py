"""A law with a state of its own along the ribbon, eta' = m2 - eta, that adds to the curvature."""

from dataclasses import dataclass

import casadi as ca

from ribbonopt.mechanics.laws.law import ConstitutiveLaw


@dataclass(frozen=True)
class Relaxing:
    gain: float = 0.1
    type: str = "relaxing"

    def constitutive(self, numbers, position):
        return RelaxingLaw(numbers["gain"])


@dataclass(frozen=True, eq=False)
class RelaxingLaw(ConstitutiveLaw):
    gain: ca.SX
    states = ("eta",)
    variational = False
    developable = False
    closed_moment = False

    def strain(self, stress):
        return ca.vertcat(0, stress.m[1] + self.gain * stress.own, stress.m[2] / 2)

    def rates(self, stress, u):
        return stress.m[1] - stress.own

    def end_conditions(self, end, stress):
        return {"eta = 0": stress.own} if end == "start" else {}

    def own_guess(self, stress):
        return stress.m[1]

    def moment(self, u):
        return ca.vertcat(u[1], 2 * u[2])  # for guesses only

    def energy(self, u):
        return None

    def complementary_energy(self, stress):
        return None
