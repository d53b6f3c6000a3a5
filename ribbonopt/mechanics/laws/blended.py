"""The regularised laws of the paper, eqs. (6.1) and (C 1): smooth where m2 changes sign, no energy.

The kink that u3 keeps at m2 = 0 costs every scheme its order, so that phases help.
"""

from __future__ import annotations

from abc import abstractmethod

import casadi as ca

from ribbonopt.classes import dataclass

from .implicit import ImplicitLaw, polynomial_form
from .law import ConstitutiveLaw, RibbonLaw, Stress
from .relations import Components, bending, blended_strain, inverse, sheet_sum
from .sadowsky import SheetedLaw


class BlendedLaw(SheetedLaw):
    """The family of eq. (C 1)."""

    variational = False
    closed_moment = False

    @property
    def nonlinear(self) -> ca.SX | float:
        return self.weights[0]

    @property
    @abstractmethod
    def weights(self) -> tuple[ca.SX | float, ca.SX]:
        """The numbers rho and epsilon of the family."""

    def in_plane(self) -> ConstitutiveLaw:
        from .bent import BentLaw  # few scenes are held in a plane

        rho, epsilon = self.weights
        return BentLaw(self, 1 + rho * epsilon)

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        return blended_strain(m2, m3, *self.weights)

    def implicit(self, stress: Stress) -> ImplicitLaw:
        return polynomial_form(*self.weights, self.strain(stress), stress.m)

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        return inverse(self.strains, u2, u3)

    def stored(self, u2: ca.SX, u3: ca.SX) -> None:
        return None

    def complementary(self, m2: ca.SX, m3: ca.SX) -> None:
        return None

    def layers(self, m2: ca.SX, m3: ca.SX) -> tuple[Components, ...]:
        rho, epsilon = self.weights
        return ((2 * rho * m2, (1 - rho + rho * epsilon) * m3),)

    def sheet(self, chi: int) -> ConstitutiveLaw:
        return BlendedSheetLaw(*self.weights, chi)


@dataclass(frozen=True, eq=False)
class RegularizedLaw(BlendedLaw):
    """Sadowsky's law smoothed by epsilon, eq. (6.1)."""

    epsilon: ca.SX

    @property
    def weights(self) -> tuple[ca.SX | float, ca.SX]:
        return 1, self.epsilon


@dataclass(frozen=True, eq=False)
class HomotopyLaw(BlendedLaw):
    """From rod (rho = 0) to regularised ribbon (rho = 1), eq. (C 1)."""

    rho: ca.SX
    epsilon: ca.SX

    @property
    def weights(self) -> tuple[ca.SX | float, ca.SX]:
        return self.rho, self.epsilon


@dataclass(frozen=True, eq=False)
class BlendedSheetLaw(RibbonLaw):
    """One side of eq. (C 1), in which |m2| is continued as chi m2."""

    rho: ca.SX | float
    epsilon: ca.SX
    chi: int
    variational = False
    closed_moment = False

    @property
    def nonlinear(self) -> ca.SX | float:
        return self.rho

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        return blended_strain(m2, m3, self.rho, self.epsilon, self.chi)

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        return inverse(self.strains, u2, u3)

    def stored(self, u2: ca.SX, u3: ca.SX) -> None:
        return None

    def complementary(self, m2: ca.SX, m3: ca.SX) -> None:
        return None

    def layers(self, m2: ca.SX, m3: ca.SX) -> tuple[Components, ...]:
        # Beyond the end of the phase: the strain u2 has a pole there.
        s = sheet_sum(m2, m3, self.chi)
        return ((bending(self.chi * m2, s, self.rho, self.epsilon), ca.SX(0)),)
