"""A rod in a plane: two coordinates and an angle, one bending moment, nothing across the plane.

The plane is a lab plane; d2, across the width, is along its normal. With unit vectors a, b of the
plane, d1 = cos(turn) a - sin(turn) b and d3 = sin(turn) a + cos(turn) b, so that turn' = u2.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError
from ribbonopt.scene.planes import Said

from .balance import Balance
from .loads.load import Load, Theta
from .model import RodModel, least_balance, of_loads
from .rotations import directors_of
from .section import RodFields, Section

if TYPE_CHECKING:
    from .stations import Station

ALONG = 1 - 1e-9  # least component of d2 along the normal of its plane
AXES = "xyz"


@dataclass(frozen=True)
class Plane:
    """The plane across a lab axis (0, 1, 2: x, y, z), d2 along it or, for sign -1, against it."""

    axis: int
    sign: int

    @classmethod
    def of(cls, frame: Array, words: Said) -> Plane:
        """Return the plane across d2 of a frame (3, 3); `words` are those that ask for it.

        Raises
        ------
        ModelError
            If d2 is along no axis of the lab.
        """
        d2 = frame[:, 1]
        axis = int(np.abs(d2).argmax())
        if abs(d2[axis]) < ALONG:
            found = ", ".join(f"{v:.3g}" for v in d2)
            raise ModelError(
                f"{words.words} needs d2 at the start along an axis of the lab, found ({found}); "
                f"turn the scene, or {words.instead}",
                words.key,
            )
        return cls(axis, 1 if d2[axis] > 0 else -1)

    @property
    def inside(self) -> tuple[int, int]:
        """Lab components of positions and forces in the plane, of a and b."""
        return (self.axis + 2) % 3, (self.axis + 1) % 3

    @property
    def basis(self) -> tuple[Array, Array]:
        """Unit vectors a and b (3,), lab frame: b x a is along d2."""
        i, j = self.inside
        return self.sign * np.eye(3)[i], np.eye(3)[j]


@dataclass(frozen=True, eq=False)
class PlanarRod(RodModel):
    """A rod in a plane, with what a balance in space has in it."""

    plane: Plane
    balance: Balance

    @property
    def states(self) -> tuple[str, ...]:
        return self._names[0]

    @property
    def constants(self) -> tuple[str, ...]:
        return self._names[1]

    @property
    def unknowns(self) -> Mapping[str, int]:
        balance = self.states[3:], self.constants
        counts = {"position": 2, "directors": 1, "force": 2, "moment": 1}
        return counts | of_loads(*balance, 3)

    def with_passed(self, passed: ca.SX) -> RodModel:
        return replace(self, balance=self.balance.with_passed(passed))

    @property
    def motions(self) -> Array:
        kept = [*self.plane.inside, 3 + self.plane.axis]
        return np.eye(6)[:, kept]

    def section(
        self, x: ca.SX, c: ca.SX, s: ca.SX, reference: ca.SX, own: ca.SX | None = None
    ) -> Section:
        i, j = self.plane.inside
        r = ca.vertcat(*(x[0] if k == i else x[1] if k == j else reference[k] for k in range(3)))
        rest, whole = self._whole(self.balance.states, x[3:]), self.balance.constants
        n, m = self.balance.force_and_moment(r, rest, self._whole(whole, c), s, reference)
        stepped = self.balance.stepped(self._whole(whole, c), s)
        own = ca.SX(0, 1) if own is None else own
        return Section(r, *self._directors(x[2]), n, m, s, own, stepped)

    def rates(self, x: ca.SX, section: Section, u: ca.SX) -> ca.SX:
        own = self._whole(self.balance.states, x[3:])
        rest = self.balance.rates(section, own)[self._both[0]]
        return ca.vertcat(section.tangent[list(self.plane.inside)], u[1], rest)

    def beyond(self, s: ca.SX) -> ca.SX:
        return self.balance.beyond(s)

    def start_conditions(self, x: ca.SX) -> dict[str, ca.SX]:
        found = self.balance.start_conditions(self._whole(self.balance.states, x[3:]))
        return {name: value for name, value in found.items() if not value.is_zero()}

    def alignment(self, x: ca.SX, q: ca.SX) -> dict[str, ca.SX]:
        # d3 turned about d2 has a part along the normal d1 of the frame it should be in.
        return {"turn in the plane": ca.dot(directors_of(q)[0], self._directors(x[2])[2])}

    def pack(self, fields: RodFields, reference: Array) -> tuple[Array, Array]:
        states, constants = self.balance.pack(fields, reference)
        (i, j), d3, (own, fixed) = self.plane.inside, fields.frames[:, :, 2], self._both
        turn = np.arctan2(self.plane.sign * d3[:, i], d3[:, j])
        if len(turn) > 1 and np.abs(turn[1:] - turn[:-1]).max() > np.pi:
            turn = np.unwrap(turn)
        x = np.empty((len(turn), 3 + len(own)))
        x[:, 0], x[:, 1], x[:, 2] = fields.r[:, i], fields.r[:, j], turn
        x[:, 3:] = states[:, own]
        return x, constants[fixed]

    def place(self, x: Array) -> tuple[Array, Array]:
        r = np.zeros(3)
        r[list(self.plane.inside)] = x[:2]
        directors = self._directors(ca.SX(float(x[2])))
        d1, d2, d3 = (np.array(ca.evalf(d)).ravel() for d in directors)
        return r, np.stack([d1, d2, d3], axis=1)

    def defect(self, x: Array) -> tuple[Array, Array]:
        return np.empty(0), np.empty((0, len(x)))

    def of_costates(self, x: ca.SX, costate: ca.SX, dead: ca.SX, reference: ca.SX) -> ca.SX:
        (i, j), n, m, arm = self.plane.inside, ca.SX(3, 1), ca.SX(3, 1), ca.SX(3, 1)
        n[i], n[j] = costate[0] + dead[i], costate[1] + dead[j]
        m[self.plane.axis] = self.plane.sign * costate[2]
        arm[i], arm[j] = x[0] - reference[i], x[1] - reference[j]
        return ca.vertcat(n, m - ca.cross(n, arm))

    def moved(self, x: Array, c: Array, reference: Array) -> tuple[Array, Array]:
        (i, j), k = self.plane.inside, self.plane.axis
        result = np.zeros((len(x), 6))
        result[0, i] = result[1, j] = 1
        off = np.zeros(3)
        off[[i, j]] = x[:2] - reference[[i, j]]
        result[:2, 3 + k] = np.cross(np.eye(3)[k], off)[[i, j]]
        result[2, 3 + k] = self.plane.sign
        whole = [np.zeros(len(names)) for names in (self.balance.states, self.balance.constants)]
        kept = self._both
        whole[0][kept[0]], whole[1][kept[1]] = x[3:], c
        states, constants = self.balance.moved(*whole)
        result[3:] = states[kept[0]]
        return result, constants[kept[1]]

    @cached_property
    def _both(self) -> tuple[list[int], list[int]]:
        """Places in the plane of the states and of the constants of the balance."""
        return self._kept(self.balance.states), self._kept(self.balance.constants)

    @cached_property
    def _names(self) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Names of states and of constants."""
        (own, fixed), balance = self._both, self.balance
        place = (f"r{AXES[i]}" for i in self.plane.inside)
        states = (*place, "turn", *(balance.states[i] for i in own))
        return states, tuple(balance.constants[i] for i in fixed)

    def _directors(self, turn: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
        a, b = (ca.SX(ca.sparsify(ca.DM(v))) for v in self.plane.basis)
        normal = ca.SX(ca.sparsify(ca.DM(self.plane.sign * np.eye(3)[self.plane.axis])))
        cos, sin = ca.cos(turn), ca.sin(turn)
        return cos * a - sin * b, normal, sin * a + cos * b

    def _kept(self, names: tuple[str, ...]) -> list[int]:
        """Places of the components of a balance that are in the plane, by its names."""
        inside = {AXES[i] for i in self.plane.inside}
        across = AXES[self.plane.axis]
        axes = {"n": inside, "F": inside, "m": {across}, "a": {across}, "b": {across}}
        return [i for i, name in enumerate(names) if name[1] in axes[name[0]]]

    def _whole(self, names: tuple[str, ...], part: ca.SX) -> ca.SX:
        """All components of a balance from those in the plane."""
        known = dict(zip(self._kept(names), ca.vertsplit(part), strict=True))
        return ca.vertcat(*(known.get(i, ca.SX(0)) for i in range(len(names))))


def planar_model(
    loads: tuple[Load, ...], theta: Theta, plane: Plane, stations: tuple[Station, ...] = ()
) -> RodModel:
    """Return the model in a plane with the fewest unknowns that loads and stations allow."""
    return PlanarRod(plane, least_balance(loads, theta, stations))
