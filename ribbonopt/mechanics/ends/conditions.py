"""What may be prescribed at the ends of a ribbon: one class for each kind of condition.

Each knows its numbers (`theta`: names and values, which become parameters of the problem), its
residuals (zero where the condition holds, one expression per scalar equation) and its verdicts
(what to look at afterwards; more than the residuals where these have other roots). Names are the
paths of the scene file, so that messages speak the user's language.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Literal

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.model import RodModel
from ribbonopt.mechanics.rotations import directors_of, matrix_of, quaternions_from
from ribbonopt.mechanics.section import Section

EndName = Literal["start", "end"]
Named = dict[str, ca.SX]

#: weights of the lab axes: which of them is nearest does not change at 45 degrees, where scenes are
_NEARER = np.array([1.0, 1.07, 1.13])


@dataclass(frozen=True, eq=False)
class CrossSection:
    """The rod at one end: states x of the model, cross section, and strains u (3,)."""

    model: RodModel
    x: ca.SX
    rod: Section
    u: ca.SX


@dataclass(frozen=True, eq=False)
class Context:
    """What conditions are made of: both ends and the parameters of the problem by name."""

    ends: Mapping[EndName, CrossSection]
    theta: Callable[[str], ca.SX]


class Condition(ABC):
    """One thing prescribed at the ends."""

    @abstractmethod
    def theta(self) -> dict[str, float]:
        """Numbers of this condition by parameter name."""

    @abstractmethod
    def residuals(self, context: Context) -> Named:
        """Expressions that vanish where the condition holds, by name."""

    def verdicts(self, context: Context) -> Named:
        """Expressions to verify on a solution, by name; the residuals unless they have others."""
        return self.residuals(context)

    @property
    def kinematic(self) -> bool:
        """Whether it speaks of positions and directors only, not of loads."""
        return True


@dataclass(frozen=True, eq=False)
class Component(Condition):
    """One component of a vector: `quantity` is position, d1, d2, d3, force or moment.

    `axis` is x, y, z (lab frame) or d1, d2, d3 (along a director).
    """

    end: EndName
    quantity: str
    axis: str
    value: float

    @property
    def name(self) -> str:
        """Path of the component in the scene."""
        return f"boundary.{self.end}.{self.quantity}.{self.axis}"

    @property
    def kinematic(self) -> bool:
        return self.quantity not in ("force", "moment")

    def theta(self) -> dict[str, float]:
        return {self.name: self.value}

    def residuals(self, context: Context) -> Named:
        rod = context.ends[self.end].rod
        attribute = {"position": "r", "force": "n", "moment": "m"}.get(self.quantity, self.quantity)
        vector = getattr(rod, attribute)
        if self.axis in ("x", "y", "z"):
            found = vector["xyz".index(self.axis)]
        else:
            found = ca.dot(vector, getattr(rod, self.axis))
        return {self.name: found - context.theta(self.name)}


@dataclass(frozen=True, eq=False)
class Frame(Condition):
    """All three directors, those of a unit quaternion (4,) of either sign.

    Three equations, because the rest is orthonormality. Where the frame moves with a parameter, so
    must the quaternion, without a jump of sign: the sign of the equations is that of q.
    """

    end: EndName
    quaternion: Array

    @classmethod
    def of(cls, end: EndName, frame: Array) -> Frame:
        """Return the condition of a frame (3, 3) that does not move."""
        return cls(end, quaternions_from(frame[None])[0])

    @property
    def frame(self) -> Array:
        """The frame (3, 3), columns d1, d2, d3."""
        return matrix_of(self.quaternion)

    @property
    def name(self) -> str:
        """Path of the frame in the scene."""
        return f"boundary.{self.end}.directors"

    def theta(self) -> dict[str, float]:
        return {f"{self.name}.q{i}": float(self.quaternion[i]) for i in range(4)}

    def residuals(self, context: Context) -> Named:
        section = context.ends[self.end]
        turns = section.model.alignment(section.x, self._quaternion(context))
        return {f"{self.name} ({turn})": residual for turn, residual in turns.items()}

    def verdicts(self, context: Context) -> Named:
        rod = context.ends[self.end].rod
        targets = directors_of(self._quaternion(context))
        found = {"d1": rod.d1, "d2": rod.d2, "d3": rod.d3}
        return {
            f"{self.name}.{name}": ca.norm_2(found[name] - target)
            for name, target in zip(found, targets, strict=True)
        }

    def _quaternion(self, context: Context) -> ca.SX:
        return ca.vertcat(*(context.theta(f"{self.name}.q{i}") for i in range(4)))


@dataclass(frozen=True, eq=False)
class Direction(Condition):
    """One whole director: two equations, that it has no part across the prescribed direction."""

    end: EndName
    director: str
    target: tuple[float, float, float]

    @property
    def name(self) -> str:
        """Path of the director in the scene."""
        return f"boundary.{self.end}.{self.director}"

    def theta(self) -> dict[str, float]:
        target = np.array(self.target)
        across = _across(target)
        vectors = {"across0": across[0], "across1": across[1], "target": target}
        return {
            f"{self.name}.{key}.{axis}": float(v[i])
            for key, v in vectors.items()
            for i, axis in enumerate("xyz")
        }

    def residuals(self, context: Context) -> Named:
        d = getattr(context.ends[self.end].rod, self.director)
        keys = ("across0", "across1")
        return {
            f"{self.name} ({i + 1} of 2)": ca.dot(d, self._vector(context, key))
            for i, key in enumerate(keys)
        }

    def verdicts(self, context: Context) -> Named:
        d = getattr(context.ends[self.end].rod, self.director)
        return {self.name: ca.norm_2(d - self._vector(context, "target"))}

    def _vector(self, context: Context, key: str) -> ca.SX:
        return ca.vertcat(*(context.theta(f"{self.name}.{key}.{axis}") for axis in "xyz"))


def _across(target: Array) -> Array:
    """Two unit vectors (2, 3) across a unit vector (3,) and each other, that move with it.

    The least turn of the nearest lab axis to the target takes the other two to what is across it.
    With the target they are a right-handed frame, so that the sign of the equations never jumps.
    """
    axis = int((_NEARER * np.abs(target)).argmax())
    sign = float(np.copysign(1.0, target[axis]))
    others = np.eye(3)[[(axis + 1) % 3, (axis + 2) % 3]]
    others[0] *= sign
    nearest = sign * np.eye(3)[axis]
    by = np.cross(nearest, target)
    once = np.cross(by, others)
    across: Array = others + once + np.cross(by, once) / (1 + nearest @ target)
    return across


@dataclass(frozen=True, eq=False)
class Equation(Condition):
    """Any equation between quantities at the ends, compiled from a formula of the scene.

    `of_loads` says whether forces, moments or strains occur in it; `numbers` are its literals by
    key; `difference` gives left minus right, a scalar or a vector (3,).
    """

    index: int
    text: str
    of_loads: bool
    numbers: tuple[tuple[str, float], ...]
    difference: Callable[[Context, str], ca.SX]

    @property
    def name(self) -> str:
        """Path of the equation in the scene."""
        return f"boundary.also.{self.index}"

    @property
    def kinematic(self) -> bool:
        return not self.of_loads

    def theta(self) -> dict[str, float]:
        return {f"{self.name}.{key}": value for key, value in self.numbers}

    def residuals(self, context: Context) -> Named:
        difference = self.difference(context, self.name)
        label = f"{self.name} ({self.text})"
        if difference.numel() == 1:
            return {label: difference}
        return {f"{label}.{axis}": difference[i] for i, axis in enumerate("xyz")}
