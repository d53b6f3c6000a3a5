"""How the generatrices of a ribbon of finite width gather: the functions of xi of Wunderlich's law.

The width runs along generatrices whose curvature varies as 1 / (1 - z tanh(xi)), -1 <= z <= 1, from
edge to edge: xi = 0 where they are parallel, and at infinity where they meet on an edge. Averaged
over the width that gives the factor phi = xi coth(xi) of the energy, whose slope over tanh' is

    g(xi) = (sinh 2 xi - 2 xi) / (4 xi^2), odd and increasing: xi / 3 + xi^3 / 15 + ...
"""

from __future__ import annotations

import casadi as ca

NEAR = 0.05  # g below which its series is used: there the closed form cancels
STEPS, FEW = 4, 3  # of Newton's method, from where they leave rounding only
FLAT = 1e-3  # xi below which phi is 1 + xi^2 / 3 to rounding
#: g = sum of c_i xi^(2 i + 1)
SERIES = (1 / 3, 1 / 15, 2 / 315, 1 / 2835, 2 / 155925)


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
    return ca.if_else(near, _series(xi), ca.sign(xi) * far)


def xi_of(g: ca.SX) -> ca.SX:
    """Return xi at which g has a value, to rounding from 0 to 1e120."""
    size = ca.fabs(g)
    near = size < NEAR
    x = _far(ca.if_else(near, 1, size))
    return ca.sign(g) * ca.if_else(near, _near(ca.if_else(near, size, 0)), x)


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


def _near(g: ca.SX) -> ca.SX:
    """Newton's method on the series."""
    x = 3 * g
    for _ in range(FEW):
        slope = sum((2 * i + 1) * c * x ** (2 * i) for i, c in enumerate(SERIES))
        x = x - (_series(x) - g) / slope
    return x


def _series(x: ca.SX) -> ca.SX:
    total: ca.SX = sum((c * x ** (2 * i + 1) for i, c in enumerate(SERIES)), ca.SX(0))
    return total
