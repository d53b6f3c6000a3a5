"""Laws with a quartic energy: smooth where they are convex, in phases where they are not.

Beyond the limit of convexity u2 leaps where m2 changes sign, from one side to the other, as
Sadowsky's does at any m3: the energy is the convexified one, and the leap counts from there on.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping

import casadi as ca

from ribbonopt.classes import dataclass

from .law import ConstitutiveLaw, RibbonLaw, Stress
from .mixture import MixtureLaw
from .parts import Switch
from .quartic import Quartic
from .relations import Components
from .switched import SwitchedLaw


class QuarticLaw(SwitchedLaw):
    """A law of (u2, u3) with a quartic energy in units of strain of its own."""

    smooth = False
    linear_at_zero = True
    developable = False

    @property
    @abstractmethod
    def unit(self) -> ca.SX:
        """The strain by which a = u2 / unit and b = u3 / unit; also that of moments over Dw."""

    @property
    @abstractmethod
    def quartic(self) -> Quartic:
        """The energy of these."""

    def in_plane(self) -> ConstitutiveLaw:
        from .bent import UntwistedLaw  # few scenes are held in a plane

        return UntwistedLaw(self)

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        return self.on_side(m2, m3, 0)

    def on_side(self, m2: ca.SX, m3: ca.SX, side: int) -> Components:
        """Return the strains of a side, +1 or -1, or (0) of the side that m2 has."""
        k = self.unit
        a, b = self.quartic.inverse(m2 / k, m3 / k, side)
        return k * a, k * b

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        k = self.unit
        A, B = self.quartic.moments(u2 / k, u3 / k)
        return k * A, k * B

    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        return self.unit**2 * self.quartic.energy(u2 / self.unit, u3 / self.unit)

    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        return self.legendre(m2, m3, self.strains(m2, m3))

    def legendre(self, m2: ca.SX, m3: ca.SX, u: Components) -> ca.SX:
        """Return m . u - W at strains; their errors enter in second order."""
        return m2 * u[0] + m3 * u[1] - self.stored(*u)

    @property
    def limit(self) -> ca.SX:
        """The twisting moment beyond which the energy is not convex at u2 = 0."""
        return self.unit * self.quartic.limit[1]

    def switching(self, stress: Stress) -> Switch:
        return Switch(stress.m[1], ca.fmax(ca.fabs(stress.m[2]) - self.limit, 0))

    def sheet(self, chi: int) -> ConstitutiveLaw:
        return QuarticSideLaw(self, chi)

    @property
    def mixture(self) -> MixtureLaw:
        return QuarticMixtureLaw(self)

    def on_sheet(self, kind: int, stress: Stress) -> Mapping[str, ca.SX]:
        wrong = "m2 has the wrong sign {where}, where the strains leap: no equilibrium"
        switch = self.switching(stress)
        return {wrong: ca.if_else(switch.leap > 0, kind * switch.value, 0)}

    def between(self, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        u2, _ = self.on_side(ca.SX(0), stress.m[2], 1)
        return {"|u2| is beyond both sides {where}: not a mixture": u2 - ca.fabs(u[1])}


@dataclass(frozen=True, eq=False)
class QuarticSideLaw(RibbonLaw):
    """One side, sign(u2) = `chi`, of a quartic law, beyond m2 = 0 too where it leaps.

    Where it does not leap it is the law itself.
    """

    law: QuarticLaw
    chi: int
    linear_at_zero = True
    developable = False

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        return self.law.on_side(m2, m3, self.chi)

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        return self.law.moments(u2, u3)

    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        return self.law.stored(u2, u3)

    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        return self.law.legendre(m2, m3, self.strains(m2, m3))


@dataclass(frozen=True, eq=False)
class QuarticMixtureLaw(MixtureLaw):
    """Both sides of a quartic law at m2 = 0, where they leap."""

    law: QuarticLaw
    developable = False
    closed_moment = False

    def twist(self, m3: ca.SX) -> tuple[ca.SX, ca.SX]:
        x = ca.SX.sym("m3")
        _, u3 = self.law.on_side(ca.SX(0), x, 1)
        both = ca.substitute(ca.vertcat(u3, ca.jacobian(u3, x)), x, m3)
        return both[0], both[1]

    def moment(self, u: ca.SX) -> ca.SX:
        return ca.vertcat(0, self.law.moments(u[1], u[2])[1])

    def energy(self, u: ca.SX) -> ca.SX:
        return self.law.stored(u[1], u[2])

    def complementary_energy(self, stress: Stress) -> ca.SX:
        return self.law.legendre(ca.SX(0), stress.m[2], self.law.on_side(ca.SX(0), stress.m[2], 1))
