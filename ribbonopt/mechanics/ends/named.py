"""Conditions that a scene names one by one: components of the position, directors and loads."""

from __future__ import annotations

from ribbonopt.scene import End

from .conditions import Component, Condition, Direction, EndName, Frame
from .frames import DIRECTORS, Parameters, components, quaternion_of


def named_at(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    """Return the conditions of an end without a support."""
    return [
        *_components(name, "position", end, parameters),
        *directors_at(name, end, parameters),
        *_components(name, "force", end, parameters),
        *_components(name, "moment", end, parameters),
    ]


def directors_at(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    """Return the conditions on the directors of an end."""
    whole = quaternion_of(end, parameters)
    result: list[Condition] = []
    if whole is not None:
        result.append(Frame(name, whole))
    for director in DIRECTORS:
        prescribed = components(getattr(end, director), parameters)
        if len(prescribed) < 3:
            result += [Component(name, director, a, v) for a, v in prescribed.items()]
        elif whole is None:
            x, y, z = (prescribed[axis] for axis in "xyz")
            result.append(Direction(name, director, (x, y, z)))
    return result


def _components(name: EndName, quantity: str, end: End, parameters: Parameters) -> list[Condition]:
    prescribed = components(getattr(end, quantity), parameters)
    return [Component(name, quantity, axis, value) for axis, value in prescribed.items()]
