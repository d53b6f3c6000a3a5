"""The stations of a scene: its point loads and its supports between the ends."""

from __future__ import annotations

from ribbonopt.mechanics.actions import DeadPoint, FollowingPoint, Held
from ribbonopt.mechanics.ends.frames import components, number
from ribbonopt.mechanics.stations import DIRECTORS, Action, Station, gathered
from ribbonopt.scene import Scene


def stations_of(scene: Scene) -> tuple[Station, ...]:
    """Return what acts and holds between the ends of a scene in units Dw = L = 1."""
    parameters, actions = scene.parameters, list[Action]()
    for i, point in enumerate(scene.loads.points):
        path, at = f"loads.points.{i}", number(point.at, parameters)
        force, moment = (components(v, parameters) for v in (point.force, point.moment))
        follows = any(axis in DIRECTORS for axis in (*force, *moment))
        kind = FollowingPoint if follows else DeadPoint
        actions.append(kind(path, at, force, moment))
    for i, support in enumerate(scene.supports):
        at = number(support.at, parameters)
        held = components(support.position, parameters)
        actions.append(Held(f"supports.{i}", at, held))
    start, end = scene.interval
    return gathered(actions, end - start)
