"""Any law with natural strains whose K22 is zero: its moments are shifted by them.

u(m) = u_0(m2 + K11, m3 + 2 K12),    W(u) = W_0(u) - K11 u2 - 2 K12 u3 + C,
W_Leg(m) = W_Leg,0(m2 + K11, m3 + 2 K12) - C.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from ribbonopt.classes import dataclass

from .implicit import ImplicitLaw
from .law import ConstitutiveLaw, Stress
from .natural import NaturalStrains
from .natural_mixture import NaturalMixtureLaw
from .natural_sides import NaturalSides
from .parts import Relaxed, Singular, Switch

#: what a shift of the moments leaves as it is
KEPT = (
    "components",
    "variational",
    "bounds_eta",
    "developable",
    "smooth",
    "linear_at_zero",
    "kinked",
    "closed_moment",
    "states",
)


@dataclass(frozen=True, eq=False)
class ShiftedLaw(ConstitutiveLaw):
    """Another law with natural strains; `sides` where it switches as a ribbon does."""

    base: ConstitutiveLaw
    k: NaturalStrains
    sides: NaturalSides | None = None
    natural = True

    def __post_init__(self) -> None:
        """Declare what the other law declares."""
        for name in KEPT:
            object.__setattr__(self, name, getattr(self.base, name))
        if self.sides is not None:
            object.__setattr__(self, "switch_name", self.sides.name)

    def strain(self, stress: Stress) -> ca.SX:
        return self.base.strain(self._shifted(stress))

    def moment(self, u: ca.SX) -> ca.SX:
        return self.base.moment(u) - self._shift[list(self.components)]

    def energy(self, u: ca.SX) -> ca.SX | None:
        found = self.base.energy(u)
        return None if found is None else found - self._lost(u)

    def complementary_energy(self, stress: Stress) -> ca.SX | None:
        found = self.base.complementary_energy(self._shifted(stress))
        return None if found is None else found - self.k.constant

    def implicit(self, stress: Stress) -> ImplicitLaw:
        return self.base.implicit(self._shifted(stress))

    def relaxed(self, stress: Stress) -> Relaxed | None:
        found = self.base.relaxed(self._shifted(stress))
        return None if found is None else replace(found, cost=found.cost - self._lost(found.u))

    def rates(self, stress: Stress, u: ca.SX) -> ca.SX:
        return self.base.rates(self._shifted(stress), u)

    def end_conditions(self, end: str, stress: Stress) -> Mapping[str, ca.SX]:
        return self.base.end_conditions(end, self._shifted(stress))

    def own_guess(self, stress: Stress) -> ca.SX:
        return self.base.own_guess(self._shifted(stress))

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        return self.base.singular(self._shifted(stress))

    def switching(self, stress: Stress) -> Switch:
        return self.base.switching(self._shifted(stress))

    def at_width(self, width: ca.SX) -> ConstitutiveLaw:
        return replace(self, base=self.base.at_width(width))

    def in_plane(self) -> ConstitutiveLaw:
        return replace(self, base=self.base.in_plane())

    def branch(self, kind: int) -> ConstitutiveLaw:
        if kind == 0 and self.sides is not None:
            return NaturalMixtureLaw(self.sides)
        return replace(self, base=self.base.branch(kind))

    def entering(self, kinds: tuple[int, ...], i: int, stress: Stress) -> Mapping[str, ca.SX]:
        if self.sides is not None:
            return self.sides.entering(kinds, i, stress)
        return self.base.entering(kinds, i, self._shifted(stress))

    def margins(self, kind: int, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        if self.sides is not None:
            return self.sides.margins(kind, stress, u)
        return self.base.margins(kind, self._shifted(stress), u)

    def zeros(self, kind: int, stress: Stress) -> Mapping[str, ca.SX]:
        if self.sides is not None:
            return self.sides.zeros(kind, stress)
        return self.base.zeros(kind, self._shifted(stress))

    @property
    def _shift(self) -> ca.SX:
        return ca.vertcat(0, self.k.K11, 2 * self.k.K12)

    def _shifted(self, stress: Stress) -> Stress:
        return stress._replace(m=stress.m + self._shift)

    def _lost(self, u: ca.SX) -> ca.SX:
        return self.k.work(u[1], u[2]) - self.k.constant
