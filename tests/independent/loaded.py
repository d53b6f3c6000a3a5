"""Integration along a loaded ribbon or rod, for several starts (columns) at a time.

r' = d3, d_i' = u x d_i, n' = -f - p d1, m' = n x d3 - c, by DOP853 in pieces that end at stations
(point loads, supports), where the law changes its sheet, and wherever the caller wants to know.
Vectors are lab-frame columns (3, k), a frame (3, 3, k) holds d1, d2, d3 in its rows.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from .curved import Along, Material, Natural, value
from .inplane import InPlane
from .path import turned
from .rod import Array, along, cross, dot

ROWS = 20  # r, d1, d2, d3, n, m, energy, work of the dead loads
STEP = 1e-2  # of differences of coefficients along the ribbon, in mixtures only

Vector = tuple[Along, Along, Along]
RIGID = InPlane()


@dataclass(frozen=True)
class Point:
    """What acts at one station: dead in the lab frame, or along the directors there.

    Numbers, or arrays (k,) that differ from column to column (reactions).
    """

    at: float
    force: Sequence[float | Array] = (0.0, 0.0, 0.0)
    moment: Sequence[float | Array] = (0.0, 0.0, 0.0)
    follows: bool = False


@dataclass(frozen=True)
class Strip:
    """A ribbon and its loads: force and couple per length (dead), pressure along d1."""

    material: Material
    force: Vector = (0.0, 0.0, 0.0)
    couple: Vector = (0.0, 0.0, 0.0)
    pressure: Along = 0.0
    points: tuple[Point, ...] = ()
    inplane: InPlane = RIGID

    def rates(self, kind: int, s: Array, y: Array) -> Array:
        """Rates (20, k) at arclengths s (k,)."""
        n, m = y[12:15], y[15:18]
        frame = y[3:12].reshape(3, 3, -1)
        d1, d2, d3 = frame
        own = along(frame, m)
        f = np.stack([value(c, s) for c in self.force])
        c = np.stack([value(c, s) for c in self.couple])
        if kind:
            u, energy = self.material.strains(kind, own, s)
        else:
            u, energy = self._mixture(s, own, along(frame, n), along(frame, f), along(frame, c))
            self._steady()
            if not self.inplane.rigid:
                raise ValueError("mixtures of a ribbon that gives in its plane are not known here")
        out = np.empty_like(y)
        out[:3] = d3
        out[3:6] = u[2] * d2 - u[1] * d3
        out[6:9] = u[0] * d3 - u[2] * d1
        out[9:12] = u[1] * d1 - u[0] * d2
        pressed = value(self.pressure, s)
        out[12:15] = -f - pressed * d1
        out[15:18] = cross(n, d3) - c
        out[18], out[19] = energy, dot(f, y[:3])
        self.inplane.give(out, y, pressed, value(self.material.width, s))
        return out

    def _mixture(self, s: Array, m: Array, n: Array, f: Array, c: Array) -> tuple[Array, Array]:
        """Strains where both sheets mix: T = 0, T' = 0 and T'' = 0 along the arc.

        With m2 + G the width w times T, T' = 0 is n1 + c2 + m1 u3 = G', and T'' = 0 gives u2; of
        c2' that of the director is -u3 c1. Coefficients that vary are differenced.
        """
        law = self.material
        if law.plate is not None:
            return self._plates_mixture(m, n)
        (w, _, K12), (slope, _, twist), (_, bend, _) = differenced(law.mixing, s)
        u3 = (m[2] / w + 2 * K12) / 4
        stiff = n[2] - m[0] ** 2 / (4 * w) + u3 * m[2]
        known = 2 * n[1] * u3 + m[1] * u3**2 - f[0] - value(self.pressure, s) - bend
        known += m[0] * (twist / 2 - c[2] / (4 * w) - m[2] * slope / (4 * w**2)) - 2 * u3 * c[0]
        u2 = known / stiff
        return np.stack([0 * u2, u2, u3]), law.mixed(m, u2, u3, s)

    def _plates_mixture(self, m: Array, n: Array) -> tuple[Array, Array]:
        """Strains where both sides of an extensible ribbon mix: m2 = 0 and n1 + m1 u3 = 0 stay."""
        natural = self.natural.curvature, self.natural.twist, self.natural.across
        acting = *self.force, *self.couple, self.pressure, *natural
        plate = self.material.plate
        if plate is None or any(callable(v) or v for v in acting):
            raise ValueError("mixtures of this law under loads are not known here")
        u3, slope, energy = plate.mixed(m[2])
        u2 = 2 * n[1] * u3 / (n[2] + u3 * m[2] - slope * m[0] ** 2)
        return np.stack([0 * u2, u2, u3]), energy

    def _steady(self) -> None:
        if any(callable(c) for c in self.couple):
            raise ValueError("mixtures under couples that vary are not known here")

    @property
    def switched(self) -> bool:
        """Whether its law has two sheets."""
        return self.material.switched

    @property
    def natural(self) -> Natural:
        """Strains that it has when free."""
        return self.material.natural

    def jump(self, y: Array, at: float | Array) -> Array:
        """Return the state behind a station, if there is one at that arclength."""
        return jumped(self.points, y, at)

    def along(
        self,
        y: Array,
        stops: Sequence[float | Array],
        kinds: Sequence[int],
        rtol: float = 3e-14,
    ) -> list[Array]:
        """States (20, k) in front of each stop but the first, where y holds.

        Parameters
        ----------
        y
            State (20, k) at the first stop, in front of what acts there.
        stops
            Ascending arclengths, or arrays (k,) of them; stations must be among them.
        kinds
            Sheet of the law between each two of them.
        """
        found = []
        for a, b, kind in zip(stops[:-1], stops[1:], kinds, strict=True):
            y = self.piece(self.jump(y, a), a, b, kind, rtol)
            found.append(y)
        return found

    def piece(
        self, y: Array, a: float | Array, b: float | Array, kind: int, rtol: float = 3e-14
    ) -> Array:
        """State (20, k) at b from that at a, with nothing between."""
        return integrated(lambda s, y: self.rates(kind, s, y), y, a, b, rtol)

    def turn(self, y: Array, s: float | Array) -> Array:
        """T of the law (k,), whose sign is its sheet."""
        return self.material.switch(along(y[3:12].reshape(3, 3, -1), y[15:18]), s)

    def energy(self, y: Array, kind: int, s: Array) -> Array:
        """Energy per length and H = m . u - W + n3 (2, k)."""
        frame = y[3:12].reshape(3, 3, -1)
        own = along(frame, y[15:18])
        if kind == 0 and self.material.plate is not None:
            u, energy = self._plates_mixture(own, along(frame, y[12:15]))
        else:
            u, energy = self.material.strains(kind, own, s)
        both = np.stack([energy, dot(own, u) - energy + dot(frame[2], y[12:15])])
        width = value(self.material.width, s)
        return both + self.inplane.strains(y[12:15], y[15:18], frame, width)[2]


def jumped(points: Sequence[Point], y: Array, at: float | Array) -> Array:
    """Return the state (20 or more, k) behind a station, if there is one at that arclength."""
    y = y.copy()
    for point in points:
        if np.ndim(at) == 0 and abs(point.at - at) < 1e-14:
            force, moment = (
                np.stack([np.broadcast_to(x, y.shape[1:]) for x in v])
                for v in (point.force, point.moment)
            )
            if point.follows:
                frame = y[3:12].reshape(3, 3, -1)
                force, moment = (sum(v[i] * frame[i] for i in range(3)) for v in (force, moment))
            else:
                y[19] += dot(force, y[:3])
            y[12:15] -= force
            y[15:18] -= moment
    return y


def integrated(
    rates: Callable[[Array, Array], Array],
    y: Array,
    a: float | Array,
    b: float | Array,
    rtol: float = 3e-14,
) -> Array:
    """States (rows, k) at b from those at a, of rates at arclengths (k,)."""
    shape, length = y.shape, np.asarray(b) - a

    def rate(x: float, y: Array) -> Array:
        s = np.broadcast_to(a + x * length, shape[1:])
        return (rates(s, y.reshape(shape)) * length).ravel()

    path = solve_ivp(rate, (0, 1), y.ravel(), "DOP853", rtol=rtol, atol=rtol)
    if not path.success:
        raise ArithmeticError(path.message)
    end: Array = path.y[:, -1].reshape(shape)
    return end


def state(r: Array, frame: Array, n: Array, m: Array) -> Array:
    """State (20, k) of places (3, k), a frame (3, 3) or frames, forces and moments."""
    columns = np.broadcast_shapes(*(np.shape(np.reshape(v, (3, -1))) for v in (r, n, m)))[1]
    y = np.zeros((ROWS, columns))
    y[:3], y[12:15], y[15:18] = (np.reshape(v, (3, -1)) for v in (r, n, m))
    y[3:12] = np.reshape(frame, (9, -1))
    return y


def rotated(vector: Sequence[float]) -> Array:
    """Frame (3, 3), directors in its rows, that a rotation vector makes of the lab's."""
    v = np.asarray(vector, float)
    angle = np.linalg.norm(v)
    if angle == 0:
        return np.eye(3)
    axis = v / angle
    cayley = turned(np.eye(3)[:, :, None], 2 * np.tan(angle / 4) * axis[:, None])
    return turned(cayley, 2 * np.tan(angle / 4) * axis[:, None])[:, :, 0]


def differenced(of: Callable[[Array], Array], s: Array) -> tuple[Array, Array, Array]:
    """Return values, first and second derivatives along s, by differences of order six."""
    at = [of(s + i * STEP) for i in range(-3, 4)]
    odd = [at[3 + i] - at[3 - i] for i in (1, 2, 3)]
    even = [at[3 + i] - 2 * at[3] + at[3 - i] for i in (1, 2, 3)]
    first = sum(a * x for a, x in zip((3 / 4, -3 / 20, 1 / 60), odd, strict=True)) / STEP
    second = sum(a * x for a, x in zip((3 / 2, -3 / 20, 1 / 90), even, strict=True)) / STEP**2
    return at[3], first, second
