"""Formulas that several constitutive laws share, in the notation of `laws`."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca

GUARD = 1e-60
TINY = 1e-150  # stands for an exact zero in a denominator; its square is still a normal number

Components = tuple[ca.SX, ca.SX]


def sadowsky_energy(u2: ca.SX, u3: ca.SX) -> ca.SX:
    """W_S of eq. (2.8): (u2^2 + u3^2)^2 / (2 u2^2)."""
    return (u2 + u3 * (u3 / nonzero(u2))) ** 2 / 2


def convexified_energy(u2: ca.SX, u3: ca.SX) -> ca.SX:
    """W_F: W_S where |eta| <= 1 and 2 u3^2 beyond (section 4)."""
    allowed = ca.fabs(u2) >= ca.fabs(u3)
    return ca.if_else(allowed, sadowsky_energy(ca.if_else(allowed, u2, 1), u3), 2 * u3**2)


def sadowsky_complementary_energy(m2: ca.SX, m3: ca.SX) -> ca.SX:
    """W_Leg of eq. (7.2) with its first root mended: (|m2| + M)^2 / 8."""
    return (ca.fabs(m2) + norm(m2, m3)) ** 2 / 8


def norm(a: ca.SX, b: ca.SX) -> ca.SX:
    """Guarded length of (a, b), differentiable at zero."""
    return ca.sqrt(a**2 + b**2 + GUARD**2)


def nonzero(a: ca.SX) -> ca.SX:
    """Return a, or something tiny where it is exactly zero."""
    return ca.if_else(a == 0, TINY, a)


def sheet_moment(u2: ca.SX, u3: ca.SX) -> Components:
    """Eqs. (2.4)-(2.5), the first factored so that it does not cancel near |eta| = 1."""
    eta = u3 / nonzero(u2)
    return (u2 - u3) * (1 + eta) * (1 + eta**2), 2 * u3 * (1 + eta**2)


def sheet_sum(m2: ca.SX, m3: ca.SX, chi: ca.SX | float) -> ca.SX:
    """Chi m2 + M, without cancellation where chi m2 < 0."""
    M, a = norm(m2, m3), chi * m2
    return ca.if_else(a >= 0, M + a, (m3**2 + GUARD**2) / (M + ca.fabs(a)))


def blended_strain(
    m2: ca.SX,
    m3: ca.SX,
    rho: ca.SX | float,
    epsilon: ca.SX,
    chi: float | None = None,
) -> Components:
    """Eq. (C 1) with numerators and denominators multiplied by M + mu.

    With a sheet chi, mu = |m2| is continued as chi m2: analytic where m2 changes sign.
    """
    if chi is None:
        mu = ca.fabs(m2)
        s = norm(m2, m3) + mu
    else:
        mu, s = chi * m2, sheet_sum(m2, m3, chi)
    torsion = s + rho * (m3**2 / s)
    return m2 * s**2 / (bending(mu, s, rho, epsilon) * torsion), m3 * s / (2 * torsion)


def bending(mu: ca.SX, s: ca.SX, rho: ca.SX | float, epsilon: ca.SX) -> ca.SX:
    """Return what divides the bending strain of eq. (C 1), with s = M + mu; zero at its pole."""
    return (1 - rho) * s + rho * (2 * mu + epsilon * s) + TINY


def inverse(strain: Callable[[ca.SX, ca.SX], Components], u2: ca.SX, u3: ca.SX) -> Components:
    """Moments at given strains for a 1-homogeneous, sign-preserving, monotone law.

    Homogeneity leaves one unknown, t = log |m2 / m3|, found by bisection on the ratio of the
    strains and two Newton steps (through which derivatives flow); the larger strain then gives the
    scale.
    """

    def direction(t: ca.SX) -> Components:
        return ca.exp(ca.fmin(t, 0)), ca.exp(ca.fmin(-t, 0))

    def log_ratio(t: ca.SX) -> ca.SX:
        a, b = strain(*direction(t))
        return ca.log(a / b)

    target = ca.log((ca.fabs(u2) + TINY) / (ca.fabs(u3) + TINY))
    t, step = ca.SX(0), 64.0
    while step > 1e-10:
        t = t + step * ca.sign(target - log_ratio(t))
        step /= 2
    x = ca.SX.sym("x")
    newton_step = (target - log_ratio(x)) / ca.gradient(log_ratio(x), x)
    rest = 2 * step  # what bisection leaves open
    for _ in range(2):
        # The bracket's width bounds the step where the law is flat (|eta| > 1, epsilon = 0).
        t = t + ca.fmax(-rest, ca.fmin(rest, ca.substitute(newton_step, x, t)))
    e2, e3 = direction(t)
    a, b = strain(e2, e3)
    # By the larger strain: where |eta| > 1 at epsilon = 0, u2 is anything up to |u3|.
    scale = ca.if_else(ca.fabs(u3) >= ca.fabs(u2), ca.fabs(u3) / b, ca.fabs(u2) / a)
    return ca.sign(u2) * e2 * scale, ca.sign(u3) * e3 * scale
