"""From what a scene says of its ends to the conditions of `ribbonopt.mechanics.ends.conditions`."""

from __future__ import annotations

import numpy as np

from ribbonopt.scene import Boundary, End, Scene
from ribbonopt.scene.sized import OfWidth

from .conditions import Condition, EndName
from .frames import Parameters, components, frame_of, number
from .named import named_at

ENDS: tuple[EndName, EndName] = ("start", "end")


def conditions_of(scene: Scene) -> tuple[Condition, ...]:
    """Return all conditions of a scene, in the order of its file, numbers evaluated."""
    boundary, parameters = scene.boundary, scene.parameters
    result: list[Condition] = []
    if boundary.loop is not None:
        from ribbonopt.mechanics.laws.asymmetry import changed_by_sliding

        from .loops import loop_conditions  # only where a scene has one

        closed = boundary.loop.piece == "whole" and (
            scene.formulation == "energy"
            or changed_by_sliding(scene, odd=boundary.loop.half_twists % 2 == 1)
        )
        result += loop_conditions(boundary.loop, boundary.start, parameters, closed=closed)
    else:
        for name in ENDS:
            result += _at_end(name, getattr(boundary, name), parameters)
    if isinstance(scene.law, OfWidth):
        from .edges import edge_conditions  # few laws have edges

        result += edge_conditions(scene)
    if boundary.also:
        from .equations import equation  # formulas cost imports that few scenes need

        result += [equation(i, text, parameters) for i, text in enumerate(boundary.also)]
    return tuple(result)


def start_position(boundary: Boundary, parameters: Parameters) -> np.ndarray:
    """Prescribed position of the start (3,), zero where nothing is prescribed (lab frame)."""
    found = components(boundary.start.position, parameters)
    return np.array([found.get(axis, 0.0) for axis in "xyz"])


def start_frame(boundary: Boundary, parameters: Parameters) -> np.ndarray:
    """Frame (3, 3) prescribed at the start, the lab axes if it is not wholly prescribed."""
    frame = frame_of(boundary.start, parameters)
    return np.eye(3) if frame is None else frame


def gap_between_ends(scene: Scene) -> float:
    """Distance between the ends: of a string, or in the components prescribed at both."""
    distance = scene.boundary.end.distance
    if distance is not None:
        return number(distance, scene.parameters)
    ends = (scene.boundary.start, scene.boundary.end)
    start, end = (held_position(e, scene.parameters) for e in ends)
    return float(np.linalg.norm([end[a] - start[a] for a in start if a in end]))


def held_position(end: End, parameters: Parameters) -> dict[str, float]:
    """Return the lab components of the position that an end holds, by axis."""
    support, place = end.declared_support, components(end.position, parameters)
    if support is None:
        return place
    return {axis: value for axis, value in place.items() if axis in support.holds}


def _at_end(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    support = end.declared_support
    if support is None:
        return named_at(name, end, parameters)
    from .supports import conditions_at  # scenes that name every component do without

    return conditions_at(name, support, end, parameters)
