"""Shapes to start from: a place and a frame at every fraction of the length, nothing of loads.

Lab frame, units Dw = L = 1. Strains follow from the frames; a shape need not satisfy r' = d3.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.rotations import turn_vector, turns_about

STEP = 1e-5  # of the fraction, for differences of frames


class Shape(ABC):
    """A curve with directors; `length` is that of the ribbon."""

    length: float

    @abstractmethod
    def frames(self, fraction: Array) -> Array:
        """Frames (k, 3, 3), columns d1, d2, d3, at fractions (k,) of the length."""

    @abstractmethod
    def positions(self, fraction: Array) -> Array:
        """Positions (k, 3) at fractions (k,)."""

    def strains(self, fraction: Array) -> Array:
        """Strains u1, u2, u3 (k, 3) of the frames, eq. (2.2)."""
        f = np.clip(fraction, STEP, 1 - STEP)
        after, before = self.frames(f + STEP), self.frames(f - STEP)
        turn = np.swapaxes(before, 1, 2) @ after
        axial = np.stack([turn[:, 2, 1], turn[:, 0, 2], turn[:, 1, 0]], axis=1)
        axial -= np.stack([turn[:, 1, 2], turn[:, 2, 0], turn[:, 0, 1]], axis=1)
        return np.asarray(axial / (4 * STEP * self.length))


@dataclass(frozen=True, eq=False)
class Helical(Shape):
    """Arc or helix of constant strains u (3,) from a start."""

    position: Array
    frame: Array
    u: Array
    length: float

    def frames(self, fraction: Array) -> Array:
        return np.asarray(self.frame @ turns_about(self.length * fraction[:, None] * self.u))

    def positions(self, fraction: Array) -> Array:
        size, s = float(np.linalg.norm(self.u)), fraction * self.length
        if size == 0:
            return np.asarray(self.position + s[:, None] * self.frame[:, 2])
        x, y, z = self.u / size
        K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        angle = (size * s)[:, None]
        along = s[:, None] * np.eye(3)[2] + (1 - np.cos(angle)) * K[:, 2] / size
        along = along + (angle - np.sin(angle)) / size * (K @ K)[:, 2]
        return np.asarray(self.position + along @ self.frame.T)

    def strains(self, fraction: Array) -> Array:
        return np.repeat(self.u[None], len(fraction), axis=0)


@dataclass(frozen=True, eq=False)
class TwistedCircle(Shape):
    """Part of a circle of `turn` in all, bent towards d1, with directors twisting about it.

    `twist` is the angle by which d1 turns about d3 from the start to the end.
    """

    position: Array
    frame: Array
    turn: float
    twist: float
    length: float

    def frames(self, fraction: Array) -> Array:
        about_d2 = turns_about(self.turn * fraction[:, None] * np.eye(3)[1])
        about_d3 = turns_about(self.twist * fraction[:, None] * np.eye(3)[2])
        return np.asarray(self.frame @ about_d2 @ about_d3)

    def positions(self, fraction: Array) -> Array:
        bent = np.array([0.0, self.turn / self.length, 0.0])
        return Helical(self.position, self.frame, bent, self.length).positions(fraction)


@dataclass(frozen=True, eq=False)
class Chord(Shape):
    """Straight line between two ends, frames by slerp, bowed as a strip that is shortened buckles.

    `turns` are whole turns about d3 beyond the rotation from end to end: the shortest, or `winding`
    (3,), its vector along the directors of the start. `bow` is the amplitude of the tangent's angle
    about d2, and zero at both ends.
    """

    start: tuple[Array, Array]
    end: tuple[Array, Array]
    length: float
    bow: float = 0.0
    turns: float = 0.0
    winding: Array | None = None

    def frames(self, fraction: Array) -> Array:
        f = fraction[:, None]
        (_, first), (_, last) = self.start, self.end
        turn = turn_vector(first.T @ last) if self.winding is None else self.winding
        twist = turns_about(2 * np.pi * self.turns * f * np.eye(3)[2])
        bow = turns_about(self.bow * np.sin(2 * np.pi * f) * np.eye(3)[1])
        return np.asarray(first @ turns_about(f * turn) @ twist @ bow)

    def positions(self, fraction: Array) -> Array:
        (first, _), (last, _) = self.start, self.end
        return np.asarray(first + fraction[:, None] * (last - first))

    @property
    def straight(self) -> bool:
        """Whether a straight ribbon without stress fits these ends."""
        return self._along(self.length)

    @property
    def taut(self) -> bool:
        """Whether these ends hold a straight ribbon longer than it is."""
        (start, first), (end, _) = self.start, self.end
        length = float((end - start) @ first[:, 2])
        return length > self.length and self._along(length) and not self.straight

    def _along(self, length: float) -> bool:
        """Whether the end is that of a straight ribbon of a length."""
        (start, first), (end, last) = self.start, self.end
        gap = end - start - length * first[:, 2]
        if self.winding is not None and self.winding.any():
            return False
        return bool(np.abs(gap).max() < 1e-9 * self.length and np.abs(first - last).max() < 1e-9)


@dataclass(frozen=True, eq=False)
class Perturbed(Shape):
    """Another shape with smooth waves on its frames and positions, none at the ends.

    `turns` (modes, 3) are amplitudes, in radians, of rotation vectors along the directors; `moves`
    (modes, 3) of displacements in the lab.
    """

    base: Shape
    turns: Array
    moves: Array

    @property
    def length(self) -> float:  # type: ignore[override]
        """Length of the ribbon."""
        return self.base.length

    def frames(self, fraction: Array) -> Array:
        return np.asarray(self.base.frames(fraction) @ turns_about(self._waves(fraction, 0)))

    def positions(self, fraction: Array) -> Array:
        return np.asarray(self.base.positions(fraction) + self._waves(fraction, 1))

    def _waves(self, fraction: Array, which: int) -> Array:
        amplitudes = (self.turns, self.moves)[which]
        modes = np.arange(1, len(amplitudes) + 1)
        return np.asarray(np.sin(np.pi * fraction[:, None] * modes) @ amplitudes)

    @classmethod
    def at_random(cls, base: Shape, amplitude: float, rng: np.random.Generator) -> Perturbed:
        """Perturb a shape by four modes whose amplitudes fall with their number."""
        decay = amplitude / np.arange(1, 5)[:, None]
        turns, moves = rng.normal(size=(2, 4, 3)) * decay
        return cls(base, turns, 0.1 * base.length * moves)
