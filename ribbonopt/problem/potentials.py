"""Which loads have a potential, so that equilibria are stationary points of an energy; why not."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from ribbonopt.mechanics.ends.conditions import Component, Condition

from .ribbon import Ribbon

if TYPE_CHECKING:
    from ribbonopt.mechanics.stations import Station


class Refusal(NamedTuple):
    """Why a ribbon is no minimum of an energy, what to do, and the key of the scene to blame."""

    reason: str
    remedy: str
    key: str


def without_potential(ribbon: Ribbon) -> Refusal | None:
    """Return why what acts on a ribbon has no potential; None where it has one."""
    return (
        _load_without_potential(ribbon)
        or point_without_potential(ribbon.stations)
        or end_without_potential(ribbon.conditions)
    )


def _load_without_potential(ribbon: Ribbon) -> Refusal | None:
    for load in ribbon.loads:
        if load.without_potential:
            reason = f"{load.name} {load.without_potential}"
            return Refusal(reason, "use another formulation", load.name)
    return None


def point_without_potential(stations: Sequence[Station]) -> Refusal | None:
    """Return why what acts at single places has no potential; None where it has one."""
    for station in stations:
        for action in station.actions:
            if action.without_potential:
                return Refusal(
                    f"{action.path}: {action.without_potential}",
                    "use another formulation",
                    action.path,
                )
    return None


def end_without_potential(conditions: Sequence[Condition]) -> Refusal | None:
    """Return why what is prescribed at the ends has no potential; None where it has one."""
    for condition in conditions:
        if not isinstance(condition, Component) or condition.kinematic or not condition.value:
            continue
        if not is_dead_force(conditions, condition):
            return Refusal(
                f"{condition.name}, other than zero, has no potential here (only a dead force, in "
                "lab components, on an end free to follow it has)",
                "use another formulation",
                condition.name,
            )
    return None


def is_dead_force(conditions: Sequence[Condition], condition: Component) -> bool:
    """Whether a condition is a dead force on an end that is free to follow it."""
    held = [
        c
        for c in conditions
        if isinstance(c, Component) and (c.quantity, c.axis) == ("position", condition.axis)
    ]
    return condition.quantity == "force" and condition.axis in "xyz" and len(held) < 2
