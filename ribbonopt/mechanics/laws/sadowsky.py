"""Sadowsky's law with |eta| <= 1, eqs. (4.3)-(4.4), its two sheets, and their mixture.

The strain u2 jumps where m2 changes sign, between -|m3|/4 and |m3|/4. Beside the two sheets
(chi = sign of m2, each continued analytically beyond m2 = 0) there are arcs on which m2 stays zero,
a fine mixture of both (section 4, the convexified energy).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import casadi as ca

from .implicit import ImplicitLaw, bounded
from .law import ConstitutiveLaw, RibbonLaw, Stress
from .parts import Relaxed, Singular
from .relations import (
    Components,
    convexified_energy,
    norm,
    sadowsky_complementary_energy,
    sadowsky_energy,
    sheet_moment,
    sheet_sum,
)

if TYPE_CHECKING:
    from .natural import NaturalStrains


class SwitchedLaw(RibbonLaw):
    """A law whose strains have a jump or a kink at m2 = 0, in phases of one sheet or a mixture."""

    kinked = True
    sheeted = True

    def branch(self, kind: int) -> ConstitutiveLaw:
        return self.sheet(kind) if kind else MixtureLaw()

    def sheet(self, chi: int) -> ConstitutiveLaw:
        """Return the law of the side chi = sign(m2), continued analytically beyond m2 = 0."""
        return SingleSheetLaw(ca.SX(chi))

    def entering(self, kinds: tuple[int, ...], i: int, stress: Stress) -> Mapping[str, ca.SX]:
        zero = {"m2 = 0": stress.m[1]}
        # What a mixture demands where it begins it keeps to its end, so that one end will do. At an
        # end of the ribbon none of it is asked, and `zeros` tell whether the ends allow it: those
        # of a symmetric band do, those of a clamp only by design, as for a helix.
        if kinds[i] == 0 and i < len(kinds) - 1:
            return zero | {"n1 + m1 u3 = 0": mixture_drift(stress)}
        return {} if kinds[i - 1] == 0 and i > 1 else zero

    def margins(self, kind: int, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        if kind:
            wrong = "m2 has the wrong sign {where}: no equilibrium of Sadowsky's ribbon"
            return {wrong: kind * stress.m[1]}
        return {
            "the mixture {where} is unstable: K < 0": mixture_stiffness(stress),
            "|u2| > |u3| {where}: not a mixture": ca.fabs(u[2]) - ca.fabs(u[1]),
        }

    def zeros(self, kind: int, stress: Stress) -> Mapping[str, ca.SX]:
        if kind:
            return {}
        return {
            "m2 is not zero {where}: not a mixture": stress.m[1],
            "n1 + m1 u3 is not zero {where}: not a mixture": mixture_drift(stress),
        }


@dataclass(frozen=True, eq=False)
class SadowskyLaw(SwitchedLaw):
    """Both sheets; energy W_F, the convexified W_S.

    At m2 = 0 `strains` returns u2 = 0, the mixture of both for which W_F was made.
    """

    bounds_eta = True
    smooth = False

    def naturally(self, natural: NaturalStrains) -> ConstitutiveLaw:
        from .natural_sadowsky import NaturalSadowskyLaw

        return NaturalSadowskyLaw(natural)

    def implicit(self, stress: Stress) -> ImplicitLaw:
        # The gradient of W_S itself: eqs. (2.4)-(2.5) have solutions in the forbidden region too.
        return bounded(sheet_moment, self.strain(stress), stress.m)

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        M, mu = norm(m2, m3), ca.fabs(m2)
        return ca.sign(m2) * (M + mu) ** 2 / (4 * M), m3 * (M + mu) / (4 * M)

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        allowed = ca.fabs(u2) >= ca.fabs(u3)
        m2, m3 = sheet_moment(ca.if_else(allowed, u2, 1), u3)
        return ca.if_else(allowed, m2, 0) * (u2 != 0), ca.if_else(allowed, m3, 4 * u3)

    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        return convexified_energy(u2, u3)

    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        return sadowsky_complementary_energy(m2, m3)

    def relaxed(self, stress: Stress) -> Relaxed:
        """W_F = min over k >= |u2| of (k + u3^2 / k)^2 / 2."""
        z, strain = ca.SX.sym("u", 3), self.strain(stress)
        u2, u3, k = ca.vertsplit(z)
        path = ca.vertcat(u2 - k, -u2 - k)
        estimate = ca.vertcat(strain[1:], ca.fmax(ca.fabs(strain[1]), ca.fabs(strain[2])))
        return Relaxed(z, ca.vertcat(0, u2, u3), (k + u3**2 / k) ** 2 / 2, path, estimate)


@dataclass(frozen=True, eq=False)
class SingleSheetLaw(RibbonLaw):
    """The sheet chi = sign(u2) of eqs. (2.4)-(2.5): (B 1) with the sign of m2 chi mended.

    Analytic across m2 = 0; beyond it (chi m2 < 0) |eta| exceeds 1.
    """

    chi: ca.SX
    bounds_eta = True

    def naturally(self, natural: NaturalStrains) -> ConstitutiveLaw:
        from .natural_sadowsky import NaturalSheetLaw

        return NaturalSheetLaw(self.chi, natural)

    def implicit(self, stress: Stress) -> ImplicitLaw:
        return bounded(self.moments, self.strain(stress), stress.m)

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        M = norm(m2, m3)
        p = sheet_sum(m2, m3, self.chi)
        return self.chi * p**2 / (4 * M), m3 * p / (4 * M)

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        return sheet_moment(u2, u3)

    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        return sadowsky_energy(u2, u3)

    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        return sheet_sum(m2, m3, self.chi) ** 2 / 8


class MixtureLaw(ConstitutiveLaw):
    """Arcs of both sheets, epsilon = 0: m2 = 0, u3 = m3 / 4, u2 = (2 n2 u3 - f1) / K.

    Under a couple c per length n1 + c2 + m1 u3 is what is kept, and u2 has - 2 u3 c1 - m1 c3 / 4.

    The strain u2 keeps m2 at zero along the arc; no moment gives it. With a term in m2 (zero along
    the arc) it keeps n1 + m1 u3 where it is even off the arc, so that m2 is linear in s there and
    zero along the arc if that and m2 are zero at one point of it.
    """

    def strain(self, stress: Stress) -> ca.SX:
        u3 = stress.m[2] / 4
        turning = (2 * stress.n[1] + u3 * stress.m[1]) * u3
        if stress.load is not None:
            turning -= stress.load[0]
        if stress.couple is not None:
            turning -= 2 * u3 * stress.couple[0] + stress.m[0] * stress.couple[2] / 4
        return ca.vertcat(0, turning / mixture_stiffness(stress), u3)

    def moment(self, u: ca.SX) -> ca.SX:
        return ca.vertcat(0, 4 * u[2])

    def energy(self, u: ca.SX) -> ca.SX:
        return 2 * u[2] ** 2

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        return (Singular(mixture_stiffness(stress), ca.SX(0), ca.fabs(stress.m[2])),)

    def complementary_energy(self, stress: Stress) -> ca.SX:
        return sadowsky_complementary_energy(stress.m[1], stress.m[2])


def mixture_drift(stress: Stress) -> ca.SX:
    """Minus the rate of m2 along a mixture: n1 + c2 + m1 u3, a constant, zero where it is one."""
    if stress.couple is not None:
        return mixture_drift(stress._replace(couple=None)) + stress.couple[1]
    return stress.n[0] + stress.m[0] * stress.m[2] / 4


def mixture_stiffness(stress: Stress) -> ca.SX:
    """K = n3 + m3 u3 - m1^2 / 4 of a mixture, which must not be negative."""
    n, m = stress.n, stress.m
    return n[2] + m[2] ** 2 / 4 - m[0] ** 2 / 4
