"""How force and moment are carried, eqs. (2.6)-(2.7) with loads: n' = -f, m' = n x r' - c.

r' is d3, or (1 + e) d3 where the centre line stretches; f and c are the force and the couple per
length (as it was before it stretched). What they are decides how little is unknown:

- no load: n and m_0 are constants, m = m_0 + n x (r - reference);
- dead loads, with F(s) their force from the start to s: n = n_0 - F, and
  m = m_0 + n_0 x (r - reference) + a with more states a' = -F x r' - c, a = 0 at the start: three,
  or two if all forces have one direction, across which a is. A component of F without a closed form
  is one state more, F' = f;
- loads that follow the ribbon, or the paper's full states: n and m are states.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from .loads.load import DeadLoad, Load, Theta
from .rotations import cross_matrix
from .section import RodFields, Section

AXES = "xyz"


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
    def rates(self, section: Section, x: ca.SX) -> ca.SX:
        """Return the derivatives of the own states x along s."""

    def beyond(self, s: ca.SX) -> ca.SX:
        """Force (3,) of the dead loads at single places behind the arclength s, lab frame."""
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

    def rates(self, section: Section, x: ca.SX) -> ca.SX:
        return ca.SX(0, 1)

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        n = fields.n[0]
        moment = fields.m[0] - cross_matrix(n) @ (fields.r[0] - reference)
        return np.empty((len(fields.r), 0)), np.concatenate([n, moment])

    def moved(self, x: Array, c: Array) -> tuple[Array, Array]:
        return np.empty((0, 6)), _moved_constants(c)


@dataclass(frozen=True, eq=False)
class DeadLoads(Balance):
    """Dead loads: n = n_0 - F(s), m = m_0 + n_0 x (r - reference) + a."""

    loads: tuple[DeadLoad, ...]
    theta: Theta

    @cached_property
    def states(self) -> tuple[str, ...]:  # type: ignore[override]
        forces, couples = ({*"".join(load.lab_axes[i] for load in self.loads)} for i in (0, 1))
        open_ = {axis for load in self.loads for axis in load.open_axes}
        turned = {axis for axis in AXES if forces - {axis}} | couples
        return tuple([f"a{i}" for i in AXES if i in turned] + [f"F{i}" for i in AXES if i in open_])

    def force_and_moment(
        self, r: ca.SX, x: ca.SX, c: ca.SX, s: ca.SX, reference: ca.SX
    ) -> tuple[ca.SX, ca.SX]:
        n = c[:3] - self._total(s, x)
        return n, c[3:6] + ca.cross(c[:3], r - reference) + self._moment(x)

    def rates(self, section: Section, x: ca.SX) -> ca.SX:
        force, couple = _acting(self.loads, section, self.theta)
        whole = {"a": -ca.cross(self._total(section.s, x), section.tangent) - couple, "F": force}
        return ca.vertcat(*(whole[name[0]][AXES.index(name[1])] for name in self.states))

    def start_conditions(self, x: ca.SX) -> dict[str, ca.SX]:
        words = {"a": "moment", "F": "force"}
        return {
            f"{words[name[0]]} of the loads along {name[1]}": x[i]
            for i, name in enumerate(self.states)
        }

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        n = fields.n[0]
        rest = fields.m - np.cross(n, fields.r - reference)
        whole = {"a": rest - rest[0], "F": n - fields.n}
        states = [whole[name[0]][:, AXES.index(name[1])] for name in self.states]
        return np.reshape(states, (-1, len(rest))).T, np.concatenate([n, rest[0]])

    def moved(self, x: Array, c: Array) -> tuple[Array, Array]:
        known = dict(zip(self.states, x, strict=True))
        result = np.zeros((len(x), 6))
        for i, name in enumerate(self.states):
            whole = np.array([known.get(f"{name[0]}{axis}", 0.0) for axis in AXES])
            result[i, 3:] = -cross_matrix(whole)[AXES.index(name[1])]
        return result, _moved_constants(c)

    def _total(self, s: ca.SX, x: ca.SX) -> ca.SX:
        """F(s) (3,): the force of all loads from the start to s, lab frame."""
        known = sum((load.total(s, self.theta) for load in self.loads), ca.SX.zeros(3))
        states = dict(zip(self.states, ca.vertsplit(x), strict=True))
        return ca.vertcat(*(states.get(f"F{axis}", known[i]) for i, axis in enumerate(AXES)))

    def _moment(self, x: ca.SX) -> ca.SX:
        """Return a (3,), lab frame."""
        states = dict(zip(self.states, ca.vertsplit(x), strict=True))
        return ca.vertcat(*(states.get(f"a{axis}", 0) for axis in AXES))


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

    def rates(self, section: Section, x: ca.SX) -> ca.SX:
        force, couple = _acting(self.loads, section, self.theta)
        return ca.vertcat(-force, ca.cross(section.n, section.tangent) - couple)

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        return np.hstack([fields.n, fields.m]), np.empty(0)

    def moved(self, x: Array, c: Array) -> tuple[Array, Array]:
        turned = np.vstack([-cross_matrix(x[:3]), -cross_matrix(x[3:])])
        return np.hstack([np.zeros((6, 3)), turned]), np.empty((0, 6))


def _acting(loads: tuple[Load, ...], section: Section, theta: Theta) -> tuple[ca.SX, ca.SX]:
    """Force and couple (3,) per length of all loads at a section, lab frame."""
    zero = ca.SX.zeros(3)
    force = sum((load.force(section, theta) for load in loads), zero)
    return force, sum((load.couple(section, theta) for load in loads), zero)


def _moved_constants(c: Array) -> Array:
    """Return the changes (6, 6) of n and m_0: that of m_0 is w x m_0 + t x n."""
    n, m0 = -cross_matrix(c[:3]), -cross_matrix(c[3:])
    return np.block([[np.zeros((3, 3)), n], [n, m0]])
