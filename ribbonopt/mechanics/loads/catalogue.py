"""The loads that a scene can name: a file for each kind, and here the union of all."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.along import Field
from ribbonopt.mechanics.ends.frames import by_axis
from ribbonopt.scene import Scene

from .components import Components, Part, Share
from .dead_couple import DeadCouple
from .dead_force import DeadForce
from .load import Load
from .pressure import Pressure
from .weight import OfWidth


def loads_of(scene: Scene) -> tuple[Load, ...]:
    """Return the loads along the ribbon of a scene.

    Raises
    ------
    ModelError
        If one declared in Python is no load, or two share the name of a number.
    """
    theta = {f"parameters.{name}": value for name, value in scene.parameters.items()}
    theta |= {"interval.start": scene.interval[0], "interval.end": scene.interval[1]}
    given, loads = scene.loads, list[Load]()
    width = Field("width", scene.width) if scene.width is not None else None
    theta |= {} if width is None else width.numbers()

    def vector(name: str, value: Any, width: Field | None = None) -> Components | None:
        shares = {axis: Share(Field(f"{name}.{axis}", number)) for axis, number in by_axis(value)}
        parts: dict[str, Part] = {
            axis: share if width is None else OfWidth(share, width)
            for axis, share in shares.items()
        }
        return Components(parts, theta, scene.interval) if parts else None

    if force := vector("loads.force", given.force):
        loads.append(DeadForce(force))
    if weight := vector("gravity", scene.gravity, width):
        loads.append(DeadForce(weight, "gravity"))
    if couple := vector("loads.couple", given.couple):
        loads.append(DeadCouple(couple))
    if given.pressure is not None:
        loads.append(_pressure(Share(Field("loads.pressure", given.pressure)), theta, scene))
    for own in given.own:
        if not isinstance(own, Load):
            raise ModelError(
                f"loads.own: found {type(own).__name__}, expected a subclass of "
                "ribbonopt.mechanics.loads.load.Load, or of its DeadLoad",
                "loads.own",
            )
        loads.append(own)
    names = [name for load in loads for name in load.numbers()]
    if twice := {name for name in names if names.count(name) > 1}:
        raise ModelError(f"loads: two have a number {min(twice)!r}; name them apart", "loads")
    return tuple(loads)


def _pressure(p: Share, theta: Mapping[str, float], scene: Scene) -> Pressure:
    samples = Components({"x": p}, theta, scene.interval).samples
    return Pressure(p, float(np.abs(samples).max()))
