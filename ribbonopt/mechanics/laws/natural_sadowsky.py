"""Sadowsky's law with natural strains, and its sheets: the inverse is explicit for any nu.

lambda is the eigenvalue of largest modulus, t its eigenvector, of [[m2 + K11, c/2], [c/2, K22]]:

    u2 = (|T| + R) (sign(T) R + D) / (4 R), u3 = (|T| + R) c / (4 R), W_Leg = (|T| + R)^2 / 8 - C.

On a sheet chi stands in the place of sign(T), chi T in that of |T|. At R = 0 both eigenvalues are
the same and the strains are any of a disc: the law is singular there.
"""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from ribbonopt.classes import dataclass

from .implicit import ImplicitLaw
from .law import ConstitutiveLaw, RibbonLaw, Stress
from .natural import (
    NaturalStrains,
    affine_energy,
    mixed_energy,
    sheet_energy,
    sheet_moments,
    stable_sum,
)
from .natural_mixture import NaturalMixtureLaw
from .natural_sides import WORDS, NaturalSides
from .parts import Relaxed, Singular, Switch
from .relations import Components


@dataclass(frozen=True, eq=False)
class NaturalSadowskyLaw(RibbonLaw):
    """Both sheets; energy W_F, convexified. At T = 0 `strains` are the middle of the leap."""

    k: NaturalStrains
    natural = True
    bounds_eta = True
    smooth = False
    kinked = True
    switch_name = WORDS

    def in_plane(self) -> ConstitutiveLaw:
        from .bent import BentLaw  # few scenes are held in a plane

        return BentLaw.naturally_bent(self, self.k)

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        T, D, c, R = self.k.combined(m2, m3)
        size = (ca.fabs(T) + R) / (4 * R)
        return size * stable_sum(ca.sign(T), D, c, R), size * c

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        k, (mixed, affine) = self.k, self._beyond(u2, u3)
        m2, m3 = sheet_moments(k, ca.if_else(ca.logic_or(mixed, affine), 1, u2), u3)
        m2 = ca.if_else(mixed, -k.K11 - k.K22, ca.if_else(affine, k.K22 - k.K11, m2))
        return m2, ca.if_else(mixed, 4 * u3, ca.if_else(affine, 0, m3 + 2 * k.K12)) - 2 * k.K12

    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        k, (mixed, affine) = self.k, self._beyond(u2, u3)
        on_sheet = sheet_energy(k, ca.if_else(ca.logic_or(mixed, affine), 1, u2), u3)
        rest = ca.if_else(affine, affine_energy(k, u2, u3), on_sheet)
        return ca.if_else(mixed, mixed_energy(k, u2, u3), rest)

    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        T, _, _, R = self.k.combined(m2, m3)
        return (ca.fabs(T) + R) ** 2 / 8 - self.k.constant

    def implicit(self, stress: Stress) -> ImplicitLaw:
        return on_sheets(self.k, self.strain(stress), stress.m)

    def relaxed(self, stress: Stress) -> Relaxed:
        """W_F = min over b and t of t^2 / 2 - K : b + C, t at least |u2 + b| and the other norm."""
        z, strain, k = ca.SX.sym("u", 4), self.strain(stress), self.k
        u2, u3, b, t = ca.vertsplit(z)
        path = ca.vertcat(u2 + b - t, -u2 - b - t, (u2 - b) ** 2 + 4 * u3**2 - t**2)
        cost = t**2 / 2 - k.work(u2, u3) - k.K22 * b + k.constant
        T, D, c, R = k.combined(stress.m[1], stress.m[2])
        size = (ca.fabs(T) + R) / (4 * R)
        across = size * stable_sum(ca.sign(T), -D, c, R)
        estimate = ca.vertcat(strain[1:], across, (ca.fabs(T) + R) / 2)
        return Relaxed(z, ca.vertcat(0, u2, u3), cost, path, estimate)

    def sheet_slope(self, stress: Stress, u: ca.SX) -> ca.SX:
        return self.k.slope(u[1], u[2])

    def layers(self, m2: ca.SX, m3: ca.SX) -> tuple[Components, ...]:
        return ()

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        return (where_equal(self.k, stress),)

    def switching(self, stress: Stress) -> Switch:
        return self._sides.switching(stress)

    def branch(self, kind: int) -> ConstitutiveLaw:
        return NaturalSheetLaw(ca.SX(kind), self.k) if kind else NaturalMixtureLaw(self._sides)

    def entering(self, kinds: tuple[int, ...], i: int, stress: Stress) -> Mapping[str, ca.SX]:
        return self._sides.entering(kinds, i, stress)

    def margins(self, kind: int, stress: Stress, u: ca.SX) -> Mapping[str, ca.SX]:
        return self._sides.margins(kind, stress, u)

    def zeros(self, kind: int, stress: Stress) -> Mapping[str, ca.SX]:
        return self._sides.zeros(kind, stress)

    @property
    def _sides(self) -> NaturalSides:
        return NaturalSides(self.k)

    def _beyond(self, u2: ca.SX, u3: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Whether strains are those of a mixture, and whether they are inside the disc."""
        K22 = self.k.K22
        return u3**2 > u2**2 + K22 * u2, u2**2 + u3**2 < K22 * u2


@dataclass(frozen=True, eq=False)
class NaturalSheetLaw(RibbonLaw):
    """The sheet chi of the same law; analytic across T = 0."""

    chi: ca.SX
    k: NaturalStrains
    natural = True
    bounds_eta = True
    switch_name = WORDS

    def strains(self, m2: ca.SX, m3: ca.SX) -> Components:
        T, D, c, R = self.k.combined(m2, m3)
        size = (self.chi * T + R) / (4 * R)
        return size * stable_sum(self.chi, D, c, R), size * c

    def moments(self, u2: ca.SX, u3: ca.SX) -> Components:
        return sheet_moments(self.k, u2, u3)

    def stored(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        return sheet_energy(self.k, u2, u3)

    def complementary(self, m2: ca.SX, m3: ca.SX) -> ca.SX:
        T, _, _, R = self.k.combined(m2, m3)
        return (self.chi * T + R) ** 2 / 8 - self.k.constant

    def implicit(self, stress: Stress) -> ImplicitLaw:
        return on_sheets(self.k, self.strain(stress), stress.m)

    def sheet_slope(self, stress: Stress, u: ca.SX) -> ca.SX:
        return self.k.slope(u[1], u[2])

    def singular(self, stress: Stress) -> tuple[Singular, ...]:
        return (where_equal(self.k, stress),)

    def switching(self, stress: Stress) -> Switch:
        return NaturalSides(self.k).switching(stress)


def on_sheets(k: NaturalStrains, strain: ca.SX, m: ca.SX) -> ImplicitLaw:
    """0 = dW/du - m on the sheets, where T has their sign and out of the disc."""
    u = ca.SX.sym("u", 2)
    equations = ca.vertcat(*sheet_moments(k, u[0], u[1])) - m[1:]
    bounds = ca.vertcat(u[1] ** 2 - u[0] ** 2 - k.K22 * u[0], k.K22 * u[0] - u[0] ** 2 - u[1] ** 2)
    return ImplicitLaw(u, equations, bounds, strain[1:])


def where_equal(k: NaturalStrains, stress: Stress) -> Singular:
    """R = 0: D = c = 0."""
    _, D, c, _ = k.combined(stress.m[1], stress.m[2])
    return Singular(D, c, NaturalSides(k).switching(stress).leap)
