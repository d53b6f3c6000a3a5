"""Sadowsky's law with |eta| <= 1, eqs. (4.3)-(4.4), its two sheets, and their mixture.

The strain u2 jumps where m2 changes sign, between -|m3|/4 and |m3|/4. Beside the two sheets
(chi = sign of m2, each continued analytically beyond m2 = 0) there are arcs on which m2 stays zero,
a fine mixture of both (section 4, the convexified energy).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import casadi as ca

from ribbonopt.classes import dataclass

from .implicit import ImplicitLaw, bounded
from .law import ConstitutiveLaw, RibbonLaw, Stress
from .mixture import MixtureLaw
from .parts import Relaxed
from .relations import (
    Components,
    convexified_energy,
    norm,
    sadowsky_complementary_energy,
    sadowsky_energy,
    sheet_moment,
    sheet_sum,
)
from .switched import SwitchedLaw

if TYPE_CHECKING:
    from .natural import NaturalStrains


class SheetedLaw(SwitchedLaw):
    """A law whose sides are the sheets of eqs. (2.4)-(2.5), or may mix as they do."""

    sheeted = True

    def sheet(self, chi: int) -> ConstitutiveLaw:
        return SingleSheetLaw(ca.SX(chi))

    @property
    def mixture(self) -> MixtureLaw:
        return SheetMixtureLaw()

    def on_sheet(self, kind: int, stress: Stress) -> Mapping[str, ca.SX]:
        wrong = "m2 has the wrong sign {where}: no equilibrium of Sadowsky's ribbon"
        return {wrong: kind * stress.m[1]}

    def between(self, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        return {"|u2| > |u3| {where}: not a mixture": ca.fabs(u[2]) - ca.fabs(u[1])}


@dataclass(frozen=True, eq=False)
class SadowskyLaw(SheetedLaw):
    """Both sheets; energy W_F, the convexified W_S.

    At m2 = 0 `strains` returns u2 = 0, the mixture of both for which W_F was made.
    """

    bounds_eta = True
    smooth = False

    def naturally(self, natural: NaturalStrains) -> ConstitutiveLaw:
        from .natural_sadowsky import NaturalSadowskyLaw

        return NaturalSadowskyLaw(natural)

    def in_plane(self) -> ConstitutiveLaw:
        from .bent import BentLaw  # few scenes are held in a plane

        return BentLaw(self)

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


class SheetMixtureLaw(MixtureLaw):
    """Arcs of both sheets, epsilon = 0: m2 = 0, u3 = m3 / 4."""

    def twist(self, m3: ca.SX) -> tuple[ca.SX, ca.SX]:
        return m3 / 4, ca.SX(1) / 4

    def moment(self, u: ca.SX) -> ca.SX:
        return ca.vertcat(0, 4 * u[2])

    def energy(self, u: ca.SX) -> ca.SX:
        return 2 * u[2] ** 2

    def complementary_energy(self, stress: Stress) -> ca.SX:
        return sadowsky_complementary_energy(stress.m[1], stress.m[2])
