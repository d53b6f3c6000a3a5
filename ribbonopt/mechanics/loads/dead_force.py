"""A dead force per length, the same all along the ribbon: own weight, for example."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.rotations import cross_matrix
from ribbonopt.mechanics.section import Section

from .load import DeadLoad, Theta

NAME = "loads.force"
PARALLEL = 1e-9


@dataclass(frozen=True, eq=False)
class DeadForce(DeadLoad):
    """Components x, y, z of a force per length, lab frame; those not named are zero."""

    components: Mapping[str, float]
    name = NAME

    def numbers(self) -> dict[str, float]:
        return {f"{NAME}.{axis}": value for axis, value in self.components.items()}

    def force(self, section: Section, theta: Theta) -> ca.SX:
        return self._vector(theta)

    def total(self, s: ca.SX, theta: Theta) -> ca.SX:
        return self._vector(theta) * (s - theta("interval.start"))

    def symmetries(self, motions: Array) -> Array:
        # A turn w leaves f where w x f = 0: all but those about the force change it.
        size = max(float(np.linalg.norm(self._values)), np.finfo(float).tiny)
        changed = cross_matrix(self._values / size) @ motions[3:]
        _, singular, right = np.linalg.svd(changed)
        rank = int((singular > PARALLEL).sum())
        return np.asarray(right[rank:].T)

    def work(self, r: Array, weights: Array) -> float:
        return float(weights @ r @ self._values)

    def level(self, r: Array) -> Array:
        return np.asarray(r @ self._values)

    @property
    def _values(self) -> Array:
        return np.array([self.components.get(axis, 0.0) for axis in "xyz"])

    def _vector(self, theta: Theta) -> ca.SX:
        named = self.components
        return ca.vertcat(*(theta(f"{NAME}.{a}") if a in named else 0 for a in "xyz"))
