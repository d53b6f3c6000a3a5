"""Loads and natural curvatures at which ribbons and rods buckle: nothing of `ribbonopt`.

Closed forms, zeros of special functions, power series and periodic integrals, to 25 digits and
more, cached. Equations of equilibrium: r' = d3, d_i' = u x d_i, n' = -f, m' = n x d3. Units: L = 1
and B = 1 (rods) or Dw = 1 (ribbons); what is said of rings is times powers of their radius R.
"""

from __future__ import annotations

from functools import cache

from mpmath import mp, mpf

DIGITS = 36  # worked with
ORDER = 40  # of power series
POINTS = 200  # of periodic integrals: far more than their digits need


@cache
def bessel_zero(twelfths: int, near: float) -> float:
    """Zero of J of an order given in twelfths."""
    with mp.workdps(DIGITS):
        return mp.findroot(lambda x: mp.besselj(mpf(twelfths) / 12, x), near)


def heavy_column() -> float:
    """q L^3 / B at which a column, clamped at its foot, buckles under its own weight q.

    With x from the tip theta'' + q x theta = 0, theta'(0) = theta(1) = 0, hence theta is
    sqrt(x) J_{-1/3}(2 sqrt(q) x^{3/2} / 3).
    """
    with mp.workdps(DIGITS):
        return float(9 * bessel_zero(-4, 1.87) ** 2 / 4)


def heavy_rod_sideways(B2: float = 1.0, B3: float = 1.0) -> float:
    """q at which a rod with B1 = infinity, that carries its weight q along d2, buckles sideways.

    With x from the tip, M = q x^2 / 2 the moment about d1 and phi the turn about d3: m2 = -M phi
    (as m turns less than the directors) and dm3/ds = M u2, so that phi'' + M^2 phi / (B2 B3) = 0,
    phi'(0) = phi(1) = 0: phi = sqrt(x) J_{-1/6}(q x^3 / 6 / sqrt(B2 B3)).
    """
    return 6 * float(bessel_zero(-2, 2.14)) * (B2 * B3) ** 0.5


def loaded_rod_sideways(B2: float = 1.0, B3: float = 1.0) -> float:
    """Dead load along d2 at the tip at which it does; M = P x, J_{-1/4}(P x^2 / 2 / ...)."""
    return 2 * float(bessel_zero(-3, 2.0)) * (B2 * B3) ** 0.5


@cache
def _sideways(power: int) -> float:
    """Return tau = integral of M at which a ribbon of Sadowsky's law buckles sideways, M ~ x^power.

    The equations above hold with u2, u3 of the law, which are of degree one in m2, m3 and no more.
    With m2 = M y, m3 = -M v: dy/dtau = -v (1 + cos b)/4 ..., so that tan b = v / y obeys
    db/dtau = (1 + cos b)^2 / 4 - k sin b cos b / tau, k = power / (power + 1), from b = 0 (m3 = 0
    at the tip) to b = pi / 2 (phi = 0 at the clamp). For t = tan(b / 2) that is
    2 (1 + t^2) tau t' = tau - 2 k t (1 - t^2): by power series, the first one about tau = 0.
    """
    with mp.workdps(DIGITS):
        k = mpf(power) / (power + 1)
        tau, t = mpf(0), mpf(0)
        while True:
            series = _series(k, tau, t)
            step = mpf(1) / 4
            after = _sum(series, step)
            if after > 1:
                return tau + _reached(series, step)
            tau, t = tau + step, after


def _sum(series: list[float], h: float) -> float:
    """Return the value of a power series."""
    total = mpf(0)
    for coefficient in reversed(series):
        total = total * h + coefficient
    return total


def _reached(series: list[float], step: float) -> float:
    """Return where a power series is 1."""
    return mp.findroot(lambda h: _sum(series, h) - 1, (0, step / 2))


def _series(k: float, tau: float, t: float) -> list[float]:
    """Taylor coefficients in h of t(tau + h)."""
    a = [t]  # t
    square, cube = [t * t], [t**3]
    rate: list[float] = []  # t'
    for j in range(ORDER):
        # The coefficient of h^j in 2 (1 + t^2) (tau + h) t' = tau + h - 2 k (t - t^3).
        right = (tau if j == 0 else 1 if j == 1 else 0) - 2 * k * (a[j] - cube[j])
        known = sum(square[i] * rate[j - i] for i in range(1, j + 1)) * tau
        if j:
            known += rate[j - 1] + sum(square[i] * rate[j - 1 - i] for i in range(j))
        if tau:
            rate.append((right - 2 * known) / (2 * tau * (1 + square[0])))
        else:  # a[j + 1] has been found one order later, from the coefficient of h^(j + 1)
            rate.append((j + 1) * _regular(k, a, square, cube, rate, j + 1))
        a.append(rate[j] / (j + 1))
        square.append(sum(a[i] * a[j + 1 - i] for i in range(j + 2)))
        cube.append(sum(a[i] * square[j + 1 - i] for i in range(j + 2)))
    return a


def _regular(
    k: float, a: list[float], square: list[float], cube: list[float], rate: list[float], j: int
) -> float:
    """Return a[j] where tau = 0 and t = 0: 2 j a[j] + 2 k a[j] = known."""
    known = (1 if j == 1 else 0) - 2 * sum(square[i] * rate[j - 1 - i] for i in range(1, j))
    # t^3 has no term of order j with a[j] in it, as t has none of order 0.
    for i in range(1, j):
        known += 2 * k * a[i] * sum(a[n] * a[j - i - n] for n in range(1, j - i))
    return known / (2 * j + 2 * k)


def heavy_ribbon_sideways() -> float:
    """q at which a ribbon of Sadowsky's law that carries its weight q along d2 buckles sideways."""
    return 6 * float(_sideways(2))  # tau = q x^3 / 6


def loaded_ribbon_sideways() -> float:
    """Dead load along d2 at its tip at which it does."""
    return 2 * float(_sideways(1))  # tau = P x^2 / 2


def pressed_ring(mode: int = 2) -> float:
    """P R^3 / B at which a ring buckles in its plane with so many waves: k^2 - 1.

    In the plane n1' + u n3 = -p, n3' = u n1, B u' = -n1; the ring has n3 = -p R. For what is
    added, B u''' = -(B / R^2 + p R) u', and u' must have k waves around; k = 1 is a motion.
    """
    return float(mode**2 - 1)


def curled_ring(poisson_ratio: float = 0.0, mode: int = 2, covered: int = 1) -> float:
    """Natural curvature k11 R at which a flat ring of a ribbon opens out of its plane.

    About a ring of curvature 1 the law is linear with B3 = 2 (1 - nu k0), and m2 = 1 - k0. Out of
    the plane m1' = (m2 / B3 - 1) m3, m3' = m1, so that k^2 = 1 - m2 / B3 with k = mode / covered.
    """
    with mp.workdps(DIGITS):
        x = 1 - (mpf(mode) / covered) ** 2
        return float((1 - 2 * x) / (1 - 2 * mpf(str(poisson_ratio)) * x))


def curled_rod_ring(B3: float, mode: int = 2) -> float:
    """Natural curvature times R at which a flat ring of a rod with B2 = 1 opens: B3 (1 - k^2)."""
    return 1 - B3 * (1 - mode**2)


def twisted_ring(C: float = 1.0, mode: int = 2) -> float:
    """Twist in all at which a ring of an isotropic rod, B = 1, leaves its plane (Michell 1889).

    In a frame that does not spin the rod has m = B (w1, w2, 0) + C tau e3 and n2 = C tau / R. What
    is added with k waves around obeys (C tau R / B)^2 = k^2 - 1.
    """
    with mp.workdps(DIGITS):
        return float(2 * mp.pi * mp.sqrt(mode**2 - 1) / mpf(str(C)))


@cache
def clamped_torque() -> float:
    """M L / B at which a straight clamped rod buckles under torque alone: 2 x, tan x = x."""
    with mp.workdps(DIGITS):
        return float(2 * mp.findroot(lambda x: mp.sin(x) - x * mp.cos(x), 4.49))


@cache
def touching_ring() -> tuple[float, float, float]:
    """P R^3 / B at which sides of a ring touch; its curvatures at long and short axis, R = 1.

    The equations of `pressed_ring` have n3 = C - u^2 / 2 and u'' = p + C u - u^3 / 2, and the ends
    of a quarter are at n3 / p from its centre. With u = e at the short axis touching is
    C = e^2 / 2. Then 4 u'^2 = (u - e)(a - u)(u^2 + b u + c), b = a + e, c = b^2 - a e - 2 e^2 and
    8 p = b (c - a e). In units of e = -1 one equation remains for a: the quarter turns by pi / 2.
    """
    with mp.workdps(DIGITS):
        a = mp.findroot(lambda a: _quarter(a)[1] - mp.pi / 2, (4, mpf("4.1")))
        radius = 2 * _quarter(a)[0] / mp.pi
        p = (a - 1) ** 2 * (a + 1) / 8
        return float(p * radius**3), float(a * radius), float(-radius)


def _quarter(a: float) -> tuple[float, float]:
    """Length and turn: u = (a - 1) / 2 + (a + 1) / 2 cos x makes periodic integrals of them."""
    length = turn = mpf(0)
    for i in range(POINTS):
        u = (a - 1) / 2 + (a + 1) / 2 * mp.cos((i + mpf(1) / 2) * mp.pi / POINTS)
        weight = 2 * mp.pi / POINTS / mp.sqrt(u**2 + (a - 1) * u + a**2 - a - 1)
        length, turn = length + weight, turn + u * weight
    return length, turn
