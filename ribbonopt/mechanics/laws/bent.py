"""Laws of a ribbon that stays in the plane across d2, where m1 = m3 = 0 and only u2 is not zero.

There Sadowsky's law and all that blend or blunt it are the elastica, W = B (u2 - k)^2 / 2: nothing
leaps, no place is singular, and m2 may change its sign without a phase that ends there.
"""

from __future__ import annotations

import casadi as ca

from ribbonopt.classes import dataclass

from .law import ConstitutiveLaw, RibbonLaw, Stress
from .natural import NaturalStrains
from .parts import Switch
from .relations import Components

#: what a plane leaves as it is; where it is straight, and may leave the plane, as in space
OF_RIBBON = ("variational", "developable", "natural", "linear_at_zero", "switch_name")


@dataclass(frozen=True, eq=False)
class BentLaw(ConstitutiveLaw):
    """The elastica u2 = m2 / B + k of a `law` that bends so in a plane.

    `rest` is W_Leg where m2 = 0, `zero` the moment m2 at which the law switches in space.
    """

    law: ConstitutiveLaw
    B: ca.SX | float = 1.0
    k: ca.SX | float = 0.0
    rest: ca.SX | float = 0.0
    zero: ca.SX | float = 0.0
    components = (1,)

    def __post_init__(self) -> None:
        """Declare what the ribbon is, in its plane or not."""
        for name in OF_RIBBON:
            object.__setattr__(self, name, getattr(self.law, name))

    @classmethod
    def naturally_bent(cls, law: ConstitutiveLaw, k: NaturalStrains) -> BentLaw:
        """Return that of a ribbon's law with natural strains of which K12 and K22 are zero."""
        return cls(law, 1.0, k.K11, k.K11**2 / 2 - k.constant, -k.K11)

    def strain(self, stress: Stress) -> ca.SX:
        return ca.vertcat(0, stress.m[1] / self.B + self.k, 0)

    def moment(self, u: ca.SX) -> ca.SX:
        return self.B * (u[1] - self.k)

    def energy(self, u: ca.SX) -> ca.SX | None:
        return self.B * (u[1] - self.k) ** 2 / 2 - self.rest if self.variational else None

    def complementary_energy(self, stress: Stress) -> ca.SX | None:
        m2 = stress.m[1]
        found = m2**2 / (2 * self.B) + m2 * self.k + self.rest
        return found if self.variational else None

    def switching(self, stress: Stress) -> Switch:
        return Switch(stress.m[1] - self.zero, ca.SX(0))


@dataclass(frozen=True, eq=False)
class UntwistedLaw(RibbonLaw):
    """A ribbon's law that is smooth where there is no twist, whatever it is with some."""

    law: RibbonLaw
    components = (1,)

    def __post_init__(self) -> None:
        """Declare what the ribbon is, in its plane or not."""
        for name in OF_RIBBON:
            object.__setattr__(self, name, getattr(self.law, name))

    def moment(self, u: ca.SX) -> ca.SX:
        return self.moments(u[1], u[2])[0]

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        return self.law.strains(m2, ca.SX(0))[0], ca.SX(0)

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        return self.law.moments(u2, ca.SX(0))[0], ca.SX(0)

    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX | None:
        return self.law.stored(u2, ca.SX(0))

    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX | None:
        return self.law.complementary(m2, ca.SX(0))

    def switching(self, stress: Stress) -> Switch:
        return Switch(stress.m[1], ca.SX(0))
