"""What acts or holds at one place of a ribbon: dead loads, loads along directors, supports."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from .loads.load import Theta
from .rotations import cross_matrix
from .section import Section
from .stations import AXES, Action, Unknown

PARALLEL = 1e-9


@dataclass(frozen=True, eq=False)
class DeadPoint(Action):
    """A force and a couple in lab components; those not named are zero."""

    forces: Mapping[str, float]
    couples: Mapping[str, float]

    unknown = ()

    @property
    def without_potential(self) -> str:  # type: ignore[override]
        """A couple that does not turn with the ribbon has no potential in space."""
        return "a moment that keeps its direction has no potential" if self.couples else ""

    @property
    def leaps(self) -> bool:
        return bool(self.couples)

    @property
    def loads(self) -> dict[str, float]:
        found = {f"{self.path}.force.{axis}": value for axis, value in self.forces.items()}
        return found | {f"{self.path}.moment.{axis}": v for axis, v in self.couples.items()}

    def force(self, theta: Theta, unknown: Unknown) -> ca.SX:
        return self._vector("force", self.forces, theta)

    def couple(self, theta: Theta, unknown: Unknown) -> ca.SX:
        return self._vector("moment", self.couples, theta)

    def residuals(self, rod: Section, theta: Theta, unknown: Unknown) -> dict[str, ca.SX]:
        return {}

    def symmetries(self, motions: Array) -> Array:
        free = np.eye(motions.shape[1])
        for given in (self.forces, self.couples):
            vector = np.array([given.get(axis, 0.0) for axis in AXES])
            if (size := float(np.linalg.norm(vector))) > 0:
                changed = cross_matrix(vector / size) @ (motions @ free)[3:]
                _, singular, right = np.linalg.svd(changed)
                free = free @ right[int((singular > PARALLEL).sum()) :].T
        return np.asarray(free)

    def work(self, r: Array) -> float:
        return float(sum(self.forces.get(axis, 0.0) * r[i] for i, axis in enumerate(AXES)))

    def _vector(self, kind: str, given: Mapping[str, float], theta: Theta) -> ca.SX:
        named = (theta(f"{self.path}.{kind}.{a}") if a in given else 0 for a in AXES)
        return ca.vertcat(*(ca.SX(part) for part in named))


@dataclass(frozen=True, eq=False)
class FollowingPoint(Action):
    """A force and a couple along the directors of the place, where they are unknown vectors."""

    forces: Mapping[str, float]
    couples: Mapping[str, float]

    without_potential = "it follows the ribbon"

    @property
    def unknown(self) -> tuple[str, ...]:
        kinds = [kind for kind, given in (("n", self.forces), ("m", self.couples)) if given]
        return tuple(f"{kind}{axis} of {self.path}" for kind in kinds for axis in AXES)

    @property
    def leaps(self) -> bool:
        return bool(self.couples)

    @property
    def loads(self) -> dict[str, float]:
        found = {f"{self.path}.force.{d}": value for d, value in self.forces.items()}
        return found | {f"{self.path}.moment.{d}": v for d, v in self.couples.items()}

    def force(self, theta: Theta, unknown: Unknown) -> ca.SX:
        return self._vector("n", unknown) if self.forces else ca.SX.zeros(3)

    def couple(self, theta: Theta, unknown: Unknown) -> ca.SX:
        return self._vector("m", unknown) if self.couples else ca.SX.zeros(3)

    def residuals(self, rod: Section, theta: Theta, unknown: Unknown) -> dict[str, ca.SX]:
        result: dict[str, ca.SX] = {}
        for kind, name, given in (("n", "force", self.forces), ("m", "moment", self.couples)):
            if given:
                parts = [theta(f"{self.path}.{name}.{d}") * getattr(rod, d) for d in given]
                off = self._vector(kind, unknown) - sum(parts[1:], parts[0])
                result |= {f"{self.path}.{name} ({a})": off[i] for i, a in enumerate(AXES)}
        return result

    def _vector(self, kind: str, unknown: Unknown) -> ca.SX:
        return ca.vertcat(*(unknown(f"{kind}{axis} of {self.path}") for axis in AXES))


@dataclass(frozen=True, eq=False)
class Held(Action):
    """Components of the position that are held: the reaction along each is unknown."""

    place: Mapping[str, float]

    @property
    def loads(self) -> dict[str, float]:
        return {}

    @property
    def unknown(self) -> tuple[str, ...]:
        return tuple(f"n{axis} of {self.path}" for axis in self.place)

    def numbers(self) -> dict[str, float]:
        held = {f"{self.path}.position.{axis}": value for axis, value in self.place.items()}
        return {f"{self.path}.at": self.at, **held}

    def force(self, theta: Theta, unknown: Unknown) -> ca.SX:
        named = (unknown(f"n{a} of {self.path}") if a in self.place else ca.SX(0) for a in AXES)
        return ca.vertcat(*named)

    def residuals(self, rod: Section, theta: Theta, unknown: Unknown) -> dict[str, ca.SX]:
        names = {axis: f"{self.path}.position.{axis}" for axis in self.place}
        return {name: rod.r[AXES.index(axis)] - theta(name) for axis, name in names.items()}
