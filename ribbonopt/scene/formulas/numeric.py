"""Formulas on plain floats: what a scene's own numbers are worth."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Literal

from ribbonopt.classes import dataclass

from .expressions import EndName


@dataclass(frozen=True)
class Vector3:
    """Three floats with the arithmetic of vectors."""

    x: float
    y: float
    z: float

    def __add__(self, other: Vector3) -> Vector3:
        """Return the sum."""
        return Vector3(self.x + other.x, self.y + other.y, self.z + other.z)

    def __sub__(self, other: Vector3) -> Vector3:
        """Return the difference."""
        return self + -other

    def __neg__(self) -> Vector3:
        """Return the opposite vector."""
        return self * -1.0

    def __mul__(self, factor: float) -> Vector3:
        """Return the vector scaled by a factor."""
        return Vector3(self.x * factor, self.y * factor, self.z * factor)

    __rmul__ = __mul__

    def __truediv__(self, divisor: float) -> Vector3:
        """Return the vector divided by a number."""
        return Vector3(self.x / divisor, self.y / divisor, self.z / divisor)

    def dot(self, other: Vector3) -> float:
        """Return the scalar product."""
        return self.x * other.x + self.y * other.y + self.z * other.z

    def cross(self, other: Vector3) -> Vector3:
        """Return the vector product."""
        return Vector3(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )

    def norm(self) -> float:
        """Return the length."""
        return math.hypot(self.x, self.y, self.z)


@dataclass(frozen=True)
class NumericEnv:
    """Plain floats: numbers as written, names from a mapping, no quantities of a ribbon."""

    names: Mapping[str, Any]

    def number(self, value: float, key: str | None) -> float:
        """Return the number itself."""
        return value

    def name(self, name: str) -> Any:
        """Return the value of a name."""
        return self.names[name]

    def quantity(self, name: str, end: EndName) -> Any:
        """Refuse: a ribbon has no quantities before it is solved."""
        raise KeyError(f"{name}({end})")

    def vector(self, components: Sequence[Any]) -> Vector3:
        """Return a vector of floats."""
        return Vector3(*components)

    def component(self, vector: Vector3, axis: Literal["x", "y", "z"]) -> float:
        """Return one component."""
        return {"x": vector.x, "y": vector.y, "z": vector.z}[axis]

    def call(self, function: str, arguments: Sequence[Any]) -> Any:
        """Return the value of a function by `math` or by the vector's own method."""
        if function in ("dot", "cross", "norm"):
            return getattr(arguments[0], function)(*arguments[1:])
        return math.fabs(*arguments) if function == "abs" else getattr(math, function)(*arguments)
