"""Constitutive laws: relations between the strains (u2, u3) and the moments (m2, m3).

Components along the directors d2 (across the width) and d3 (tangent), units Dw = L = 1, u1 = 0.
A law gives `strain(m)` (what the inverted formulation needs) and `moment(u)`; laws that derive from
an energy also give `energy(u)` and `complementary_energy(m)`, else these are None and
`variational` is False. Arguments are CasADi symbols, numbers too.

With M = |m| and mu = |m2|, lambda* of eq. (4.2) is written (M - mu)/(M + mu), which neither divides
by zero at m3 = 0 nor cancels. All laws are positively homogeneous of degree one and not
differentiable at m = 0, so M is guarded: M = sqrt(m2^2 + m3^2 + GUARD^2). The guard is below half a
unit in the last place of M^2 for M > 1e-51 and so changes no bit of any result there; at m = 0
strains and derivatives are finite.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import casadi as ca

from .implicit import ImplicitLaw, gradient_form, norm_form, polynomial_form
from .relations import (
    Pair,
    blended_strain,
    convexified_energy,
    inverse,
    norm,
    sadowsky_complementary_energy,
    sadowsky_energy,
    sheet_moment,
    sheet_sum,
)


class ConstitutiveLaw(ABC):
    """A relation between strains and moments; see the module for frame and units."""

    #: strain energy exists, so that H = W_Leg + n3 is an invariant (section 7)
    variational: bool = True
    #: the law demands |eta| <= 1 of a solution, eq. (4.1)
    bounds_eta: bool = False
    #: the complementary energy is differentiable away from m = 0
    smooth: bool = True
    #: `moment` is a closed form, cheap to evaluate and to differentiate
    closed_moment: bool = True
    #: strains have a kink or a jump where m2 changes sign; `sheet_strain` continues either side
    kinked: bool = False

    @abstractmethod
    def strain(self, m2: ca.SX, m3: ca.SX) -> Pair:
        """Strains (u2, u3) at the moments (m2, m3)."""

    def sheet_strain(self, m2: ca.SX, m3: ca.SX, chi: int) -> Pair:
        """Strains of the side chi = sign(m2), continued analytically beyond m2 = 0."""
        return self.strain(m2, m3)

    @abstractmethod
    def moment(self, u2: ca.SX, u3: ca.SX) -> Pair:
        """Moments (m2, m3) at the strains (u2, u3)."""

    @abstractmethod
    def energy(self, u2: ca.SX, u3: ca.SX) -> ca.SX | None:
        """Strain energy W(u2, u3) per length, or None."""

    @abstractmethod
    def complementary_energy(self, m2: ca.SX, m3: ca.SX) -> ca.SX | None:
        """Legendre transform W_Leg(m2, m3) of the energy, eq. (7.1), or None."""

    def implicit(self, m2: ca.SX, m3: ca.SX) -> ImplicitLaw:
        """Return the law at given moments as equations for the strains, eq. (3.1b)."""
        return gradient_form(self.moment, self.strain(m2, m3), m2, m3, bounded=False)


@dataclass(frozen=True, eq=False)
class KirchhoffLaw(ConstitutiveLaw):
    """Linear rod of section 2: m2 = B2 u2, m3 = B3 u3."""

    B2: ca.SX
    B3: ca.SX

    def strain(self, m2: ca.SX, m3: ca.SX) -> Pair:
        return m2 / self.B2, m3 / self.B3

    def moment(self, u2: ca.SX, u3: ca.SX) -> Pair:
        return self.B2 * u2, self.B3 * u3

    def energy(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        return (self.B2 * u2**2 + self.B3 * u3**2) / 2

    def complementary_energy(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        return (m2**2 / self.B2 + m3**2 / self.B3) / 2


@dataclass(frozen=True, eq=False)
class SadowskyLaw(ConstitutiveLaw):
    """Sadowsky's law with |eta| <= 1, eqs. (4.3)-(4.4); energy W_F, the convexified W_S.

    At m2 = 0 the strain u2 jumps between -|m3|/4 and |m3|/4; `strain` returns 0 there, which
    is the mixture of both for which W_F was made.
    """

    bounds_eta = True
    smooth = False
    kinked = True

    def sheet_strain(self, m2: ca.SX, m3: ca.SX, chi: int) -> Pair:
        return SingleSheetLaw(ca.SX(chi)).strain(m2, m3)

    def implicit(self, m2: ca.SX, m3: ca.SX) -> ImplicitLaw:
        # The gradient of W_S itself: eqs. (2.4)-(2.5) have solutions in the forbidden region too.
        return gradient_form(sheet_moment, self.strain(m2, m3), m2, m3, bounded=True)

    def strain(self, m2: ca.SX, m3: ca.SX) -> Pair:
        M, mu = norm(m2, m3), ca.fabs(m2)
        return ca.sign(m2) * (M + mu) ** 2 / (4 * M), m3 * (M + mu) / (4 * M)

    def moment(self, u2: ca.SX, u3: ca.SX) -> Pair:
        allowed = ca.fabs(u2) >= ca.fabs(u3)
        m2, m3 = sheet_moment(ca.if_else(allowed, u2, 1), u3)
        return ca.if_else(allowed, m2, 0) * (u2 != 0), ca.if_else(allowed, m3, 4 * u3)

    def energy(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        return convexified_energy(u2, u3)

    def complementary_energy(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        return sadowsky_complementary_energy(m2, m3)


@dataclass(frozen=True, eq=False)
class SingleSheetLaw(ConstitutiveLaw):
    """The sheet chi = sign(u2) of eqs. (2.4)-(2.5): (B 1) with the sign of m2 chi mended.

    Analytic across m2 = 0; beyond it (chi m2 < 0) |eta| exceeds 1.
    """

    chi: ca.SX
    bounds_eta = True

    def implicit(self, m2: ca.SX, m3: ca.SX) -> ImplicitLaw:
        return gradient_form(self.moment, self.strain(m2, m3), m2, m3, bounded=True)

    def strain(self, m2: ca.SX, m3: ca.SX) -> Pair:
        M = norm(m2, m3)
        p = sheet_sum(m2, m3, self.chi)
        return self.chi * p**2 / (4 * M), m3 * p / (4 * M)

    def moment(self, u2: ca.SX, u3: ca.SX) -> Pair:
        return sheet_moment(u2, u3)

    def energy(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        return sadowsky_energy(u2, u3)

    def complementary_energy(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        return sheet_sum(m2, m3, self.chi) ** 2 / 8


class _Blended(ConstitutiveLaw):
    """The family of eq. (C 1) in rho and epsilon; not the gradient of an energy."""

    rho: ca.SX | float
    epsilon: ca.SX
    variational = False
    closed_moment = False
    kinked = True

    def strain(self, m2: ca.SX, m3: ca.SX) -> Pair:
        return blended_strain(m2, m3, self.rho, self.epsilon)

    def sheet_strain(self, m2: ca.SX, m3: ca.SX, chi: int) -> Pair:
        return blended_strain(m2, m3, self.rho, self.epsilon, chi)

    def implicit(self, m2: ca.SX, m3: ca.SX) -> ImplicitLaw:
        return polynomial_form(self.rho, self.epsilon, self.strain(m2, m3), m2, m3)

    def moment(self, u2: ca.SX, u3: ca.SX) -> Pair:
        return inverse(self.strain, u2, u3)

    def energy(self, u2: ca.SX, u3: ca.SX) -> None:
        return None

    def complementary_energy(self, m2: ca.SX, m3: ca.SX) -> None:
        return None


@dataclass(frozen=True, eq=False)
class RegularizedLaw(_Blended):
    """Sadowsky's law smoothed by epsilon, eq. (6.1)."""

    epsilon: ca.SX
    rho = 1


@dataclass(frozen=True, eq=False)
class HomotopyLaw(_Blended):
    """From rod (rho = 0) to regularised ribbon (rho = 1), eq. (C 1)."""

    rho: ca.SX
    epsilon: ca.SX


@dataclass(frozen=True, eq=False)
class VariationalLaw(ConstitutiveLaw):
    """Smooth law with an energy: W_Leg = (q + M)^2 / 8, q = sqrt(m2^2 + delta^2 m3^2).

    delta = 1 is a rod with B2 = B3 = 1, delta -> 0 is Sadowsky. Not in the paper.
    """

    delta: ca.SX
    closed_moment = False

    def implicit(self, m2: ca.SX, m3: ca.SX) -> ImplicitLaw:
        return norm_form(self.delta, self.strain(m2, m3), m2, m3)

    def strain(self, m2: ca.SX, m3: ca.SX) -> Pair:
        M, q = norm(m2, m3), norm(m2, self.delta * m3)
        common = (q + M) / (4 * q * M)
        return m2 * (q + M) * common, m3 * (q + self.delta**2 * M) * common

    def moment(self, u2: ca.SX, u3: ca.SX) -> Pair:
        return inverse(self.strain, u2, u3)

    def energy(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        # The Legendre transform back: errors of the moments enter in second order only.
        m2, m3 = self.moment(u2, u3)
        return m2 * u2 + m3 * u3 - self.complementary_energy(m2, m3)

    def complementary_energy(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        return (norm(m2, m3) + norm(m2, self.delta * m3)) ** 2 / 8


#: laws by the name a scene gives them; their fields are those of the scene's classes
LAWS: dict[str, type[ConstitutiveLaw]] = {
    "kirchhoff": KirchhoffLaw,
    "sadowsky": SadowskyLaw,
    "single_sheet": SingleSheetLaw,
    "regularized": RegularizedLaw,
    "homotopy": HomotopyLaw,
    "variational": VariationalLaw,
}
