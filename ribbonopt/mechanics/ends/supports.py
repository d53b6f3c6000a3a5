"""Supports by name: what each holds of an end, and the loads that vanish (or are given) with it.

A support is energetically complete: the loads it prescribes do work on exactly the motions that it
leaves free, so that they are the natural conditions of the strain energy.
"""

from __future__ import annotations

from collections.abc import Callable

from ribbonopt.scene import End, Support

from .boundary import directors_at
from .conditions import Component, Condition, Direction, EndName
from .frames import Parameters, components, number, unit
from .placement import Distance, LoadAlong, OnLine, Taut

Builder = Callable[[EndName, End, Parameters], list[Condition]]


def _clamped(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    return [*_point(name, end, parameters), *directors_at(name, end, parameters)]


def _pinned(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    return [*_point(name, end, parameters), *_load(name, "moment", end, parameters)]


def _hinged(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    assert end.axis is not None
    moment = components(end.moment, parameters).get(end.axis, 0.0)
    return [
        *_point(name, end, parameters),
        Direction(name, end.axis, _along(end, parameters)),
        Component(name, "moment", end.axis, moment),
    ]


def _sliding(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    line, load = _along(end, parameters), components(end.force, parameters)
    value = sum(load.get(axis, 0.0) * line[i] for i, axis in enumerate("xyz"))
    return [
        OnLine(name, _place(end, parameters), line),
        *directors_at(name, end, parameters),
        LoadAlong(name, line, value),
    ]


def _free(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    loads = ("force", "moment")
    return [c for quantity in loads for c in _load(name, quantity, end, parameters)]


def _held(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    assert end.distance is not None
    return [
        Distance(number(end.distance, parameters)),
        Taut(),
        *_load(name, "moment", end, parameters),
    ]


def _flip(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    assert end.axis is not None
    line = _along(end, parameters)
    return [
        OnLine(name, _place(end, parameters), line),
        Direction(name, end.axis, line),
        Component(name, "force", end.axis, 0.0),
        Component(name, "moment", end.axis, 0.0),
    ]


#: supports by the name a scene gives them
SUPPORTS: dict[Support, Builder] = {
    "clamped": _clamped,
    "pinned": _pinned,
    "hinged": _hinged,
    "sliding": _sliding,
    "free": _free,
    "held": _held,
    "flip": _flip,
}


def _point(name: EndName, end: End, parameters: Parameters) -> list[Condition]:
    place = components(end.position, parameters)
    return [Component(name, "position", axis, value) for axis, value in place.items()]


def _load(name: EndName, quantity: str, end: End, parameters: Parameters) -> list[Condition]:
    given = components(getattr(end, quantity), parameters) or dict.fromkeys("xyz", 0.0)
    return [Component(name, quantity, axis, value) for axis, value in given.items()]


def _place(end: End, parameters: Parameters) -> tuple[float, float, float]:
    place = components(end.position, parameters)
    return (place["x"], place["y"], place["z"])


def _along(end: End, parameters: Parameters) -> tuple[float, float, float]:
    x, y, z = unit(end.along, parameters)
    return (float(x), float(y), float(z))
