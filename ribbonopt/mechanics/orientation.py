"""How the directors of a rod are carried: a unit quaternion, or all nine components, eq. (2.2)."""

from __future__ import annotations

from abc import ABC, abstractmethod

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array

from .rotations import directors_of, product, quaternions_from


class Orientation(ABC):
    """How the directors are carried."""

    names: tuple[str, ...]

    @abstractmethod
    def directors(self, x: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
        """Directors d1, d2, d3 (lab) of the orientation states x."""

    @abstractmethod
    def rates(self, x: ca.SX, u: ca.SX) -> ca.SX:
        """Return dx/ds for the Darboux vector u (3,) along the directors, (2.2)."""

    @abstractmethod
    def normalisation(self, x: ca.SX) -> dict[str, ca.SX]:
        """Conditions, by name, that make x a frame at one point; (2.2) keeps them."""

    @abstractmethod
    def alignment(self, x: ca.SX, q: ca.SX) -> ca.SX:
        """Three expressions that vanish where the frame of x is that of the quaternion q (4,)."""

    @abstractmethod
    def pack(self, frames: Array) -> Array:
        """Orientation states (k, nx) of the frames (k, 3, 3)."""


class UnitQuaternion(Orientation):
    """Four states q with q' = q u / 2; Gauss collocation keeps |q| = 1 to rounding."""

    names = ("q0", "q1", "q2", "q3")

    def directors(self, x: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
        return directors_of(x)

    def rates(self, x: ca.SX, u: ca.SX) -> ca.SX:
        rates: ca.SX = ca.vertcat(*product(ca.vertsplit(x), (0, *ca.vertsplit(u)))) / 2
        return rates

    def normalisation(self, x: ca.SX) -> dict[str, ca.SX]:
        return {"unit quaternion": ca.sumsqr(x) - 1}

    def alignment(self, x: ca.SX, q: ca.SX) -> ca.SX:
        conjugate = (q[0], -q[1], -q[2], -q[3])
        residual: ca.SX = 2 * ca.vertcat(*product(conjugate, ca.vertsplit(x))[1:])
        return residual

    def pack(self, frames: Array) -> Array:
        return quaternions_from(frames)


class DirectorTriad(Orientation):
    """Nine states, the lab components of d1, d2, d3, eq. (2.2)."""

    names = ("d1x", "d1y", "d1z", "d2x", "d2y", "d2z", "d3x", "d3y", "d3z")

    def directors(self, x: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
        return x[:3], x[3:6], x[6:9]

    def rates(self, x: ca.SX, u: ca.SX) -> ca.SX:
        d1, d2, d3 = self.directors(x)
        # u x d_i, component form (A 1).
        return ca.vertcat(
            u[2] * d2 - u[1] * d3,
            u[0] * d3 - u[2] * d1,
            u[1] * d1 - u[0] * d2,
        )

    def normalisation(self, x: ca.SX) -> dict[str, ca.SX]:
        d = dict(zip(("d1", "d2", "d3"), self.directors(x), strict=True))
        lengths = {f"|{i}| = 1": ca.sumsqr(d[i]) - 1 for i in d}
        pairs = (("d1", "d2"), ("d2", "d3"), ("d3", "d1"))
        return lengths | {f"{i} . {j} = 0": ca.dot(d[i], d[j]) for i, j in pairs}

    def alignment(self, x: ca.SX, q: ca.SX) -> ca.SX:
        pairs = zip(directors_of(q), self.directors(x), strict=True)
        return sum((ca.cross(target, d) for target, d in pairs), ca.SX.zeros(3)) / 2

    def pack(self, frames: Array) -> Array:
        return np.ascontiguousarray(np.swapaxes(frames, 1, 2)).reshape(len(frames), 9)
