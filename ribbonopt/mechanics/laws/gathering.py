"""How the generatrices of a ribbon of finite width gather: the functions of xi of Wunderlich's law.

The width runs along generatrices whose curvature varies as 1 / (1 - z tanh(xi)), -1 <= z <= 1, from
edge to edge: xi = 0 where they are parallel, and at infinity where they meet on an edge. Averaged
over the width that gives the factor phi = xi coth(xi) of the energy, whose slope over tanh' is

    g(xi) = (sinh 2 xi - 2 xi) / (4 xi^2), odd and increasing: xi / 3 + xi^3 / 15 + ...
"""

from __future__ import annotations

from functools import cache

import casadi as ca

NEAR = 0.05  # g below which its series is used: there the closed form cancels
STEPS = 4  # of Newton's method beyond, from where they leave rounding only
FLAT = 1e-3  # xi below which phi is 1 + xi^2 / 3 to rounding
#: g = sum of c_i xi^(2 i + 1)
SERIES = (1 / 3, 1 / 15, 2 / 315, 1 / 2835, 2 / 155925)
#: xi = sum of c_i g^(2 i + 1), that series turned around (exact fractions, rounded)
TURNED = (
    *(3.0, -5.4, 24.53142857142857, -145.61485714285715, 983.8984341372912, -7178.270066253746),
    *(55100.88033596575, -438529.639963054, 3585795.886704284, -29942772.36499402),
)


def log_factor(xi: ca.SX) -> ca.SX:
    """Return phi = xi coth(xi) >= 1."""
    flat = ca.fabs(xi) < FLAT
    x = ca.if_else(flat, 1, ca.fabs(xi))
    return ca.if_else(flat, 1 + xi**2 / 3 - xi**4 / 45, x / ca.tanh(x))


def gathering(xi: ca.SX) -> ca.SX:
    """Return g(xi); it grows as exp(2 |xi|), and is finite up to |xi| = 300."""
    near = ca.fabs(xi) < 3 * NEAR
    x = ca.if_else(near, 1, ca.fabs(xi))
    far = (ca.sinh(2 * x) - 2 * x) / (4 * x**2)
    return ca.if_else(near, _polynomial(SERIES, xi), ca.sign(xi) * far)


def xi_of(g: ca.SX) -> ca.SX:
    """Return xi at which g has a value, to rounding from 0 to 1e120."""
    found: ca.SX = _xi_function()(g)  # calling it beats writing it out again
    return found


@cache
def _xi_function() -> ca.Function:
    g = ca.SX.sym("g")
    return ca.Function("xi", [g], [_xi_of(g)])


def _xi_of(g: ca.SX) -> ca.SX:
    size = ca.fabs(g)
    near = size < NEAR
    x = _far(ca.if_else(near, 1, size))
    return ca.sign(g) * ca.if_else(near, _polynomial(TURNED, ca.if_else(near, size, 0)), x)


def _far(g: ca.SX) -> ca.SX:
    """Newton's method on log g, of which no part overflows."""
    y = ca.log1p(6 * g) / 2
    x = y + ca.log1p(y**2 / (1 + y))
    for _ in range(STEPS):
        e = ca.exp(-2 * x)  # scales sinh and cosh
        scaled = (1 - e**2 - 4 * x * e) / (8 * x**2)
        slope = (1 - e) ** 2 / (4 * x**2) - 2 * scaled / x
        x = x - (2 * x + ca.log(scaled / g)) * scaled / slope
    return x


def _polynomial(coefficients: tuple[float, ...], x: ca.SX) -> ca.SX:
    """Return the sum of c_i x^(2 i + 1)."""
    total = ca.SX(0)
    for c in reversed(coefficients):
        total = total * x**2 + c
    return total * x
