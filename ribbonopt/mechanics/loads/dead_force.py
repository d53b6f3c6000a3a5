"""A dead force per length, which keeps its direction: own weight, for example."""

from __future__ import annotations

from collections.abc import Iterable

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.section import Section

from .components import Components
from .load import DeadLoad, Line, Theta, line_of, turns_that_leave


@dataclass(frozen=True, eq=False)
class DeadForce(DeadLoad):
    """Force per length, lab frame; `name` is its path in the scene."""

    components: Components
    name: str = "loads.force"

    @property
    def lab_axes(self) -> tuple[str, str]:  # type: ignore[override]
        """Those of its components; it has no couple."""
        return self.components.axes, ""

    @property
    def open_axes(self) -> str:  # type: ignore[override]
        return self.components.open_axes

    @property
    def structure_key(self) -> tuple[object, ...]:
        return type(self), self.name, self.components.structure

    def numbers(self) -> dict[str, float]:
        return self.components.numbers()

    def numbers_to_scale(self) -> Iterable[str]:
        return self.components.numbers_to_scale()

    def size_along(self) -> float:
        return float(np.abs(self.components.samples).max())

    def mean_force(self) -> Array:
        return np.asarray(self.components.samples.mean(axis=0))

    def force(self, section: Section, theta: Theta) -> ca.SX:
        return self.components.at(section.s, theta)

    def total(self, s: ca.SX, theta: Theta) -> ca.SX:
        return self.components.total(s, theta)

    def symmetries(self, motions: Array) -> Array:
        # A turn w leaves f where w x f = 0: all but those about the force change it.
        return turns_that_leave(self.components.samples, motions)

    def level(self, r: Array) -> Array | None:
        return np.asarray(r @ self.components.samples[0]) if self.components.uniform else None

    def lines_of_action(self) -> tuple[Line, Line]:
        return line_of(self.components.samples), np.zeros(3)
