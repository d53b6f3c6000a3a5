"""The loads that a scene can name: a file for each kind, and here the union of all."""

from __future__ import annotations

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.ends.frames import components
from ribbonopt.scene import Scene

from .dead_force import DeadForce
from .load import Load


def loads_of(scene: Scene) -> tuple[Load, ...]:
    """Return the loads along the ribbon of a scene, numbers evaluated.

    Raises
    ------
    ModelError
        If one declared in Python is no load, or two share the name of a number.
    """
    loads: list[Load] = []
    force = components(scene.loads.force, scene.parameters)
    if force:
        loads.append(DeadForce(force))
    for own in scene.loads.own:
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
