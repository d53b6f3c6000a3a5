"""Supports between the ends in the problem of least energy, which is one phase.

What a support holds at s_k is the end of a state of its own, rho' = r' . e up to s_k and 0 behind,
rho = r . e at the start. The costate of rho is the reaction P, by which n falls at s_k. The moment
of P behind it, -P x (r - r(s_k)), is known when P is: r - r(s_k) are three more states, which
nothing depends on.
"""

from __future__ import annotations

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.actions import Held
from ribbonopt.mechanics.section import Section
from ribbonopt.mechanics.stations import AXES

from .ribbon import Ribbon


@dataclass(frozen=True, eq=False)
class HeldBetween:
    """Components of positions that are held between the ends of a ribbon, lab frame.

    `held` are the names of the components, `axes` their lab axes, `places` and `values` the symbols
    of where and at what they are held.
    """

    ribbon: Ribbon
    held: tuple[str, ...]
    axes: tuple[int, ...]
    places: tuple[ca.SX, ...]
    values: tuple[ca.SX, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the states."""
        arms = (f"{name}: {axis} behind" for name in self.held for axis in AXES)
        return (*self.held, *arms)

    @property
    def estimate(self) -> ca.SX:
        """Where to start the states."""
        return ca.vertcat(ca.SX(0, 1), *self.values, ca.SX.zeros(3 * len(self.held)))

    def rates(self, rod: Section) -> ca.SX:
        """Return the derivatives of the states along s."""
        parts = [
            (rod.s < place) * rod.tangent[axis]
            for axis, place in zip(self.axes, self.places, strict=True)
        ]
        arms = [(rod.s >= place) * rod.tangent for place in self.places]
        return ca.vertcat(ca.SX(0, 1), *parts, *arms)

    def conditions(self, start: ca.SX, end: ca.SX) -> dict[str, ca.SX]:
        """Return the conditions on the states of both ends, by name."""
        found, first = {}, len(self.ribbon.states)
        for i, (name, axis) in enumerate(zip(self.held, self.axes, strict=True)):
            found[f"start: {name}"] = start[first + i] - start[axis]
            found[name] = end[first + i] - self.values[i]
        for i in range(first + len(self.held), first + len(self.names)):
            found[f"start: {self.names[i - first]}"] = start[i]
        return found

    def force(self, costate: ca.SX) -> ca.SX:
        """Force (3,) of all reactions, lab frame."""
        total, found = ca.SX.zeros(3), self.reactions(costate)
        for axis, value in zip(self.axes, found, strict=True):
            total[axis] += value
        return total

    def reactions(self, costate: ca.SX) -> list[ca.SX]:
        """Return the reactions, from the costates of all states at the start."""
        first = len(self.ribbon.states)
        return [costate[first + i] for i in range(len(self.held))]

    def packed(self, fraction: Array, r: Array, places: Array, held: Array) -> Array:
        """Return the states (k, ...) of positions r (k, 3) at fractions (k,) of the length.

        `held` (h, 3) are the positions at the fractions `places` (h,), one for each component.
        """
        behind = fraction[:, None] >= places
        own = np.where(behind, held[range(len(self.axes)), self.axes], r[:, self.axes])
        arms = np.where(behind[..., None], r[:, None] - held, 0.0)
        return np.hstack([own, arms.reshape(len(r), -1)])

    def completed(self, x: ca.SX, reactions: ca.SX) -> ca.SX | None:
        """Return the states with the moments of all reactions; None if there are none."""
        if not self.held:
            return None
        states, first = self.ribbon.states, len(self.ribbon.states)
        at, result = states.index("bx"), ca.SX(x)
        for i, axis in enumerate(self.axes):
            force = reactions[i] * ca.SX(ca.DM(np.eye(3)[axis]))
            arm = x[first + len(self.held) + 3 * i :][:3]
            result[at : at + 3] -= ca.cross(force, arm)
        return result


def held_between(ribbon: Ribbon) -> HeldBetween:
    """Return what supports hold between the ends of a ribbon."""
    names, axes, places, values = [], [], [], []
    theta = ribbon.theta.__getitem__
    for station in ribbon.stations:
        for action in station.actions:
            for axis in action.place if isinstance(action, Held) else ():
                name = f"{action.path}.position.{axis}"
                names.append(name)
                axes.append(AXES.index(axis))
                places.append(station.place(theta))
                values.append(theta(name))
    return HeldBetween(ribbon, tuple(names), tuple(axes), tuple(places), tuple(values))
