"""The loads that a scene can name: a file for each kind, and here the union of all."""

from __future__ import annotations

from ribbonopt.mechanics.ends.frames import components
from ribbonopt.scene import Scene

from .dead_force import DeadForce
from .load import Load


def loads_of(scene: Scene) -> tuple[Load, ...]:
    """Return the loads along the ribbon of a scene, numbers evaluated."""
    loads: list[Load] = []
    force = components(scene.loads.force, scene.parameters)
    if force:
        loads.append(DeadForce(force))
    return tuple(loads)
