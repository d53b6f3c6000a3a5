"""A dead couple per length, which keeps its direction while sections turn: it has no potential."""

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
class DeadCouple(DeadLoad):
    """Couple per length, lab frame; there is no force."""

    components: Components
    name = "loads.couple"
    without_potential = "keeps its direction while sections turn, so that it has no potential"

    @property
    def lab_axes(self) -> tuple[str, str]:  # type: ignore[override]
        """Those of its components; it has no force."""
        return "", self.components.axes

    @property
    def structure_key(self) -> tuple[object, ...]:
        return type(self), self.components.structure

    def numbers(self) -> dict[str, float]:
        return self.components.numbers()

    def numbers_to_scale(self) -> Iterable[str]:
        return self.components.numbers_to_scale()

    def size_along(self) -> float:
        return float(np.abs(self.components.samples).max())

    def force(self, section: Section, theta: Theta) -> ca.SX:
        return ca.SX.zeros(3)

    def couple(self, section: Section, theta: Theta) -> ca.SX:
        return self.components.at(section.s, theta)

    def total(self, s: ca.SX, theta: Theta) -> ca.SX:
        return ca.SX.zeros(3)

    def symmetries(self, motions: Array) -> Array:
        return turns_that_leave(self.components.samples, motions)

    def lines_of_action(self) -> tuple[Line, Line]:
        return np.zeros(3), line_of(self.components.samples)
