"""The Cosserat rod: which unknowns describe it, and its equations, whatever the law.

An *orientation* says how the directors are carried, a *balance* how force and moment are. The scene
chooses (`states:`)

- `reduced`: position and a unit quaternion (7), and the least that the loads leave unknown of force
  and moment: without loads six constants, because n is constant in the lab frame and
  m = m_0 + n x (r - r_0), the integral of eqs. (2.6)-(2.7);
- `planar`: the same in a plane across the width: two coordinates and an angle (3 + 3);
- `full`: the paper's 18 states r, d1, d2, d3, n, m of eq. (4.5).

Vectors are lab-frame components unless a name ends in 1, 2 or 3 (along a director).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from .balance import Balance, ConstantForce, DeadLoads, ForceMomentStates
from .loads.load import DeadLoad, Load, Theta
from .orientation import DirectorTriad, Orientation, UnitQuaternion
from .rotations import cross_matrix, matrix_of, product
from .section import RodFields, Section

if TYPE_CHECKING:
    from .stations import Station


class RodModel(ABC):
    """Unknowns and equations of a rod."""

    #: another model has fewer unknowns under the same loads
    redundant: bool = False

    @property
    @abstractmethod
    def states(self) -> tuple[str, ...]:
        """Names of the states along s."""

    @property
    @abstractmethod
    def constants(self) -> tuple[str, ...]:
        """Names of the unknown constants."""

    @property
    @abstractmethod
    def unknowns(self) -> Mapping[str, int]:
        """Unknown numbers that conditions must determine, by what they stand for."""

    @property
    def motions(self) -> Array:
        """Combinations (6, k) of translations and turns that it can make."""
        return np.eye(6)

    @abstractmethod
    def with_passed(self, passed: ca.SX) -> RodModel:
        """Return the same in a phase between stations: which are before it (1) and behind (0)."""

    @abstractmethod
    def section(
        self, x: ca.SX, c: ca.SX, s: ca.SX, reference: ca.SX, own: ca.SX | None = None
    ) -> Section:
        """Cross section at the states x, constants c and arclength s.

        `reference` (3,) is where the moment of c acts, `own` are states of the law.
        """

    @abstractmethod
    def rates(self, x: ca.SX, section: Section, u: ca.SX) -> ca.SX:
        """dx/ds for the Darboux vector u (3,) along the directors, eqs. (2.1), (2.2), (2.7)."""

    @abstractmethod
    def beyond(self, s: ca.SX) -> ca.SX:
        """Force (3,) of the dead loads at single places behind the arclength s, lab frame."""

    @abstractmethod
    def start_conditions(self, x: ca.SX) -> dict[str, ca.SX]:
        """Conditions at the start that make states mean what they stand for, by name."""

    @abstractmethod
    def alignment(self, x: ca.SX, q: ca.SX) -> dict[str, ca.SX]:
        """Expressions, by the turn they measure, that vanish where the frame is that of q (4,)."""

    @abstractmethod
    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        """States (k, nx) and constants (nc,) that stand for the fields."""

    @abstractmethod
    def place(self, x: Array) -> tuple[Array, Array]:
        """Position (3,) and frame (3, 3) of states (nx,)."""

    @abstractmethod
    def defect(self, x: Array) -> tuple[Array, Array]:
        """Residuals (k,) and Jacobian (k, nx) of what makes states (nx,) those of a frame."""

    @abstractmethod
    def of_costates(self, x: ca.SX, costate: ca.SX, dead: ca.SX, reference: ca.SX) -> ca.SX:
        """Force and moment about the reference (6,), lab frame, from costates: `problem.energy`.

        `dead` (3,) is the force that these are without.
        """

    @abstractmethod
    def moved(self, x: Array, c: Array, reference: Array) -> tuple[Array, Array]:
        """Return the changes (nx, 6) and (nc, 6) by unit translations and turns."""


@dataclass(frozen=True, eq=False)
class SpatialRod(RodModel):
    """Position, and an orientation and a balance of any kind."""

    orientation: Orientation
    balance: Balance

    @property
    def redundant(self) -> bool:  # type: ignore[override]
        """Directors are nine states of which four would do."""
        return isinstance(self.orientation, DirectorTriad)

    @property
    def states(self) -> tuple[str, ...]:
        return ("rx", "ry", "rz", *self.orientation.names, *self.balance.states)

    @property
    def constants(self) -> tuple[str, ...]:
        return self.balance.constants

    @property
    def unknowns(self) -> Mapping[str, int]:
        counts = {"position": 3, "directors": len(self.orientation.names), "force": 3, "moment": 3}
        return counts | of_loads(self.balance.states, self.balance.constants, 6)

    def with_passed(self, passed: ca.SX) -> RodModel:
        return replace(self, balance=self.balance.with_passed(passed))

    def section(
        self, x: ca.SX, c: ca.SX, s: ca.SX, reference: ca.SX, own: ca.SX | None = None
    ) -> Section:
        q, rest = self._split(x)
        n, m = self.balance.force_and_moment(x[:3], rest, c, s, reference)
        directors = self.orientation.directors(q)
        own = ca.SX(0, 1) if own is None else own
        return Section(x[:3], *directors, n, m, s, own, self.balance.stepped(c, s))

    def rates(self, x: ca.SX, section: Section, u: ca.SX) -> ca.SX:
        q, rest = self._split(x)
        turn = self.orientation.rates(q, u)
        return ca.vertcat(section.tangent, turn, self.balance.rates(section, rest))

    def beyond(self, s: ca.SX) -> ca.SX:
        return self.balance.beyond(s)

    def start_conditions(self, x: ca.SX) -> dict[str, ca.SX]:
        q, rest = self._split(x)
        return self.orientation.normalisation(q) | self.balance.start_conditions(rest)

    def alignment(self, x: ca.SX, q: ca.SX) -> dict[str, ca.SX]:
        residual = self.orientation.alignment(self._split(x)[0], q)
        return {f"turn about {axis}": residual[i] for i, axis in enumerate("xyz")}

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        states, constants = self.balance.pack(fields, reference)
        return np.hstack([fields.r, self.orientation.pack(fields.frames), states]), constants

    def place(self, x: Array) -> tuple[Array, Array]:
        return x[:3], matrix_of(x[3:7])

    def defect(self, x: Array) -> tuple[Array, Array]:
        q, jacobian = x[3:7], np.zeros((1, len(x)))
        jacobian[0, 3:7] = 2 * q
        return np.array([q @ q - 1]), jacobian

    def of_costates(self, x: ca.SX, costate: ca.SX, dead: ca.SX, reference: ca.SX) -> ca.SX:
        n, q = costate[:3] + dead, ca.vertsplit(x[3:7])
        basis = ((0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1))
        m = ca.vertcat(*(ca.dot(costate[3:7], ca.vertcat(*product(e, q))) / 2 for e in basis))
        return ca.vertcat(n, m - ca.cross(n, x[:3] - reference))

    def moved(self, x: Array, c: Array, reference: Array) -> tuple[Array, Array]:
        result = np.zeros((len(x), 6))
        q0, q = x[3], x[4:7]
        result[:3, :3] = np.eye(3)
        result[:3, 3:] = -cross_matrix(x[:3] - reference)
        result[3, 3:] = -q / 2
        result[4:7, 3:] = (q0 * np.eye(3) - cross_matrix(q)) / 2
        own = slice(7, 7 + len(self.balance.states))
        result[own], constants = self.balance.moved(x[own], c)
        return result, constants

    def _split(self, x: ca.SX) -> tuple[ca.SX, ca.SX]:
        end = 3 + len(self.orientation.names)
        return x[3:end], x[end:]


def of_loads(states: tuple[str, ...], constants: tuple[str, ...], usual: int) -> dict[str, int]:
    """Return unknown numbers of a balance beside the usual ones, by what they stand for."""
    reactions = sum(" of " in name for name in constants)
    rest = len(states) + len(constants) - usual - reactions
    counts = {"moment of the loads": rest, "forces and moments at single places": reactions}
    return {words: count for words, count in counts.items() if count}


def least_balance(
    loads: tuple[Load, ...], theta: Theta, stations: tuple[Station, ...] = ()
) -> Balance:
    """Return the balance with the fewest unknowns that loads and stations allow."""
    dead = tuple(load for load in loads if isinstance(load, DeadLoad))
    found: Balance = ConstantForce()
    if loads:
        every = len(dead) == len(loads)
        found = DeadLoads(dead, theta) if every else ForceMomentStates(loads, theta)
    return _stepped(found, stations, theta)


def least_model(
    loads: tuple[Load, ...], theta: Theta, stations: tuple[Station, ...] = ()
) -> RodModel:
    """Return the model in space with the fewest unknowns that loads and stations allow."""
    return SpatialRod(UnitQuaternion(), least_balance(loads, theta, stations))


def full_model(
    loads: tuple[Load, ...], theta: Theta, stations: tuple[Station, ...] = ()
) -> RodModel:
    """Return the paper's 18 states, under any loads."""
    balance = _stepped(ForceMomentStates(loads, theta), stations, theta)
    return SpatialRod(DirectorTriad(), balance)


def _stepped(balance: Balance, stations: tuple[Station, ...], theta: Theta) -> Balance:
    if not stations:
        return balance
    from .stepped import Stepped  # few scenes have stations

    return Stepped(balance, stations, theta)
