"""From what a scene says of its ends to the conditions of `ribbonopt.mechanics.ends.conditions`."""

from __future__ import annotations

import numpy as np

from ribbonopt.scene import Boundary, End, Scene

from .conditions import Component, Condition, Direction, EndName, Frame
from .frames import DIRECTORS, Parameters, components, frame_of, number

ENDS: tuple[EndName, EndName] = ("start", "end")


def conditions_of(scene: Scene) -> tuple[Condition, ...]:
    """Return all conditions of a scene, in the order of its file, numbers evaluated."""
    boundary, parameters = scene.boundary, scene.parameters
    result: list[Condition] = []
    if boundary.loop is not None:
        from .loops import loop_conditions  # only where a scene has one

        energy = scene.formulation == "energy"
        result += loop_conditions(boundary.loop, boundary.start, parameters, closed=energy)
    else:
        for name in ENDS:
            result += _at_end(name, getattr(boundary, name), parameters)
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
    start, end = (
        components(e.position, scene.parameters) if e.support not in ("sliding", "flip") else {}
        for e in (scene.boundary.start, scene.boundary.end)
    )
    return float(np.linalg.norm([end[a] - start[a] for a in start if a in end]))


def _at_end(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    if end.support is not None:
        from .supports import SUPPORTS  # scenes that name every component do without

        return SUPPORTS[end.support](name, end, parameters)
    result: list[Condition] = [
        Component(name, "position", axis, value)
        for axis, value in components(end.position, parameters).items()
    ]
    result += directors_at(name, end, parameters)
    for quantity in ("force", "moment"):
        prescribed = components(getattr(end, quantity), parameters)
        result += [Component(name, quantity, axis, v) for axis, v in prescribed.items()]
    return result


def directors_at(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    """Return the conditions on the directors of an end."""
    frame = frame_of(end, parameters)
    result: list[Condition] = []
    if frame is not None:
        result.append(Frame(name, tuple(frame.ravel().tolist())))
    for director in DIRECTORS:
        prescribed = components(getattr(end, director), parameters)
        if len(prescribed) < 3:
            result += [Component(name, director, a, v) for a, v in prescribed.items()]
        elif frame is None:
            x, y, z = (prescribed[axis] for axis in "xyz")
            result.append(Direction(name, director, (x, y, z)))
    return result
