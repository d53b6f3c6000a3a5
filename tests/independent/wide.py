"""Wunderlich's ribbon of a finite width, typed anew: its law and the rates of all that it carries.

An inextensible ribbon of width w has u3 = eta u2 and energy u2^2 e^2 phi / 2 per length, where
e = 1 + eta^2, phi = xi coth xi and tanh xi = w eta' / 2. With p = dW/deta' and A = m2 + eta m3:
A = u2 e^2 phi and 2 p e^2 / (w A^2) = g(xi) = (sinh 2 xi - 2 xi) / (4 xi^2). Natural strains add
K11 + 2 K12 eta + K22 eta^2 to A. All functions take complex numbers too: derivatives are steps
along the imaginary axis. Units Dw = L = 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial

import numpy as np

from .curved import Along, Natural, value
from .inplane import InPlane
from .loaded import RIGID, Point, Vector, integrated, jumped
from .rod import Array, along, cross, dot

ROWS = 22  # r, d1, d2, d3, n, m, energy, work of the dead loads, eta, p
R, D, N, M, E, ETA, P = slice(0, 3), slice(3, 12), slice(12, 15), slice(15, 18), 18, 20, 21
SERIES = [2.0 ** (2 * k + 1) / (4 * factorial(2 * k + 1)) for k in range(1, 14)]
ONE = (np.sinh(2.0) - 2) / 4  # g(1): series below it, exponentials above
NO_A = 1e-60
STEPS = 7
FLAT = Natural()


def _small(x: Array) -> tuple[Array, Array]:
    """Return g and its slope as series, for |xi| <= 1 about."""
    square, g, slope = x * x, 0 * x, 0 * x
    for k in reversed(range(len(SERIES))):
        g = g * square + SERIES[k]
        slope = slope * square + (2 * k + 1) * SERIES[k]
    return g * x, slope


def _large(x: Array) -> tuple[Array, Array]:
    """Return log g and its slope for xi >= 1 / 2, without overflow."""
    small = np.exp(-2 * x)
    inside = 1 - small**2 - 4 * x * small
    return 2 * x + np.log(inside / (8 * x * x)), (2 * (1 - small) ** 2) / inside - 2 / x


def xi_of(p: Array, A: Array, factor: Array) -> Array:
    """Return xi of g(xi) = G = p factor / A^2 by Newton's method, on g or on its logarithm.

    Of complex numbers, which are those that differ along the first axis in imaginary parts only,
    the last step, which is exact there, is taken in full.
    """
    A = np.where(np.abs(A.real) < NO_A, NO_A + 1j * A.imag, A)
    sign, square = np.where(p.real < 0, -1.0, 1.0), A * A
    little = np.abs(p.real) * factor.real < ONE * square.real
    G = np.where(little, p * factor / np.where(little, square, 1), 0)
    log_G = np.log(np.where(little, 1, sign * p * factor)) - np.log(np.where(little, 1, square))
    alike = G.ndim > 1 and all((v.real == v.real[:1]).all() for v in (G, log_G))
    g, log_g = ((v.real[:1] if alike else v.real) for v in (G, log_G))
    x, half = 3 * g / (1 + np.abs(g)), np.maximum(log_g, 0) / 2
    y = 1 + half + np.log1p(half)
    for _ in range(STEPS):
        found, slope = _small(x)
        x = x - (found - g) / slope
        found, slope = _large(y)
        y = np.maximum(y - (found - log_g) / slope, 0.5)
    found, slope = _small(x)
    x = x - (found - G) / slope
    found, slope = _large(y)
    y = y - (found - log_G) / slope
    return np.where(little, x, sign * y)


def phi_of(xi: Array) -> Array:
    """Return xi coth xi, of complex numbers too."""
    a = np.where(xi.real < 0, -xi, xi)
    flat = a.real < 1e-2
    safe = np.where(flat, 1, a)
    square = xi * xi
    series = 1 + square / 3 - square**2 / 45 + 2 * square**3 / 945 - square**4 / 4725
    return np.where(flat, series, safe * (1 + 2 / np.expm1(2 * safe)))


@dataclass(frozen=True)
class Wide:
    """A ribbon of a width, curved when free, under dead loads and a pressure per length."""

    width: float
    natural: Natural = FLAT
    force: Vector = (0.0, 0.0, 0.0)
    couple: Vector = (0.0, 0.0, 0.0)
    pressure: Along = 0.0
    points: tuple[Point, ...] = ()
    inplane: InPlane = RIGID
    switched = True  # at A = 0

    def turn(self, y: Array, s: Array) -> Array:
        """Return A (...), which changes its sign at inflections, of states (22, ...)."""
        own = along(y[D].reshape(3, 3, *y.shape[1:]), y[M])
        K11, K12, K22, _ = self.natural.moments(s)
        return own[1] + K11 + y[ETA] * (own[2] + 2 * K12 + K22 * y[ETA])

    def strains(self, y: Array, s: Array) -> tuple[Array, Array, Array]:
        """Return u2, xi and phi (...) of states (22, ...) at arclengths s (...)."""
        A, e = self.turn(y, s), 1 + y[ETA] ** 2
        xi = xi_of(y[P] + 0j, A + 0j, 2 * e**2 / self.width + 0j)
        xi = xi if np.iscomplexobj(y) else xi.real
        phi = phi_of(xi)
        return A / (e**2 * phi), xi, phi

    def rates(self, s: Array, y: Array) -> Array:
        """Return the rates of states (22, ...) at arclengths s (...)."""
        frame = y[D].reshape(3, 3, *y.shape[1:])
        d1, d2, d3 = frame
        eta, e = y[ETA], 1 + y[ETA] ** 2
        K11, K12, K22, constant = self.natural.moments(s)
        u2, xi, phi = self.strains(y, s)
        u3 = eta * u2
        f, c = (np.stack([value(v, s) for v in vector]) for vector in (self.force, self.couple))
        out = np.empty_like(y)
        out[R] = d3
        out[3:6], out[6:9], out[9:12] = u3 * d2 - u2 * d3, -u3 * d1, u2 * d1
        pressed = value(self.pressure, s)
        out[N] = -f - pressed * d1
        out[M] = cross(y[N], d3) - c
        out[E] = u2**2 * e**2 * phi / 2 - (K11 + (2 * K12 + K22 * eta) * eta) * u2 + constant
        out[E + 1] = dot(f, y[R])
        out[ETA] = 2 / self.width * np.tanh(xi)
        out[P] = 2 * eta * e * u2**2 * phi - (dot(d3, y[M]) + 2 * K12 + 2 * K22 * eta) * u2
        self.inplane.give(out, y, pressed)
        return out

    def hamiltonian(self, y: Array, s: Array) -> Array:
        """Return H = m . u + p eta' - W + n3 (...), which is constant without loads."""
        frame = y[D].reshape(3, 3, *y.shape[1:])
        own, rate = along(frame, y[M]), self.rates(s, y)
        u2 = self.strains(y, s)[0]
        H = u2 * (own[1] + y[ETA] * own[2]) + y[P] * rate[ETA] - rate[E] + dot(frame[2], y[N])
        return H + 2 * self.inplane.strains(y[N], y[M], frame, 1.0)[2]

    def piece(
        self, y: Array, a: float | Array, b: float | Array, kind: int, rtol: float = 3e-14
    ) -> Array:
        """States (22, k) at b from those at a, with nothing between; A tells its own sign."""
        return integrated(self.rates, y, a, b, rtol)

    def jump(self, y: Array, at: float | Array) -> Array:
        """Return the states behind a station, if there is one at that arclength."""
        return jumped(self.points, y, at)
