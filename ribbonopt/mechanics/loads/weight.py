"""Weight per length where the width varies: that of the reference width, times the width."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.along import Field

from .components import Share
from .load import Theta


@dataclass(frozen=True, eq=False)
class OfWidth:
    """A number per length and width, which is uniform, times the width."""

    number: Share
    width: Field

    @property
    def uniform(self) -> bool:
        """Whether it is the same all along the ribbon."""
        return self.width.uniform

    @property
    def scale(self) -> str:
        return self.number.scale

    def numbers(self) -> dict[str, float]:
        return self.number.numbers()  # the width's are those of the scene

    def at(self, s: ca.SX, theta: Theta) -> ca.SX:
        return self.number.at(s, theta) * self.width.at(s, theta)

    def total(self, s: ca.SX, theta: Theta) -> ca.SX | None:
        area = self.width.total(s, theta)
        return None if area is None else self.number.at(s, theta) * area

    def sampled(self, s: Array, theta: Mapping[str, float]) -> Array:
        return self.number.sampled(s, theta) * self.width.sampled(s, theta)

    @property
    def structure(self) -> object:
        return self.number.structure, self.width.structure
