"""From what a scene says of its ends to the conditions of `ribbonopt.mechanics.conditions`."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ribbonopt.scene import Boundary, End, Scene, Value

from .conditions import Component, Condition, Direction, EndName, Frame

DIRECTORS = ("d1", "d2", "d3")


def conditions_of(scene: Scene) -> tuple[Condition, ...]:
    """Return all conditions of a scene, in the order of its file, numbers evaluated."""
    boundary, parameters = scene.boundary, scene.parameters
    result: list[Condition] = []
    names: tuple[EndName, EndName] = ("start", "end")
    for name in names:
        result += _at_end(name, getattr(boundary, name), parameters)
    if boundary.also:
        from .equations import equation  # formulas cost imports that few scenes need

        result += [equation(i, text, parameters) for i, text in enumerate(boundary.also)]
    return tuple(result)


def start_position(boundary: Boundary, parameters: dict[str, float]) -> np.ndarray:
    """Prescribed position of the start (3,), zero where nothing is prescribed (lab frame)."""
    found = components(boundary.start.position, parameters)
    return np.array([found.get(axis, 0.0) for axis in "xyz"])


def start_frame(boundary: Boundary, parameters: dict[str, float]) -> np.ndarray:
    """Frame (3, 3) prescribed at the start, the lab axes if it is not wholly prescribed."""
    frame = _frame(boundary.start, parameters)
    return np.eye(3) if frame is None else frame


def gap_between_ends(scene: Scene) -> float:
    """Distance between the ends in the lab components that are prescribed at both."""
    start, end = (
        components(e.position, scene.parameters) for e in (scene.boundary.start, scene.boundary.end)
    )
    return float(np.linalg.norm([end[a] - start[a] for a in start if a in end]))


def components(vector: Any, parameters: dict[str, float]) -> dict[str, float]:
    """Return the prescribed components of a vector by axis; a triple stands for x, y, z."""
    if vector is None:
        return {}
    if is_dataclass(vector):
        pairs = [(f.name, getattr(vector, f.name)) for f in fields(vector)]
    else:
        pairs = list(zip("xyz", vector, strict=True))
    return {axis: _number(v, parameters) for axis, v in pairs if v is not None}


def _number(value: Value, parameters: dict[str, float]) -> float:
    if not isinstance(value, str):
        return float(value)
    from ribbonopt.scene.formulas import evaluate_value

    return evaluate_value(value, parameters)


def _at_end(name: EndName, end: End, parameters: dict[str, float]) -> list[Condition]:
    result: list[Condition] = [
        Component(name, "position", axis, value)
        for axis, value in components(end.position, parameters).items()
    ]
    frame = _frame(end, parameters)
    if frame is not None:
        result.append(Frame(name, tuple(frame.ravel().tolist())))
    for director in DIRECTORS:
        prescribed = components(getattr(end, director), parameters)
        if len(prescribed) < 3:
            result += [Component(name, director, a, v) for a, v in prescribed.items()]
        elif frame is None:
            x, y, z = (prescribed[axis] for axis in "xyz")
            result.append(Direction(name, director, (x, y, z)))
    for quantity in ("force", "moment"):
        prescribed = components(getattr(end, quantity), parameters)
        result += [Component(name, quantity, axis, v) for axis, v in prescribed.items()]
    return result


def _frame(end: End, parameters: dict[str, float]) -> np.ndarray | None:
    """Frame (3, 3) of an end whose directors are prescribed as a whole, or None."""
    if end.directors == "identity":
        return np.eye(3)
    source = end if end.directors is None else end.directors
    given = {d: components(getattr(source, d), parameters) for d in DIRECTORS}
    whole = {d: np.array(list(v.values())) for d, v in given.items() if len(v) == 3}
    if len(whole) < 2:
        return None
    for i, j, k in (("d1", "d2", "d3"), ("d2", "d3", "d1"), ("d3", "d1", "d2")):
        if k not in whole:
            whole[k] = np.cross(whole[i], whole[j])
    matrix = np.stack([whole[d] for d in DIRECTORS], axis=1)
    # The scene was checked to be orthonormal to 1e-6; the nearest rotation removes the rest.
    left, _, right = np.linalg.svd(matrix)
    return np.asarray(left @ right)
