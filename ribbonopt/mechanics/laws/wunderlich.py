"""Wunderlich's law: an inextensible ribbon of finite width w (section 6.3), any natural strains.

Energy per length W = u2^2 e^2 phi / 2, e = 1 + eta^2, phi = xi coth(xi), with the slope eta of the
generatrices as a state of its own, u3 = eta u2 and eta' = (2 / w) tanh(xi). What is stationary over
u2 and xi gives, with the conjugate p of eta,

    A = m2 + eta m3 + K11 + 2 K12 eta + K22 eta^2,    g(xi) = 2 p e^2 / (w A^2),
    u2 = A / (e^2 phi),    p' = 2 eta e u2^2 phi - (m3 + 2 K12 + 2 K22 eta) u2,

g as in `gathering`. Terms linear in the curvature know nothing of phi: natural strains add
C - (K11 + 2 K12 eta + K22 eta^2) u2 to W. Where A = 0 and p is not generatrices meet on an edge
(xi = +-infinity) and the curvature changes its sign; the states are continuous there, eta is not
zero, and u2 vanishes as A / |log A|: a phase ends there. As w -> 0 it is Sadowsky's law.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import casadi as ca

from ribbonopt.classes import dataclass

from .gathering import gathering, log_factor, xi_of
from .law import ConstitutiveLaw, Stress
from .natural import NaturalStrains
from .parts import Relaxed, Singular, Switch
from .relations import nonzero, sheet_moment, sheet_sum

TINY = 1e-120  # of A^2: an unbent ribbon without p has xi = 0
LARGEST = 0.9  # |eta| to begin with: that of Sadowsky's law reaches 1


@dataclass(frozen=True, eq=False)
class WunderlichLaw(ConstitutiveLaw):
    """The law of a width w, in units of L; natural strains k if any. Own states are eta and p."""

    width: ca.SX
    k: NaturalStrains | None = None
    smooth = False
    kinked = True
    fades = True
    closed_moment = False
    switch_name = "m2 + eta m3"
    states = ("eta", "p")

    @property
    def natural(self) -> bool:  # type: ignore[override]
        """Whether it has natural strains."""
        return self.k is not None

    def naturally(self, natural: NaturalStrains) -> ConstitutiveLaw:
        return replace(self, k=natural)

    def in_plane(self) -> ConstitutiveLaw:
        from .bent import BentLaw  # few scenes are held in a plane

        return BentLaw(self) if self.k is None else BentLaw.naturally_bent(self, self.k)

    def direct(self) -> ConstitutiveLaw:
        return DirectWunderlichLaw(self.width, self.k)

    def strain(self, stress: Stress) -> ca.SX:
        eta = stress.own[0]
        u2 = self.bending(stress, self.xi(stress))
        return ca.vertcat(0, u2, eta * u2)

    def moment(self, u: ca.SX) -> ca.SX:
        """Moments of Sadowsky's law, for guesses: these are not of the strains alone."""
        m2, m3 = sheet_moment(u[1], u[2])
        if self.k is None:
            return ca.vertcat(m2, m3)
        eta = u[2] / nonzero(u[1])
        return ca.vertcat(m2 - self.k.K11 + self.k.K22 * eta**2, m3 - 2 * self.linear_slope(eta))

    def energy(self, u: ca.SX) -> ca.SX | None:
        return None  # not of the strains alone: see `densities`

    def complementary_energy(self, stress: Stress) -> ca.SX:
        """Return m . u + p eta' - W, which is H - n3."""
        return self.densities(stress, self.strain(stress))[1]

    def densities(self, stress: Stress, u: ca.SX) -> tuple[ca.SX, ca.SX]:
        xi = self.xi(stress)
        W = self.stored(stress.own[0], u[1], xi)
        return W, ca.dot(stress.m, u) + stress.own[1] * self.turning(xi) - W

    def rates(self, stress: Stress, u: ca.SX) -> ca.SX:
        (eta, _), xi = ca.vertsplit(stress.own), self.xi(stress)
        e, u2 = 1 + eta**2, u[1]
        p = 2 * eta * e * u2**2 * log_factor(xi) - (stress.m[2] + 2 * self.linear_slope(eta)) * u2
        return ca.vertcat(self.turning(xi), p)

    def own_guess(self, stress: Stress) -> ca.SX:
        """Return the slope that Sadowsky's law has, and p = 0."""
        m2, m3 = stress.m[1], stress.m[2]
        sheet = ca.if_else(m2 < 0, -1, 1)
        eta = m3 / nonzero(sheet_sum(m2, m3, sheet)) * sheet
        return ca.vertcat(LARGEST * eta, 0)

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        return (Singular(self.force(stress), ca.SX(0), self._leap(stress), fades=1.0),)

    def switching(self, stress: Stress) -> Switch:
        return Switch(self.force(stress), self._leap(stress))

    def entering(self, kinds: tuple[int, ...], i: int, stress: Stress) -> Mapping[str, ca.SX]:
        return {f"{self.switch_name} = 0": self.force(stress)}

    def margins(self, kind: int, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        wrong = f"{self.switch_name} has the wrong sign {{where}}: no equilibrium of this ribbon"
        return {wrong: kind * self.force(stress)}

    def force(self, stress: Stress) -> ca.SX:
        """Return A, what bends the ribbon across its generatrices."""
        eta = stress.own[0]
        return stress.m[1] + eta * stress.m[2] + self.linear(eta)

    def xi(self, stress: Stress) -> ca.SX:
        """Return xi, by which the generatrices gather."""
        eta, p = ca.vertsplit(stress.own)
        return xi_of(2 * p * (1 + eta**2) ** 2 / (self.width * (self.force(stress) ** 2 + TINY)))

    def bending(self, stress: Stress, xi: ca.SX) -> ca.SX:
        """Return u2 at a stress and xi."""
        return self.force(stress) / ((1 + stress.own[0] ** 2) ** 2 * log_factor(xi))

    def turning(self, xi: ca.SX) -> ca.SX:
        """Return eta'."""
        return 2 / self.width * ca.tanh(xi)

    def stored(self, eta: ca.SX, u2: ca.SX, xi: ca.SX) -> ca.SX:
        """Return the strain energy W per length."""
        W = u2**2 * (1 + eta**2) ** 2 * log_factor(xi) / 2
        return W if self.k is None else W - self.linear(eta) * u2 + self.k.constant

    def linear(self, eta: ca.SX) -> ca.SX:
        """Return K11 + 2 K12 eta + K22 eta^2."""
        return (
            ca.SX(0) if self.k is None else self.k.K11 + (2 * self.k.K12 + self.k.K22 * eta) * eta
        )

    def linear_slope(self, eta: ca.SX) -> ca.SX:
        """Return half its derivative."""
        return ca.SX(0) if self.k is None else self.k.K12 + self.k.K22 * eta

    @staticmethod
    def _leap(stress: Stress) -> ca.SX:
        """Return what is zero in a ribbon that stays in a plane, where all is smooth."""
        return sum(map(ca.fabs, ca.vertsplit(stress.own)[1:]), ca.fabs(stress.m[2]))


@dataclass(frozen=True, eq=False)
class DirectWunderlichLaw(WunderlichLaw):
    """The same in the energy form: eta is a state, u2 and xi are controls, p is a costate.

    There p follows from xi where n and m do: p = w A^2 g(xi) / (2 e^2). Without its controls the
    law is that of parallel generatrices.
    """

    states = ("eta",)  # type: ignore[assignment]
    controls = ("u2", "xi")

    def direct(self) -> ConstitutiveLaw:
        return self

    def indirect(self) -> WunderlichLaw:
        return WunderlichLaw(self.width, self.k)

    def xi(self, stress: Stress) -> ca.SX:
        return ca.SX(0)

    def densities(self, stress: Stress, u: ca.SX) -> tuple[ca.SX, ca.SX]:
        W = self.stored(stress.own[0], u[1], ca.SX(0))
        return W, ca.dot(stress.m, u) - W

    def rates(self, stress: Stress, u: ca.SX) -> ca.SX:
        return ca.SX(1, 1)

    def own_guess(self, stress: Stress) -> ca.SX:
        return super().own_guess(stress)[0]

    def most_rate(self) -> ca.SX:
        return 2 / self.width

    def controls_for(self, stress: Stress, rates: ca.SX) -> ca.SX:
        xi = ca.atanh(rates * self.width / 2)
        return ca.vertcat(self.bending(stress, xi), xi)

    def controls_at(self, stress: Stress) -> ca.SX:
        xi = self.indirect().xi(stress)
        return ca.vertcat(self.bending(stress, xi), xi)

    def relaxed(self, stress: Stress) -> Relaxed:
        z, eta = ca.SX.sym("u2 and xi", 2), stress.own[0]
        u2, xi = ca.vertsplit(z)
        u, W, rate = ca.vertcat(0, u2, eta * u2), self.stored(eta, u2, xi), self.turning(xi)
        balanced = self.bending(stress, xi)
        p = self.width / 2 * (self.force(stress) / (1 + eta**2)) ** 2 * gathering(xi)
        return Relaxed(
            controls=z,
            u=u,
            cost=W,
            path=ca.SX(0, 1),
            estimate=ca.vertcat(self.bending(stress, ca.SX(0)), 0),
            rates=rate,
            strain=ca.vertcat(0, balanced, eta * balanced),
            complementary=ca.dot(stress.m, u) + p * rate - W,
            own={"p": p},
        )
