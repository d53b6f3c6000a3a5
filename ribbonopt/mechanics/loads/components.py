"""Lab components of what acts per length: numbers along the ribbon that grow from nothing.

A plain number is a parameter of the problem; what a formula or a table gives is multiplied by one
more, its share, which is 1 but where an equilibrium is followed from the ribbon without loads.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import Protocol

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.along import Field

from .load import Theta

PLACES = 33  # at which loads that vary are looked at


class Part(Protocol):
    """One component per length, units Dw = L = 1."""

    @property
    def scale(self) -> str:
        """Name of the number to multiply to have more of it."""

    @property
    def uniform(self) -> bool:
        """Whether it is the same all along the ribbon."""

    def numbers(self) -> dict[str, float]:
        """Numbers by parameter name."""

    def at(self, s: ca.SX, theta: Theta) -> ca.SX:
        """Value at an arclength."""

    def total(self, s: ca.SX, theta: Theta) -> ca.SX | None:
        """Integral from the start of the ribbon to s; None where it has no closed form."""

    def sampled(self, s: Array, theta: Mapping[str, float]) -> Array:
        """Values (k,) at arclengths."""

    @property
    def structure(self) -> object:
        """What a rebuild depends on."""


@dataclass(frozen=True, eq=False)
class Share:
    """A field along the ribbon, times its share where it is no plain number."""

    field: Field

    @property
    def uniform(self) -> bool:
        """Whether it is the same all along the ribbon."""
        return self.field.uniform

    @property
    def scale(self) -> str:
        """The number itself, or the share."""
        name = self.field.name
        return name if name in self.field.numbers() else f"{name}.share"

    def numbers(self) -> dict[str, float]:
        found = self.field.numbers()
        return found if self.scale in found else found | {self.scale: 1.0}

    def at(self, s: ca.SX, theta: Theta) -> ca.SX:
        return self._shared(self.field.at(s, theta), theta)

    def total(self, s: ca.SX, theta: Theta) -> ca.SX | None:
        found = self.field.total(s, theta)
        return None if found is None else self._shared(found, theta)

    def sampled(self, s: Array, theta: Mapping[str, float]) -> Array:
        name = self.field.name
        return np.full(len(s), theta[name]) if name in theta else self.field.sampled(s, theta)

    @property
    def structure(self) -> object:
        return self.field.structure

    def _shared(self, value: ca.SX, theta: Theta) -> ca.SX:
        return value if self.scale in self.field.numbers() else theta(self.scale) * value


@dataclass(frozen=True, eq=False)
class Components:
    """Components by lab axis; those not named are zero.

    `theta` are the numbers of the scene by name, `interval` the ends of the ribbon.
    """

    parts: Mapping[str, Part]
    theta: Mapping[str, float]
    interval: tuple[float, float]

    @property
    def axes(self) -> str:
        """Axes that have a component."""
        return "".join(self.parts)

    @property
    def open_axes(self) -> str:
        """Axes whose component has no integral in closed form."""
        s = ca.SX.sym("s")
        return "".join(a for a, part in self.parts.items() if part.total(s, ca.SX.sym) is None)

    @property
    def uniform(self) -> bool:
        """Whether they are the same all along the ribbon."""
        return all(part.uniform for part in self.parts.values())

    @property
    def structure(self) -> tuple[object, ...]:
        """What a rebuild depends on."""
        return tuple((axis, part.structure) for axis, part in self.parts.items())

    def numbers(self) -> dict[str, float]:
        """Return all numbers by parameter name."""
        return {k: v for part in self.parts.values() for k, v in part.numbers().items()}

    def numbers_to_scale(self) -> Iterable[str]:
        """Names of what to multiply by a share."""
        return [part.scale for part in self.parts.values()]

    def at(self, s: ca.SX, theta: Theta) -> ca.SX:
        """Vector (3,) at an arclength."""
        return ca.vertcat(*(self.parts[a].at(s, theta) if a in self.parts else 0 for a in "xyz"))

    def total(self, s: ca.SX, theta: Theta) -> ca.SX:
        """Integral (3,) up to an arclength; zero where it has no closed form."""
        found = {axis: part.total(s, theta) for axis, part in self.parts.items()}
        return ca.vertcat(*(0 if (value := found.get(a)) is None else value for a in "xyz"))

    @cached_property
    def samples(self) -> Array:
        """Vectors (k, 3) at places all along the ribbon, of which uniform ones need one."""
        s = np.linspace(*self.interval, 1 if self.uniform else PLACES)
        theta = {**self.theta, **self.numbers()}
        zero = np.zeros(len(s))
        columns = (self.parts[a].sampled(s, theta) if a in self.parts else zero for a in "xyz")
        return np.stack(list(columns), axis=1)
