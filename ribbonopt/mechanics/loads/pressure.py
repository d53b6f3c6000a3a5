"""Pressure: a force per length along the normal d1, which follows the ribbon, n' = -p d1.

Per length as it is stretched, if it stretches: n' = -p (1 + e) d1.
"""

from __future__ import annotations

from collections.abc import Iterable

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.section import Section

from .components import Share
from .load import DeadLoad, Line, Load, Theta


@dataclass(frozen=True, eq=False)
class Pressure(Load):
    """Force p per length along d1, all along the ribbon, `largest` at most."""

    p: Share
    largest: float
    name = "loads.pressure"

    @property
    def structure_key(self) -> tuple[object, ...]:
        return type(self), self.p.structure

    def numbers(self) -> dict[str, float]:
        return self.p.numbers()

    def numbers_to_scale(self) -> Iterable[str]:
        return (self.p.scale,)

    def size_along(self) -> float:
        return self.largest

    def force(self, section: Section, theta: Theta) -> ca.SX:
        return self.p.at(section.s, theta) * section.stretched * section.d1

    def symmetries(self, motions: Array) -> Array:
        return np.eye(motions.shape[1])  # it follows every motion

    def level(self, r: Array) -> Array | None:
        return np.zeros(len(r))  # it does no work along d3: H itself is constant

    def level_in_plane(self, n: Array, m2: Array) -> Array | None:
        if not self.p.uniform:
            return None
        (p,) = self.p.numbers().values()
        return np.asarray(np.sum(n**2, axis=1) / 2 - p * m2)

    def is_carried(self, *, about_d2: bool) -> bool:
        return self.p.uniform and not about_d2  # d1 continues where the flip is about it

    def in_plane(self) -> Load | None:
        return PlanarPressure(self.p) if self.p.uniform else None

    def lines_of_action(self) -> tuple[Line, Line]:
        return None, np.zeros(3)


@dataclass(frozen=True, eq=False)
class PlanarPressure(DeadLoad):
    """A uniform pressure on a ribbon that stays in a plane, where p times the area is its work.

    The area between the centre line and lines from its ends to the point of reference: ends that
    move do so along these lines, or the energy is not stationary. Of use to that alone.
    """

    p: Share
    name = "loads.pressure"
    open_axes = "xyz"

    def numbers(self) -> dict[str, float]:
        return self.p.numbers()

    def force(self, section: Section, theta: Theta) -> ca.SX:
        return self.p.at(section.s, theta) * section.stretched * section.d1

    def work(self, section: Section, theta: Theta) -> ca.SX:
        arm = section.r - ca.vertcat(*(theta(f"reference.{axis}") for axis in "xyz"))
        return self.p.at(section.s, theta) * section.stretched * ca.dot(arm, section.d1) / 2

    def total(self, s: ca.SX, theta: Theta) -> ca.SX:
        return ca.SX.zeros(3)

    def symmetries(self, motions: Array) -> Array:
        return np.eye(motions.shape[1])
