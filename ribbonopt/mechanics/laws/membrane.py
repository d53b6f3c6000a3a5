"""Any law with finite stiffness in the ribbon's own plane: edgewise bending B1 and stretch EA.

W(u) + B1 u1^2 / 2 + EA e^2 / 2, r' = (1 + e) d3, so that u1 = m1 / B1 and e = n3 / EA, and
W_Leg(m) + m1^2 / (2 B1) + n3^2 / (2 EA). Without loads n, n . m and H = n3 + all that are constant.
The surface r + v (d2 + eta d3) of a ribbon's law is developable whatever u1 and e are: b' of its
generatrix b has no part along d1. But unrolled it is bent by u1, its edges stretched by u1 w / 2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError

from .implicit import ImplicitLaw
from .law import ConstitutiveLaw, Stress
from .membrane_mixture import rigid_stress
from .parts import DECLARED, Relaxed, Singular, Switch

BENDING, STRETCHING = "bending", "stretching"


def with_membrane(
    law: ConstitutiveLaw,
    stiffnesses: Mapping[str, ca.SX],
    width: ca.SX | float,
    position: ca.SX,
) -> ConstitutiveLaw:
    """Return a law with finite stiffnesses in the ribbon's plane.

    Parameters
    ----------
    law
        Of the ribbon otherwise, at its width.
    stiffnesses
        B1 and EA by name, `bending` in units of Dw and `stretching` of Dw / L^2, at width 1.
    width
        An expression of the arclength `position`: B1 is as its cube, EA as itself.
    position
        Symbol of the arclength.

    Raises
    ------
    ModelError
        If the law has a B1 of its own.
    """
    bending, stretching = (stiffnesses.get(name) for name in (BENDING, STRETCHING))
    if bending is not None and 0 in law.components:
        raise ModelError(
            "membrane.bending: the law bends about d1 too, with a stiffness of its own; remove "
            "membrane.bending",
            "membrane.bending",
        )
    soft = 0 if bending is None else 1 / (bending * width**3)
    long = 0 if stretching is None else 1 / (stretching * width)
    return MembraneLaw(law, ca.SX(soft), ca.SX(long), position)


@dataclass(frozen=True, eq=False)
class MembraneLaw(ConstitutiveLaw):
    """A law of a compliance in edgewise bending, 1 / B1, and one in stretch, 1 / EA; 0 is none."""

    base: ConstitutiveLaw
    soft: ca.SX
    long: ca.SX
    position: ca.SX
    mixture: bool = False

    def __post_init__(self) -> None:
        """Declare what the other law declares, and what is new."""
        for name in (*DECLARED, "states", "controls"):
            object.__setattr__(self, name, getattr(self.base, name))
        if self._bends:
            object.__setattr__(self, "components", (0, *self.base.components))
            object.__setattr__(self, "spins", self._may_spin())
        object.__setattr__(self, "edgewise", self._bends)
        object.__setattr__(self, "stretches", not self.long.is_zero())

    def strain(self, stress: Stress) -> ca.SX:
        read = self._as_rigid(stress) if self.mixture else stress
        return self.base.strain(read) + ca.vertcat(self.soft * stress.m[0], 0, 0)

    def extension(self, stress: Stress) -> ca.SX:
        return self.long * stress.n[2]

    def moment(self, u: ca.SX) -> ca.SX:
        found = self.base.moment(self._without(u))
        return ca.vertcat(u[0] / self.soft, found) if self._bends else found

    def energy(self, u: ca.SX) -> ca.SX | None:
        found = self.base.energy(self._without(u))
        bent = u[0] ** 2 / (2 * self.soft) if self._bends else 0
        return None if found is None else found + bent

    def complementary_energy(self, stress: Stress) -> ca.SX | None:
        found = self.base.complementary_energy(stress)
        return None if found is None else found + self._stored(stress)

    def densities(self, stress: Stress, u: ca.SX) -> tuple[ca.SX, ca.SX]:
        energy, complementary = self.base.densities(stress, self._without(u))
        stored = self._stored(stress)
        work = stress.n[2] * self.extension(stress) + (stress.m[0] * u[0] if self._bends else 0)
        return energy + work - stored, complementary + stored

    def implicit(self, stress: Stress) -> ImplicitLaw:
        found = self.base.implicit(stress)
        if not self._bends:
            return found
        u1, bent = ca.SX.sym("u1"), self.soft * stress.m[0]
        return ImplicitLaw(
            ca.vertcat(u1, found.unknowns),
            ca.vertcat(u1 - bent, found.equations),
            found.bounds,
            ca.vertcat(bent, found.estimate),
        )

    def direct(self) -> ConstitutiveLaw:
        return self._around(self.base.direct())

    def indirect(self) -> ConstitutiveLaw:
        return self._around(self.base.indirect())

    def relaxed(self, stress: Stress) -> Relaxed | None:
        found = self.base.relaxed(stress)
        if found is None:
            return None
        given = ca.SX.sym("in plane", self._scaled(stress).numel())
        there = self._unscaled(given)
        bent = ca.vertcat(self.soft * there.m[0], 0, 0)
        of_stress = ca.vertcat(self.soft * stress.m[0], 0, 0)
        strain, dual = found.strain, found.complementary
        return replace(
            found,
            controls=ca.vertcat(given, found.controls),
            u=found.u + bent,
            cost=found.cost + ca.sumsqr(given) / 2,
            estimate=ca.vertcat(self._scaled(stress), found.estimate),
            extension=self.extension(there),
            strain=None if strain is None else strain + of_stress,
            complementary=None if dual is None else dual + self._stored(stress),
        )

    def controls_at(self, stress: Stress) -> ca.SX:
        return ca.vertcat(self._scaled(stress), self.base.controls_at(stress))

    def stress_of(self, z: ca.SX, own: ca.SX) -> Stress:
        count = int(self._bends) + int(self.stretches)
        found, there = self.base.stress_of(z[count:], own), self._unscaled(z[:count])
        return found._replace(n=found.n + there.n, m=found.m + there.m)

    def in_plane(self) -> ConstitutiveLaw:
        # What bends about d1 is across the plane.
        return replace(self, base=self.base.in_plane(), soft=ca.SX(0))

    def sheet_slope(self, stress: Stress, u: ca.SX) -> ca.SX | None:
        return self.base.sheet_slope(stress, u)

    def rates(self, stress: Stress, u: ca.SX) -> ca.SX:
        return self.base.rates(stress, u)

    def end_conditions(self, end: str, stress: Stress) -> Mapping[str, ca.SX]:
        return self.base.end_conditions(end, stress)

    def own_guess(self, stress: Stress) -> ca.SX:
        return self.base.own_guess(stress)

    def most_rate(self) -> ca.SX:
        return self.base.most_rate()

    def controls_for(self, stress: Stress, rates: ca.SX) -> ca.SX:
        return self.base.controls_for(stress, rates)

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        return self.base.singular(self._as_rigid(stress) if self.mixture else stress)

    def switching(self, stress: Stress) -> Switch:
        return self.base.switching(stress)

    def branch(self, kind: int) -> ConstitutiveLaw:
        return replace(self, base=self.base.branch(kind), mixture=kind == 0)

    def entering(self, kinds: tuple[int, ...], i: int, stress: Stress) -> Mapping[str, ca.SX]:
        return self.base.entering(kinds, i, self._as_rigid(stress) if 0 in kinds else stress)

    def margins(self, kind: int, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        read = stress if kind else self._as_rigid(stress)
        return self.base.margins(kind, read, self._without(u))

    def zeros(self, kind: int, stress: Stress) -> Mapping[str, ca.SX]:
        return self.base.zeros(kind, stress if kind else self._as_rigid(stress))

    @property
    def _bends(self) -> bool:
        """Whether B1 is finite."""
        return not self.soft.is_zero()

    def _around(self, base: ConstitutiveLaw) -> ConstitutiveLaw:
        return self if base is self.base else replace(self, base=base)

    def _scaled(self, stress: Stress) -> ca.SX:
        """Return m1 and n3, those that do work, as controls whose energies are half their squares.

        They come first: those of the other law may be known by their names, from the end.
        """
        both = [ca.sqrt(self.soft) * stress.m[0]] if self._bends else []
        both += [ca.sqrt(self.long) * stress.n[2]] if self.stretches else []
        return ca.vertcat(ca.SX(0, 1), *both)

    def _unscaled(self, given: ca.SX) -> Stress:
        """Return the stress of such controls alone."""
        m1 = given[0] / ca.sqrt(self.soft) if self._bends else 0
        n3 = given[-1] / ca.sqrt(self.long) if self.stretches else 0
        return Stress(ca.vertcat(0, 0, n3), ca.vertcat(m1, 0, 0), ca.SX(0, 1))

    def _without(self, u: ca.SX) -> ca.SX:
        """Return strains without u1, if that is none of the other law's."""
        return ca.vertcat(0, u[1:]) if self._bends else u

    def _stored(self, stress: Stress) -> ca.SX:
        return (self.soft * stress.m[0] ** 2 + self.long * stress.n[2] ** 2) / 2

    def _may_spin(self) -> bool:
        """Whether u2 is m2 / B1 where m3 = 0, in symbols or in numbers, of a law that is linear."""
        if not self.base.linear_at_zero or self.base.natural:
            return False
        u2 = self.base.strain(Stress.of_moment(ca.SX([0.0, 1.0, 0.0])))[1]
        if ca.depends_on(ca.vertcat(u2, self.soft), self.position):
            return False  # B1 is as the cube of the width
        return not u2.is_constant() or not self.soft.is_constant() or bool(u2 == self.soft)

    def _as_rigid(self, stress: Stress) -> Stress:
        """Return the stress under which a rigid mixture is what this one is."""
        rigid = self.base if self.mixture else self.base.branch(0)
        return rigid_stress(rigid, self.soft, self.long, self.position, stress)
