"""Conditions that supports and loops need beside components: lines, gaps, distances, strings."""

from __future__ import annotations

from collections.abc import Mapping

import casadi as ca
import numpy as np

from ribbonopt.classes import dataclass

from .conditions import Condition, Context, EndName, Named

Vector = tuple[float, float, float]


def _named(name: str, vector: Vector | np.ndarray) -> dict[str, float]:
    return {f"{name}.{axis}": float(vector[i]) for i, axis in enumerate("xyz")}


def _symbol(context: Context, name: str) -> ca.SX:
    return ca.vertcat(*(context.theta(f"{name}.{axis}") for axis in "xyz"))


@dataclass(frozen=True, eq=False)
class OnLine(Condition):
    """An end is on a line in space: two equations."""

    end: EndName
    point: Vector
    along: Vector

    @property
    def name(self) -> str:
        """Path of the point in the scene."""
        return f"boundary.{self.end}.position"

    def theta(self) -> dict[str, float]:
        across = np.linalg.svd(np.array([self.along]))[2][1:]
        vectors = {"point": np.array(self.point), "across0": across[0], "across1": across[1]}
        return {
            key: value
            for part, vector in vectors.items()
            for key, value in _named(f"{self.name}.{part}", vector).items()
        }

    def residuals(self, context: Context) -> Named:
        gap = context.ends[self.end].rod.r - _symbol(context, f"{self.name}.point")
        return {
            f"{self.name} (across the line, {i + 1} of 2)": ca.dot(
                gap, _symbol(context, f"{self.name}.across{i}")
            )
            for i in range(2)
        }


@dataclass(frozen=True, eq=False)
class Closed(Condition):
    """The ends have no gap along one direction, a director of the start."""

    director: str
    direction: Vector

    @property
    def name(self) -> str:
        """Name of the gap."""
        return f"boundary.loop.gap.{self.director}"

    def theta(self) -> dict[str, float]:
        return _named(self.name, self.direction)

    def residuals(self, context: Context) -> Named:
        gap = context.ends["end"].rod.r - context.ends["start"].rod.r
        return {self.name: ca.dot(gap, _symbol(context, self.name))}


@dataclass(frozen=True, eq=False)
class Distance(Condition):
    """The ends are at a distance from one another."""

    value: float

    name = "boundary.end.distance"

    def theta(self) -> dict[str, float]:
        return {self.name: self.value}

    def residuals(self, context: Context) -> Named:
        gap = context.ends["end"].rod.r - context.ends["start"].rod.r
        return {self.name: ca.norm_2(gap) - context.theta(self.name)}


@dataclass(frozen=True, eq=False)
class Taut(Condition):
    """The force acts along the chord, as a string between the ends pulls: two equations.

    Those along d1 and d2 of the start of n x chord, which has no part along the chord: enough
    unless the chord is at a right angle to d3 there.
    """

    @property
    def kinematic(self) -> bool:
        return False

    def theta(self) -> dict[str, float]:
        return {}

    def residuals(self, context: Context) -> Named:
        start, end = context.ends["start"].rod, context.ends["end"].rod
        couple = ca.cross(end.n, end.r - start.r)
        return {
            "boundary.end.force (off the chord, 1 of 2)": ca.dot(couple, start.d1),
            "boundary.end.force (off the chord, 2 of 2)": ca.dot(couple, start.d2),
        }


@dataclass(frozen=True, eq=False)
class LoadAlong(Condition):
    """The force along a direction in space at one end."""

    end: EndName
    along: Vector
    value: float

    @property
    def name(self) -> str:
        """Path of the load in the scene."""
        return f"boundary.{self.end}.force"

    @property
    def kinematic(self) -> bool:
        return False

    def theta(self) -> dict[str, float]:
        return _named(f"{self.name}.along", self.along) | {f"{self.name}.value": self.value}

    def residuals(self, context: Context) -> Named:
        along = ca.dot(context.ends[self.end].rod.n, _symbol(context, f"{self.name}.along"))
        return {f"{self.name} (along the line)": along - context.theta(f"{self.name}.value")}

    def dead(self, theta: Mapping[str, ca.SX]) -> ca.SX:
        """Dead force (3,), lab frame, that has this part along the line and none across."""
        along = ca.vertcat(*(theta[f"{self.name}.along.{axis}"] for axis in "xyz"))
        return along * theta[f"{self.name}.value"]
