"""The Cosserat rod: which unknowns describe it, and its equations, whatever the law.

An *orientation* says how the directors are carried, a *balance* how force and moment are. The scene
chooses (`states:`)

- `reduced`: position and a unit quaternion (7), and the least that the loads leave unknown of force
  and moment: without loads six constants, because n is constant in the lab frame and
  m = m_0 + n x (r - r_0), the integral of eqs. (2.6)-(2.7);
- `full`: the paper's 18 states r, d1, d2, d3, n, m of eq. (4.5).

Vectors are lab-frame components unless a name ends in 1, 2 or 3 (along a director).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array

from .balance import Balance, ConstantForce, DeadLoads, ForceMomentStates
from .loads.load import DeadLoad, Load, Theta
from .orientation import DirectorTriad, Orientation, UnitQuaternion
from .section import RodFields, Section


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

    @property
    def unknowns(self) -> Mapping[str, int]:
        """Unknown numbers that conditions must determine, by what they stand for."""
        rest = len(self.balance.states) + len(self.balance.constants) - 6
        counts = {"position": 3, "directors": len(self.orientation.names), "force": 3, "moment": 3}
        return counts | ({"moment of the loads": rest} if rest else {})

    def section(
        self, x: ca.SX, c: ca.SX, s: ca.SX, reference: ca.SX, own: ca.SX | None = None
    ) -> Section:
        """Cross section at the states x, constants c and arclength s.

        `reference` (3,) is where the moment of c acts, `own` are states of the law.
        """
        q, rest = self._split(x)
        n, m = self.balance.force_and_moment(x[:3], rest, c, s, reference)
        directors = self.orientation.directors(q)
        return Section(x[:3], *directors, n, m, s, ca.SX(0, 1) if own is None else own)

    def rates(self, x: ca.SX, section: Section, u: ca.SX) -> ca.SX:
        """dx/ds for the Darboux vector u (3,) along the directors, eqs. (2.1), (2.2), (2.7)."""
        q, _ = self._split(x)
        turn = self.orientation.rates(q, u)
        return ca.vertcat(section.d3, turn, self.balance.rates(section))

    def start_conditions(self, x: ca.SX) -> dict[str, ca.SX]:
        """Conditions at the start that make states mean what they stand for, by name."""
        q, rest = self._split(x)
        return self.orientation.normalisation(q) | self.balance.start_conditions(rest)

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


def least_model(loads: tuple[Load, ...], theta: Theta) -> RodModel:
    """Return the model with the fewest unknowns that loads allow."""
    if not loads:
        return RodModel(UnitQuaternion(), ConstantForce())
    dead = tuple(load for load in loads if isinstance(load, DeadLoad))
    if len(dead) == len(loads):
        return RodModel(UnitQuaternion(), DeadLoads(dead, theta))
    return RodModel(UnitQuaternion(), ForceMomentStates(loads, theta))


def full_model(loads: tuple[Load, ...], theta: Theta) -> RodModel:
    """Return the paper's 18 states, under any loads."""
    return RodModel(DirectorTriad(), ForceMomentStates(loads, theta))


#: models by the name a scene gives them (`states:`)
MODELS = {"auto": least_model, "reduced": least_model, "full": full_model}
