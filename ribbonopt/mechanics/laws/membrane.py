"""Any law with finite stiffness in the ribbon's own plane: edgewise bending B1 and stretch EA.

W(u) + B1 u1^2 / 2 + EA e^2 / 2, r' = (1 + e) d3, so that u1 = m1 / B1 and e = n3 / EA, and
W_Leg(m) + m1^2 / (2 B1) + n3^2 / (2 EA). Without loads n, n . m and H = n3 + all that are constant.
The surface r + v (d2 + eta d3) of a ribbon's law is developable whatever u1 and e are: b' of its
generatrix b has no part along d1. But unrolled it is bent by u1, its edges stretched by u1 w / 2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import casadi as ca

from ribbonopt.errors import ModelError

from .implicit import ImplicitLaw
from .law import ConstitutiveLaw, Stress
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
    """A law of a compliance in edgewise bending, 1 / B1, and one in stretch, 1 / EA; 0 is none.

    Of a mixture of both sides m2' = -(1 + e) n1 - m1 u3 + u1 m3 is zero, as if n1 were
    (1 + e) n1 - u1 m3: `_as_rigid`.
    """

    base: ConstitutiveLaw
    soft: ca.SX
    long: ca.SX
    position: ca.SX
    mixture: bool = False

    def __post_init__(self) -> None:
        """Declare what the other law declares, and what is new."""
        for name in (*DECLARED, "states"):
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

    def relaxed(self, stress: Stress) -> Relaxed | None:
        found = self.base.relaxed(stress)
        if found is None:
            return None
        bent, long = ca.SX.sym("m1"), ca.SX.sym("n3")
        first, last = self._scaled(stress)
        if self._bends:
            found = Relaxed(
                ca.vertcat(bent, found.controls),
                found.u + ca.vertcat(ca.sqrt(self.soft) * bent, 0, 0),
                found.cost + bent**2 / 2,
                found.path,
                ca.vertcat(first, found.estimate),
            )
        if not self.stretches:
            return found
        return Relaxed(
            ca.vertcat(found.controls, long),
            found.u,
            found.cost + long**2 / 2,
            found.path,
            ca.vertcat(found.estimate, last),
            ca.sqrt(self.long) * long,
        )

    def controls(self, stress: Stress) -> ca.SX:
        first, last = self._scaled(stress)
        inner = self.base.controls(stress)
        return ca.vertcat(
            first if self._bends else ca.SX(0, 1), inner, last if self.stretches else ca.SX(0, 1)
        )

    def controlled(self, z: ca.SX, own: ca.SX) -> Stress:
        begin, end = int(self._bends), z.numel() - int(self.stretches)
        found = self.base.controlled(z[begin:end], own)
        n, m = found.n, found.m
        if self._bends:
            m += ca.vertcat(z[0] / ca.sqrt(self.soft), 0, 0)
        if self.stretches:
            n += ca.vertcat(0, 0, z[-1] / ca.sqrt(self.long))
        return found._replace(n=n, m=m)

    def sheet_slope(self, stress: Stress, u: ca.SX) -> ca.SX | None:
        return self.base.sheet_slope(stress, u)

    def rates(self, stress: Stress, u: ca.SX) -> ca.SX:
        return self.base.rates(stress, u)

    def end_conditions(self, end: str, stress: Stress) -> Mapping[str, ca.SX]:
        return self.base.end_conditions(end, stress)

    def own_guess(self, stress: Stress) -> ca.SX:
        return self.base.own_guess(stress)

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

    def _scaled(self, stress: Stress) -> tuple[ca.SX, ca.SX]:
        """Return m1 and n3 as controls of an energy of which each has half its square."""
        return ca.sqrt(self.soft) * stress.m[0], ca.sqrt(self.long) * stress.n[2]

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
        """Return the stress under which a rigid mixture is what this one is.

        What a mixture keeps zero is D = n1* + m1 u3 + c2 - K', n1* = (1 + e) n1 - u1 m3. In D' the
        strain u2 has the factor -(n3* + m3 u3 - m1^2 t), t = du3 / dm3, and the rest of what is new
        there acts as a load along d1.
        """
        n, m, own, load, couple = stress
        soft, long = self.soft, self.long
        rigid, moment = self.base if self.mixture else self.base.branch(0), ca.SX.sym("m", 3)
        torsion = rigid.strain(stress._replace(m=moment))[2]
        along = ca.jtimes(torsion, moment, ca.SX([0.0, 0.0, 1.0]))
        u3, t = ca.substitute([torsion, along], [moment], [m])
        u1, e = soft * m[0], long * n[2]
        f, c = (ca.SX.zeros(3) if some is None else some for some in (load, couple))
        n1 = (1 + e) * n[0] - u1 * m[2]
        n3 = (1 + e) * n[2] - long * n[0] ** 2 - soft * (m[2] ** 2 - m[0] ** 2)
        slopes = (ca.jacobian(some, self.position) for some in (soft, long))
        soft_rate, long_rate = slopes
        new = e * (2 * n[1] * u3 - f[0])
        new += n[0] * (long_rate * n[2] - long * (u1 * n[1] + f[2]))
        new += soft * m[2] * (c[0] - u3 * m[1] - (1 + e) * n[1]) + u1 * (2 * c[2] + u1 * m[1])
        new -= m[0] * (t * u1 * m[1] + soft_rate * m[2])
        force = ca.vertcat(f[0] - new, f[1], f[2])
        return Stress(ca.vertcat(n1, n[1], n3), m, own, force, couple)
