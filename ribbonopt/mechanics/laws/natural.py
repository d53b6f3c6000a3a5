"""Natural strains: a ribbon that is curved, twisted or dished when it is free.

A plate with the natural curvature tensor k = [[k11, k12], [k12, k22]] (along, twist, across) and
Poisson's ratio nu, bent to the developable surface b = lambda t t^T, t = (cos, sin)(theta) with
tan(theta) = eta, has the energy per length

    W = lambda^2 / 2 - t . K t lambda + C,    u2 = lambda cos^2, u3 = lambda cos sin,
    K11 = k11 + nu k22, K22 = k22 + nu k11, K12 = (1 - nu) k12,
    C = [(1 - nu) (k11^2 + 2 k12^2 + k22^2) + nu (k11 + k22)^2] / 2.

All that laws need of the moments are then T = m2 + K11 + K22, D = m2 + K11 - K22, c = m3 + 2 K12
and R = sqrt(D^2 + c^2): (T +- R) / 2 are the eigenvalues of [[m2 + K11, c / 2], [c / 2, K22]].
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import casadi as ca

from ribbonopt.classes import dataclass

from .relations import nonzero, norm

NAMES = ("curvature", "twist", "across", "poisson_ratio")
TINY = 1e-30  # of strains: what vanishes has no slope


class Combined(NamedTuple):
    """T, D, c and R of the moments."""

    T: ca.SX
    D: ca.SX
    c: ca.SX
    R: ca.SX


@dataclass(frozen=True, eq=False)
class NaturalStrains:
    """Natural curvatures along, twist and across and Poisson's ratio, in units L = 1.

    Symbols, expressions of them and of the arclength `position`, or numbers. All here is of the
    unit width; `width` is asked where a ribbon has another, that varies.
    """

    k11: ca.SX
    k12: ca.SX
    k22: ca.SX
    nu: ca.SX
    position: ca.SX
    width: ca.SX | float = 1.0

    @cached_property
    def K11(self) -> ca.SX:
        return self.k11 + self.nu * self.k22

    @cached_property
    def K22(self) -> ca.SX:
        return self.k22 + self.nu * self.k11

    @cached_property
    def K12(self) -> ca.SX:
        return (1 - self.nu) * self.k12

    @cached_property
    def constant(self) -> ca.SX:
        """The energy C per length of a flat ribbon."""
        squares = self.k11**2 + 2 * self.k12**2 + self.k22**2
        return ((1 - self.nu) * squares + self.nu * (self.k11 + self.k22) ** 2) / 2

    def rate(self, value: ca.SX, order: int = 1) -> ca.SX:
        """Return a derivative along s of the width times an expression of these, over the width.

        Zero where nothing varies.
        """
        found = ca.SX(self.width * value)
        for _ in range(order):
            found = ca.jacobian(found, self.position)
        return found / self.width

    def combined(self, m2: ca.SX, m3: ca.SX) -> Combined:
        """Return T, D, c and R at the moments."""
        bent, c = m2 + self.K11, m3 + 2 * self.K12
        D = bent - self.K22
        return Combined(bent + self.K22, D, c, norm(D, c))

    def shifted(self, m2: ca.SX, m3: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Return the moments at which a law without natural strains has the same strains.

        That is so where K22 = 0.
        """
        return m2 + self.K11, m3 + 2 * self.K12

    def work(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        """Return what W of the strains loses by the shift, but for the constant."""
        return self.K11 * u2 + 2 * self.K12 * u3

    def slope(self, u2: ca.SX, u3: ca.SX) -> ca.SX:
        """Return what is at most 1 in size where u3^2 <= u2^2 + K22 u2 and u2^2 + u3^2 >= K22 u2.

        |eta| where K22 = 0, with the sign of u2. The first says that T has the sign of its sheet,
        the second keeps out of the disc on which the convexified energy is affine.
        """
        half = self.K22 / 2
        past = norm(half, u3) / (ca.fabs(u2 + half) + TINY)
        inside = ca.fabs(half) / (norm(u2 - half, u3) + TINY)
        # What is zero has no slope: u2 = u3 = 0 is a strip that is curved across alone.
        some = norm(u2, u3) > TINY
        side = ca.if_else(u2 + half < 0, -1, 1)
        return ca.if_else(some, side * ca.fmax(past, inside), 0)


def stable_sum(sigma: ca.SX, D: ca.SX, c: ca.SX, R: ca.SX) -> ca.SX:
    """Sigma R + D, without cancellation; sigma is a sign or zero."""
    beyond = sigma * c**2 / (R + ca.fabs(D))
    return ca.if_else(sigma * D >= 0, sigma * R + D, beyond)


def sheet_moments(k: NaturalStrains, u2: ca.SX, u3: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Moments of strains on a sheet: m2 = u2 (1 - eta^4) - K11 + K22 eta^2, and m3."""
    eta = u3 / nonzero(u2)
    m2 = (u2 - u3) * (1 + eta) * (1 + eta**2) - k.K11 + k.K22 * eta**2
    return m2, 2 * u3 * (1 + eta**2) - 2 * k.K12 - 2 * k.K22 * eta


def affine_energy(k: NaturalStrains, u2: ca.SX, u3: ca.SX) -> ca.SX:
    """Energy on the disc u2^2 + u3^2 < K22 u2, where m2 = K22 - K11 and m3 = -2 K12."""
    return k.K22 * u2 - k.work(u2, u3) - k.K22**2 / 2 + k.constant


def mixed_energy(k: NaturalStrains, u2: ca.SX, u3: ca.SX) -> ca.SX:
    """Energy where u3^2 > u2^2 + K22 u2, a mixture of both sheets: T = 0, c = 4 u3."""
    rest = k.K22 * u2 + k.K22**2 / 2 - k.constant
    return 2 * u3**2 - k.work(u2, u3) - rest


def sheet_energy(k: NaturalStrains, u2: ca.SX, u3: ca.SX) -> ca.SX:
    """W of the strains on a sheet, with b22 = u3^2 / u2 across."""
    across = u3 * (u3 / nonzero(u2))
    return (u2 + across) ** 2 / 2 - k.work(u2, u3) - k.K22 * across + k.constant
