"""What acts or holds at single places between the ends: stations, and the unknowns they add.

At a station the force n falls by the force P that acts there, and the moment m by the couple C:
eqs. (2.6)-(2.7) with loads at a point. What P and C are, each action says: numbers of the scene, or
unknown constants of the equilibrium with conditions of their own (a reaction, a load along a
director). Lab frame, units Dw = L = 1.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from .loads.load import Theta
from .section import Section

Unknown = Callable[[str], ca.SX]  # the symbol of an unknown constant by its name

AXES, DIRECTORS = ("x", "y", "z"), ("d1", "d2", "d3")
SAME = 1e-12  # of the length: places of two actions at one station


@dataclass(frozen=True, eq=False)
class Action(ABC):
    """Something that acts at one place; `path` is its name in the scene, `at` the arclength."""

    path: str
    at: float

    #: why it has no potential, "" where it has one
    without_potential = ""

    @property
    @abstractmethod
    def unknown(self) -> tuple[str, ...]:
        """Names of its unknown constants: n or m, the axis, and whose they are."""

    @property
    @abstractmethod
    def loads(self) -> Mapping[str, float]:
        """Numbers of what acts by parameter name, but for the place."""

    def numbers(self) -> dict[str, float]:
        """All its numbers by parameter name."""
        return {f"{self.path}.at": self.at, **self.loads}

    @property
    def leaps(self) -> bool:
        """Whether the moment leaps there, and with it the strains."""
        return False

    @abstractmethod
    def force(self, theta: Theta, unknown: Unknown) -> ca.SX:
        """Force (3,) on the ribbon."""

    def couple(self, theta: Theta, unknown: Unknown) -> ca.SX:
        """Couple (3,) on the ribbon."""
        return ca.SX.zeros(3)

    @abstractmethod
    def residuals(self, rod: Section, theta: Theta, unknown: Unknown) -> dict[str, ca.SX]:
        """Expressions that vanish where its conditions hold, by name: as many as unknowns."""

    def symmetries(self, motions: Array) -> Array:
        """Return combinations (k, j) of rigid motions (6, k) that leave it as it is."""
        return np.eye(motions.shape[1])

    def work(self, r: Array) -> float:
        """Work of what acts on the position r (3,) of its place; zero where that has none."""
        return 0.0


@dataclass(frozen=True, eq=False)
class Station:
    """All that acts at one place."""

    actions: tuple[Action, ...]

    @property
    def at(self) -> float:
        """Arclength of the place."""
        return self.actions[0].at

    def place(self, theta: Theta) -> ca.SX:
        """Symbol of the arclength of the place."""
        return theta(f"{self.actions[0].path}.at")

    @property
    def unknown(self) -> tuple[str, ...]:
        """Names of all unknown constants."""
        return tuple(name for action in self.actions for name in action.unknown)

    def force(self, theta: Theta, unknown: Unknown) -> ca.SX:
        """Force (3,) on the ribbon."""
        return sum((a.force(theta, unknown) for a in self.actions), ca.SX.zeros(3))

    def couple(self, theta: Theta, unknown: Unknown) -> ca.SX:
        """Couple (3,) on the ribbon."""
        return sum((a.couple(theta, unknown) for a in self.actions), ca.SX.zeros(3))


def conservative(stations: tuple[Station, ...]) -> tuple[Station, ...]:
    """Return the stations of all actions that have a potential."""
    kept = (tuple(a for a in st.actions if not a.without_potential) for st in stations)
    return tuple(Station(actions) for actions in kept if actions)


def gathered(actions: list[Action], length: float) -> tuple[Station, ...]:
    """Return the stations of actions, in the order of their places."""
    stations: list[list[Action]] = []
    for action in sorted(actions, key=lambda action: action.at):
        if stations and action.at - stations[-1][0].at <= SAME * length:
            stations[-1].append(action)
        else:
            stations.append([action])
    return tuple(Station(tuple(some)) for some in stations)
