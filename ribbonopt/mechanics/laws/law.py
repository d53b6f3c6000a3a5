"""What a constitutive law says: relations between the strains u and the moments m of a section.

Components along the directors d1 (normal), d2 (across the width), d3 (tangent); units Dw = L = 1.
Every law takes and gives whole vectors: u = (u1, u2, u3), and the `Stress` of a section. What a law
has beyond `strain` it declares (see the attributes), and generic code asks for that, never for a
type. `components` are those strains that it leaves free: (1, 2) for a ribbon that does not bend in
its own plane, u1 = 0; (0, 1, 2) for a rod with finite B1.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING

import casadi as ca

from .energy_form import EnergyForm
from .implicit import ImplicitLaw
from .parts import Singular, Stress, Switch

if TYPE_CHECKING:
    from .natural import NaturalStrains

__all__ = ["ConstitutiveLaw", "RibbonLaw", "Stress"]


class ConstitutiveLaw(EnergyForm, ABC):
    """A relation between strains and moments; see the module for frame and units."""

    #: a strain energy exists, so that H = W_Leg + n3 is an invariant (section 7)
    variational: bool = True
    #: the law demands |eta| <= 1 of a solution, eq. (4.1)
    bounds_eta: bool = False
    #: strains are those of a developable surface, whose generatrices may meet
    developable: bool = True
    #: the complementary energy is differentiable away from m = 0
    smooth: bool = True
    #: differentiable at m = 0 too, so that a straight ribbon without stress has a linearisation
    linear_at_zero: bool = False
    #: strains without stress are not zero, so that no straight ribbon is without stress
    natural: bool = False
    #: turning all sections by one angle about d3 changes nothing, or may: a rod that spins freely
    spins: bool = False
    #: u1 = m1 / B1 beside a ribbon's law, which knows nothing of it
    edgewise: bool = False
    #: the centre line stretches: r' = (1 + e) d3, `extension`
    stretches: bool = False
    #: strains have a kink or a jump where `switching` changes sign; `branch` continues either side
    kinked: bool = False
    #: its sides are two sheets that may mix, as Sadowsky's
    sheeted: bool = False
    #: strains fade away with a logarithm where it switches, which a mesh must gather to
    fades: bool = False
    #: what `switching` is called in words
    switch_name: str = "m2"
    #: `moment` is exact and a closed form, cheap to differentiate; else it serves guesses only
    closed_moment: bool = True

    @abstractmethod
    def strain(self, stress: Stress) -> ca.SX:
        """Strains (3,) at a stress."""

    @abstractmethod
    def moment(self, u: ca.SX) -> ca.SX:
        """Moments at strains u (3,): those of `components`, (k,)."""

    @abstractmethod
    def energy(self, u: ca.SX) -> ca.SX | None:
        """Strain energy W(u) per length, or None."""

    @abstractmethod
    def complementary_energy(self, stress: Stress) -> ca.SX | None:
        """Legendre transform W_Leg(m) of the energy, eq. (7.1), or None."""

    def implicit(self, stress: Stress) -> ImplicitLaw:
        """Return the law at a stress as equations for its strains, eq. (3.1b).

        Where the moment is no closed form they are the inverse law itself.
        """
        u, free = ca.SX.sym("u", len(self.components)), list(self.components)
        strain = self.strain(stress)[free]
        closed = self.closed_moment
        equations = self.moment(self.whole(u)) - stress.m[free] if closed else u - strain
        return ImplicitLaw(u, equations, ca.SX(0, 1), strain)

    def densities(self, stress: Stress, u: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Strain energy W and complementary energy per length, W + W_Leg = m . u.

        Errors of u enter in second order. A law without an energy has none: both are m . u / 2, to
        which they are equal for any 2-homogeneous energy, and the drift of H tells how far the law
        is from having one.
        """
        work = ca.dot(stress.m, u)
        found = self.complementary_energy(stress)
        return (work / 2, work / 2) if found is None else (work - found, found)

    def extension(self, stress: Stress) -> ca.SX:
        """Extension e of the centre line, r' = (1 + e) d3."""
        return ca.SX(0)

    def direct(self) -> ConstitutiveLaw:
        """Return the law as the energy form states it: without those states that are costates."""
        return self

    def indirect(self) -> ConstitutiveLaw:
        """Return the law with all its states, of which conditions speak; `direct` backwards."""
        return self

    def sheet_slope(self, stress: Stress, u: ca.SX) -> ca.SX | None:
        """Return what is at most 1 in size where a sheet allows strains u (3,); None where eta is.

        Its sign is that of the sheet.
        """
        return None

    def naturally(self, natural: NaturalStrains) -> ConstitutiveLaw | None:
        """Return the law of the same ribbon with any natural strains.

        None where these can only shift the moments, so that K22 must be zero: `shifted`.
        """
        return None

    def in_plane(self) -> ConstitutiveLaw:
        """Return the law of a ribbon that stays in the plane across d2, of no curvature across it.

        There m1 = m3 = 0 and natural strains but that along are zero. The law itself where it is no
        simpler.
        """
        return self

    def at_width(self, width: ca.SX) -> ConstitutiveLaw:
        """Return the law, per width, where the ribbon has another width, in units of its own.

        The law itself where a strip of it knows nothing of how wide it is.
        """
        return self

    # Own states: none but for laws that declare them.

    def rates(self, stress: Stress, u: ca.SX) -> ca.SX:
        """Return the derivatives of its own states along s."""
        return ca.SX(0, 1)

    def end_conditions(self, end: str, stress: Stress) -> Mapping[str, ca.SX]:
        """Return its own conditions at an end, start or end, by name."""
        return {}

    def own_guess(self, stress: Stress) -> ca.SX:
        """Return where to start its own states, from n and m."""
        return ca.SX(0, 1)

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        """Return where strains are singular functions of complex s; nowhere if nothing is known."""
        return ()

    # Switching: of use to kinked laws, and to find phases for them on solutions of smooth ones.

    def switching(self, stress: Stress) -> Switch:
        """Return what changes sign where a ribbon's curvature does: m2, with a leap if twisted."""
        return Switch(stress.m[1], ca.fabs(stress.m[2]))

    def branch(self, kind: int) -> ConstitutiveLaw:
        """Return the law of one side of the switch (+1, -1), or of a mixture of both (0).

        Analytic across the switch.
        """
        return self

    def entering(self, kinds: tuple[int, ...], i: int, stress: Stress) -> Mapping[str, ca.SX]:
        """Conditions, by name, where phase i > 0 of phases of these kinds begins.

        As many in all as there are phases after the first: their lengths are unknown.
        """
        return {}

    def margins(self, kind: int, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        """Return what must not be negative along a phase, by what is wrong where it is."""
        return {}

    def zeros(self, kind: int, stress: Stress) -> Mapping[str, ca.SX]:
        """Return what must be zero along a phase, by what is wrong where it is not."""
        return {}


class RibbonLaw(ConstitutiveLaw):
    """A law of (u2, u3) and (m2, m3) alone, with u1 = 0: what an inextensible ribbon has.

    It is written in pairs of scalars, CasADi symbols or numbers, as the paper does.
    """

    @abstractmethod
    def strains(self, m2: ca.SX, m3: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Strains (u2, u3) at the moments (m2, m3)."""

    @abstractmethod
    def moments(self, u2: ca.SX, u3: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Moments (m2, m3) at the strains (u2, u3)."""

    @abstractmethod
    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX | None:
        """Strain energy W(u2, u3) per length, or None."""

    @abstractmethod
    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX | None:
        """Complementary energy W_Leg(m2, m3) per length, or None."""

    def strain(self, stress: Stress) -> ca.SX:
        return ca.vertcat(0, *self.strains(stress.m[1], stress.m[2]))

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        """Where m2 = m3 = 0; see `layers` for what else there is."""
        if self.linear_at_zero:
            return ()
        m2, m3 = stress.m[1], stress.m[2]
        size = self.nonlinear * ca.fabs(m3)
        return tuple(Singular(*pair, size) for pair in ((m2, m3), *self.layers(m2, m3)))

    @property
    def nonlinear(self) -> ca.SX | float:
        """How far the law is from a linear one: the size of its layers over |m3|."""
        return 1.0

    def layers(self, m2: ca.SX, m3: ca.SX) -> tuple[tuple[ca.SX, ca.SX], ...]:
        """Real and imaginary parts of what vanishes where the law is singular beside m = 0."""
        return ()

    def moment(self, u: ca.SX) -> ca.SX:
        return ca.vertcat(*self.moments(u[1], u[2]))

    def energy(self, u: ca.SX) -> ca.SX | None:
        return self.stored(u[1], u[2])

    def complementary_energy(self, stress: Stress) -> ca.SX | None:
        return self.complementary(stress.m[1], stress.m[2])
