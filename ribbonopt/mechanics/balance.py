"""How force and moment are carried, eqs. (2.6)-(2.7) with loads: n' = -f, m' = n x d3 - c.

f and c are the force and the couple per length. What they are decides how little is unknown:

- no load: n and m_0 are constants, m = m_0 + n x (r - reference);
- dead loads, with F(s) their force from the start to s: n = n_0 - F, and
  m = m_0 + n_0 x (r - reference) + a with three more states a' = -F x d3 - c, a = 0 at the start;
- loads that follow the ribbon, or the paper's full states: n and m are states.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array

from .loads.load import DeadLoad, Load, Theta
from .rotations import cross_matrix
from .section import RodFields, Section


class Balance(ABC):
    """How force and moment are carried."""

    states: tuple[str, ...]
    constants: tuple[str, ...] = ("nx", "ny", "nz", "mx", "my", "mz")

    @abstractmethod
    def force_and_moment(
        self, r: ca.SX, x: ca.SX, c: ca.SX, s: ca.SX, reference: ca.SX
    ) -> tuple[ca.SX, ca.SX]:
        """Force n and moment m (lab) from own states x and constants c at the arclength s."""

    def stepped(self, c: ca.SX, s: ca.SX) -> ca.SX | None:
        """Force (3,) of what acts at single places up to s, lab frame; None where nothing can."""
        return None

    def with_passed(self, passed: ca.SX) -> Balance:
        """Return the same in a phase: which stations are before it (1) and behind (0)."""
        return self

    @abstractmethod
    def rates(self, section: Section) -> ca.SX:
        """Return the derivatives of the states along s."""

    def beyond(self, s: ca.SX, end: ca.SX) -> ca.SX:
        """Force (3,) of the dead loads between the arclengths s and `end`, lab frame."""
        return ca.SX.zeros(3)

    def start_conditions(self, x: ca.SX) -> dict[str, ca.SX]:
        """Conditions, by name, on own states x at the start."""
        return {}

    @abstractmethod
    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        """States (k, nx) and constants (nc,) of given fields."""

    @abstractmethod
    def moved(self, x: Array, c: Array) -> tuple[Array, Array]:
        """Return the changes (nx, 6) and (nc, 6) of own states x and constants c by rigid motions.

        Three unit translations, then three unit turns about the reference point.
        """


class ConstantForce(Balance):
    """No loads: constants n and m_0, with m = m_0 + n x (r - reference)."""

    states = ()

    def force_and_moment(
        self, r: ca.SX, x: ca.SX, c: ca.SX, s: ca.SX, reference: ca.SX
    ) -> tuple[ca.SX, ca.SX]:
        return c[:3], c[3:6] + ca.cross(c[:3], r - reference)

    def rates(self, section: Section) -> ca.SX:
        return ca.SX(0, 1)

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        n = fields.n[0]
        moment = fields.m[0] - np.cross(n, fields.r[0] - reference)
        return np.empty((len(fields.r), 0)), np.concatenate([n, moment])

    def moved(self, x: Array, c: Array) -> tuple[Array, Array]:
        return np.empty((0, 6)), _moved_constants(c)


@dataclass(frozen=True, eq=False)
class DeadLoads(Balance):
    """Dead loads: n = n_0 - F(s), m = m_0 + n_0 x (r - reference) + a."""

    loads: tuple[DeadLoad, ...]
    theta: Theta

    states = ("ax", "ay", "az")

    def force_and_moment(
        self, r: ca.SX, x: ca.SX, c: ca.SX, s: ca.SX, reference: ca.SX
    ) -> tuple[ca.SX, ca.SX]:
        return c[:3] - self.total(s), c[3:6] + ca.cross(c[:3], r - reference) + x

    def total(self, s: ca.SX) -> ca.SX:
        """F(s) (3,): the force of all loads from the start to s, lab frame."""
        zero = ca.SX.zeros(3)
        return sum((load.total(s, self.theta) for load in self.loads), zero)

    def rates(self, section: Section) -> ca.SX:
        arm = -ca.cross(self.total(section.s), section.d3)
        return arm - sum((load.couple(section, self.theta) for load in self.loads), ca.SX.zeros(3))

    def beyond(self, s: ca.SX, end: ca.SX) -> ca.SX:
        return self.total(end) - self.total(s)

    def start_conditions(self, x: ca.SX) -> dict[str, ca.SX]:
        return {f"moment of the loads along {axis}": x[i] for i, axis in enumerate("xyz")}

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        n = fields.n[0]
        rest = fields.m - np.cross(n, fields.r - reference)
        return rest - rest[0], np.concatenate([n, rest[0]])

    def moved(self, x: Array, c: Array) -> tuple[Array, Array]:
        return np.hstack([np.zeros((3, 3)), -cross_matrix(x)]), _moved_constants(c)


@dataclass(frozen=True, eq=False)
class ForceMomentStates(Balance):
    """Six states n and m, as eq. (4.5) writes them, under any loads."""

    loads: tuple[Load, ...]
    theta: Theta

    states = ("nx", "ny", "nz", "mx", "my", "mz")
    constants = ()

    def force_and_moment(
        self, r: ca.SX, x: ca.SX, c: ca.SX, s: ca.SX, reference: ca.SX
    ) -> tuple[ca.SX, ca.SX]:
        return x[:3], x[3:6]

    def rates(self, section: Section) -> ca.SX:
        zero = ca.SX.zeros(3)
        force = sum((load.force(section, self.theta) for load in self.loads), zero)
        couple = sum((load.couple(section, self.theta) for load in self.loads), zero)
        return ca.vertcat(-force, ca.cross(section.n, section.d3) - couple)

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        return np.hstack([fields.n, fields.m]), np.empty(0)

    def moved(self, x: Array, c: Array) -> tuple[Array, Array]:
        turned = np.vstack([-cross_matrix(x[:3]), -cross_matrix(x[3:])])
        return np.hstack([np.zeros((6, 3)), turned]), np.empty((0, 6))


def _moved_constants(c: Array) -> Array:
    """Return the changes (6, 6) of n and m_0: that of m_0 is w x m_0 + t x n."""
    n, m0 = -cross_matrix(c[:3]), -cross_matrix(c[3:])
    return np.block([[np.zeros((3, 3)), n], [n, m0]])
