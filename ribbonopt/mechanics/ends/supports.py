"""Conditions of the parts that supports are composed of; no support is known here by its name."""

from __future__ import annotations

from ribbonopt.scene import End
from ribbonopt.scene.supports import (
    AxisAlong,
    ForceAlongLine,
    LoadAlongAxis,
    LoadVector,
    Part,
    Position,
    PositionAtDistance,
    PositionOnLine,
    Support,
    TautString,
    WholeFrame,
)

from .conditions import Component, Condition, Direction, EndName
from .frames import Parameters, components, number, unit
from .named import directors_at
from .placement import Distance, LoadAlong, OnLine, Taut

Vector = tuple[float, float, float]


def conditions_at(
    name: EndName, support: Support, end: End, parameters: Parameters
) -> list[Condition]:
    """Return the conditions that a support makes of an end, in the order of its parts."""
    return [c for part in support.parts for c in _of_part(part, name, end, parameters)]


def _of_part(part: Part, name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    match part:
        case Position(axes):
            place = components(end.position, parameters)
            return [Component(name, "position", axis, place[axis]) for axis in axes]
        case PositionOnLine():
            place = components(end.position, parameters)
            point = (place["x"], place["y"], place["z"])
            return [OnLine(name, point, _along(end, parameters))]
        case PositionAtDistance():
            assert end.distance is not None
            return [Distance(number(end.distance, parameters))]
        case WholeFrame():
            return directors_at(name, end, parameters)
        case AxisAlong():
            return [Direction(name, _axis(end), _along(end, parameters))]
        case TautString():
            return [Taut()]
        case LoadVector(load, axes):
            given = components(getattr(end, load), parameters) or dict.fromkeys(axes, 0.0)
            return [Component(name, load, axis, value) for axis, value in given.items()]
        case ForceAlongLine():
            line, force = _along(end, parameters), components(end.force, parameters)
            value = sum(force.get(axis, 0.0) * line[i] for i, axis in enumerate("xyz"))
            return [LoadAlong(name, line, value)]
        case LoadAlongAxis(load):
            given = components(getattr(end, load), parameters)
            return [Component(name, load, _axis(end), given.get(_axis(end), 0.0))]


def _axis(end: End) -> str:
    assert end.axis is not None
    return end.axis


def _along(end: End, parameters: Parameters) -> Vector:
    x, y, z = unit(end.along, parameters)
    return (float(x), float(y), float(z))
