"""The Cosserat rod: which unknowns describe it, and its equations, whatever the law.

An *orientation* says how the directors are carried (unit quaternion, or all nine components), a
*balance* says which of force and moment are states, constants or closed forms. `RodModel` puts the
two together; the scene chooses

- `reduced`: states r, q (7), constants n, m_0 (6), because without loads n is constant in the lab
  frame and m = m_0 + n x (r - r_0), the integral of eqs. (2.6)-(2.7);
- `full`: the paper's 18 states r, d1, d2, d3, n, m of eq. (4.5).

Vectors are lab-frame components unless a name ends in 1, 2 or 3 (along a director).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array

from .rotations import directors_of, product, quaternions_from


@dataclass(frozen=True, eq=False)
class RodState:
    """One cross section: position, directors, force and moment, each (3,) in the lab frame."""

    r: ca.SX
    d1: ca.SX
    d2: ca.SX
    d3: ca.SX
    n: ca.SX
    m: ca.SX

    def along(self, vector: ca.SX) -> ca.SX:
        """Components (3,) of a lab vector along the directors."""
        return ca.vertcat(*(ca.dot(vector, d) for d in (self.d1, self.d2, self.d3)))


@dataclass(frozen=True, eq=False)
class RodFields:
    """Numbers along a ribbon, rows along s: r, n, m (k, 3) and frames (k, 3, 3), lab frame.

    Column i of a frame is the director d_i.
    """

    r: Array
    frames: Array
    n: Array
    m: Array


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


@dataclass(frozen=True, eq=False)
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


@dataclass(frozen=True, eq=False)
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


class Balance(ABC):
    """How force and moment are carried, eqs. (2.6)-(2.7)."""

    states: tuple[str, ...]
    constants: tuple[str, ...]

    @abstractmethod
    def force_and_moment(
        self, r: ca.SX, x: ca.SX, c: ca.SX, reference: ca.SX
    ) -> tuple[ca.SX, ca.SX]:
        """Force n and moment m (lab) from own states x, constants c and the reference point."""

    @abstractmethod
    def rates(self, n: ca.SX, d3: ca.SX) -> ca.SX:
        """Return the derivatives of the states along s."""

    @abstractmethod
    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        """States (k, nx) and constants (nc,) of given fields."""


@dataclass(frozen=True, eq=False)
class ConstantForce(Balance):
    """No loads: constants n and m_0, with m = m_0 + n x (r - reference)."""

    states = ()
    constants = ("nx", "ny", "nz", "mx", "my", "mz")

    def force_and_moment(
        self, r: ca.SX, x: ca.SX, c: ca.SX, reference: ca.SX
    ) -> tuple[ca.SX, ca.SX]:
        return c[:3], c[3:6] + ca.cross(c[:3], r - reference)

    def rates(self, n: ca.SX, d3: ca.SX) -> ca.SX:
        return ca.SX(0, 1)

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        n = fields.n[0]
        moment = fields.m[0] - np.cross(n, fields.r[0] - reference)
        return np.empty((len(fields.r), 0)), np.concatenate([n, moment])


@dataclass(frozen=True, eq=False)
class ForceMomentStates(Balance):
    """Six states n and m with n' = 0 and m' = n x d3, as eq. (4.5) writes them."""

    states = ("nx", "ny", "nz", "mx", "my", "mz")
    constants = ()

    def force_and_moment(
        self, r: ca.SX, x: ca.SX, c: ca.SX, reference: ca.SX
    ) -> tuple[ca.SX, ca.SX]:
        return x[:3], x[3:6]

    def rates(self, n: ca.SX, d3: ca.SX) -> ca.SX:
        return ca.vertcat(ca.SX.zeros(3), ca.cross(n, d3))

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        return np.hstack([fields.n, fields.m]), np.empty(0)


@dataclass(frozen=True, eq=False)
class RodModel:
    """Unknowns and equations of a rod: orientation and balance together."""

    orientation: Orientation
    balance: Balance

    @property
    def states(self) -> tuple[str, ...]:
        """Names of the states along s."""
        return ("rx", "ry", "rz", *self.orientation.names, *self.balance.states)

    @property
    def constants(self) -> tuple[str, ...]:
        """Names of the unknown constants."""
        return self.balance.constants

    def rod(self, x: ca.SX, c: ca.SX, reference: ca.SX) -> RodState:
        """Cross section at the states x, constants c; `reference` (3,) is where c's moment acts."""
        q, rest = self._split(x)
        n, m = self.balance.force_and_moment(x[:3], rest, c, reference)
        return RodState(x[:3], *self.orientation.directors(q), n, m)

    def rates(self, x: ca.SX, rod: RodState, u: ca.SX) -> ca.SX:
        """dx/ds for the Darboux vector u (3,) along the directors, eqs. (2.1), (2.2), (2.7)."""
        q, _ = self._split(x)
        return ca.vertcat(rod.d3, self.orientation.rates(q, u), self.balance.rates(rod.n, rod.d3))

    def normalisation(self, x: ca.SX) -> dict[str, ca.SX]:
        """Conditions at the start that make the directors orthonormal."""
        return self.orientation.normalisation(self._split(x)[0])

    def alignment(self, x: ca.SX, q: ca.SX) -> ca.SX:
        """Three expressions that vanish where the directors are those of the quaternion q."""
        return self.orientation.alignment(self._split(x)[0], q)

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        """States (k, nx) and constants (nc,) that stand for the fields."""
        states, constants = self.balance.pack(fields, reference)
        return np.hstack([fields.r, self.orientation.pack(fields.frames), states]), constants

    def _split(self, x: ca.SX) -> tuple[ca.SX, ca.SX]:
        end = 3 + len(self.orientation.names)
        return x[3:end], x[end:]


#: models by the name a scene gives them (`states:`)
MODELS = {
    "reduced": RodModel(UnitQuaternion(), ConstantForce()),
    "full": RodModel(DirectorTriad(), ForceMomentStates()),
}
