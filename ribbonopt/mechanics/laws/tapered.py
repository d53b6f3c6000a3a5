"""Any law along a ribbon of varying width w(s), in units of the width that Dw is made of.

The energy per length is w W(u), W that of a strip of this width (`at_width`), so that strains are
those of m / w, and W_Leg,w = w W_Leg(m / w); H' = -w' W(u) where W knows no width. Good for
|w'| << 1.
"""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError

from .implicit import ImplicitLaw
from .law import ConstitutiveLaw, Stress
from .parts import DECLARED, Relaxed, Singular, Switch


def tapered(law: ConstitutiveLaw, width: ca.SX, position: ca.SX) -> ConstitutiveLaw:
    """Return a law along a ribbon of a width, an expression of the arclength `position`.

    Raises
    ------
    ModelError
        If the law has states of its own: what a width does to them only the law can say.
    """
    if law.states:
        raise ModelError(
            f"width: the law has states of its own ({', '.join(law.states)}), of which only it can "
            "say what a width does to them; let the law depend on s, and remove width",
            "width",
        )
    return TaperedLaw(law.at_width(width), width, ca.jacobian(width, position))


@dataclass(frozen=True, eq=False)
class TaperedLaw(ConstitutiveLaw):
    """A law of the unit width, at a width and its slope dw/ds; it declares what the law does.

    In a mixture n1 + m1 u3 stays zero, u3 = m3 / (4 w): its rate has a term -m1 u3 w'/w more, which
    2 n2 u3 in it has with n2 less m1 w'/(2 w).
    """

    law: ConstitutiveLaw
    width: ca.SX
    slope: ca.SX
    mixture: bool = False

    def __post_init__(self) -> None:
        for name in DECLARED:
            object.__setattr__(self, name, getattr(self.law, name))

    def strain(self, stress: Stress) -> ca.SX:
        return self.law.strain(self._unit(stress))

    def moment(self, u: ca.SX) -> ca.SX:
        return self.width * self.law.moment(u)

    def energy(self, u: ca.SX) -> ca.SX | None:
        return self._times(self.law.energy(u))

    def complementary_energy(self, stress: Stress) -> ca.SX | None:
        return self._times(self.law.complementary_energy(self._unit(stress)))

    def implicit(self, stress: Stress) -> ImplicitLaw:
        return self.law.implicit(self._unit(stress))

    def relaxed(self, stress: Stress) -> Relaxed | None:
        found = self.law.relaxed(self._unit(stress))
        if found is None:
            return None
        cost = self.width * found.cost
        return Relaxed(found.controls, found.u, cost, found.path, found.estimate)

    def sheet_slope(self, stress: Stress, u: ca.SX) -> ca.SX | None:
        return self.law.sheet_slope(self._unit(stress), u)

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        found = self.law.singular(self._unit(stress))
        return tuple(where._replace(size=self.width * where.size) for where in found)

    def switching(self, stress: Stress) -> Switch:
        found = self.law.switching(self._unit(stress))
        return Switch(self.width * found.value, self.width * found.leap)

    def in_plane(self) -> ConstitutiveLaw:
        return TaperedLaw(self.law.in_plane(), self.width, self.slope)

    def branch(self, kind: int) -> ConstitutiveLaw:
        return TaperedLaw(self.law.branch(kind), self.width, self.slope, mixture=kind == 0)

    def entering(self, kinds: tuple[int, ...], i: int, stress: Stress) -> Mapping[str, ca.SX]:
        return self.law.entering(kinds, i, self._unit(stress))

    def margins(self, kind: int, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        return self.law.margins(kind, self._unit(stress), u)

    def zeros(self, kind: int, stress: Stress) -> Mapping[str, ca.SX]:
        return self.law.zeros(kind, self._unit(stress))

    def _unit(self, stress: Stress) -> Stress:
        """Return the stress of the unit width that gives these strains."""
        n, m, own, *loads = stress
        if self.mixture:
            n = ca.vertcat(n[0], n[1] - m[0] * self.slope / (2 * self.width), n[2])
        load, couple = (None if of is None else of / self.width for of in loads)
        return Stress(n / self.width, m / self.width, own, load, couple)

    def _times(self, density: ca.SX | None) -> ca.SX | None:
        return None if density is None else self.width * density
