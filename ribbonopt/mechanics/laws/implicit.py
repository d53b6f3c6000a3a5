"""Constitutive laws as equations between strains and moments, for the differential-algebraic form.

Laws with an energy in closed form say 0 = dW/du - m, eq. (3.1b). The others are polynomial in the
strains and one or two further unknowns:

- (6.1), (C 1): eta with m3 (1 - eta^2) = 2 m2 eta, that is eta^2 = lambda*, eq. (4.2);
- the variational law: its two norms q and M.
"""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca

from ribbonopt.classes import dataclass

from .relations import Components, norm


@dataclass(frozen=True, eq=False)
class ImplicitLaw:
    """A law as equations in strains and, for some laws, further unknowns.

    Attributes
    ----------
    unknowns : SX (k,) symbols
        The strains that the law leaves free, then further unknowns.
    equations : SX (k,)
        Zero where the law holds.
    bounds : SX (nb,)
        Not positive where the law holds on the branch that eq. (4.1) allows.
    estimate : SX (k,)
        The unknowns at the moments, explicitly: where a solver may start.
    """

    unknowns: ca.SX
    equations: ca.SX
    bounds: ca.SX
    estimate: ca.SX


def bounded(moments: Callable[[ca.SX, ca.SX], Components], strain: ca.SX, m: ca.SX) -> ImplicitLaw:
    """0 = dW/du - m, with |eta| <= 1 as u3^2 <= u2^2."""
    u = ca.SX.sym("u", 2)
    equations = ca.vertcat(*moments(u[0], u[1])) - m[1:]
    return ImplicitLaw(u, equations, ca.vertcat(u[1] ** 2 - u[0] ** 2), strain[1:])


def polynomial_form(rho: ca.SX | float, epsilon: ca.SX, strain: ca.SX, m: ca.SX) -> ImplicitLaw:
    """Eq. (C 1) without roots; of the two eta that solve the first equation one has |eta| <= 1."""
    z, m2, m3 = ca.SX.sym("u", 3), m[1], m[2]
    u2, u3, eta = z[0], z[1], z[2]
    squared = rho * eta**2
    equations = ca.vertcat(
        m3 * (1 - eta**2) - 2 * m2 * eta,
        2 * u3 * (1 + squared) - m3,
        u2 * (1 - squared + rho * epsilon) * (1 + squared) - m2,
    )
    start = m3 / (ca.fabs(m2) + norm(m2, m3)) * ca.if_else(m2 < 0, -1, 1)
    return ImplicitLaw(z, equations, ca.vertcat(eta**2 - 1), ca.vertcat(strain[1:], start))


def norm_form(delta: ca.SX, strain: ca.SX, m: ca.SX) -> ImplicitLaw:
    """Variational law: u = (q + M)/4 (m / M + (m2, delta^2 m3) / q), q and M from their squares."""
    z, m2, m3 = ca.SX.sym("u", 4), m[1], m[2]
    u2, u3, q, M = z[0], z[1], z[2], z[3]
    size = norm(m2, m3)  # brings all equations to the size of the strains
    equations = ca.vertcat(
        (q**2 - m2**2 - (delta * m3) ** 2) / size,
        (M**2 - m2**2 - m3**2) / size,
        (4 * q * M * u2 - m2 * (q + M) ** 2) / size**2,
        (4 * q * M * u3 - m3 * (q + M) * (q + delta**2 * M)) / size**2,
    )
    bounds = ca.vertcat(-q, -M)
    estimate = ca.vertcat(strain[1:], norm(m2, delta * m3), norm(m2, m3))
    return ImplicitLaw(z, equations, bounds, estimate)
