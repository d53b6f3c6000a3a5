"""What is wrong with a scene as a whole and needs no mechanics to see.

Each check looks at one matter and returns all problems it finds; none depends on another.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from itertools import combinations
from typing import Any

from .model import Boundary, Directors, End, LabVector, Scene, Value
from .problems import Path, Problem

_TOLERANCE = 1e-6
_NAMES = ("d1", "d2", "d3")
_AXES = ("x", "y", "z")


def check(scene: Scene) -> list[Problem]:
    """Return the problems of a scene whose single values are valid."""
    problems = list(_interval(scene.interval))
    formulas = dict(_formulas(scene.boundary, ("boundary",)))
    values: dict[Path, float] = {}
    if formulas or scene.boundary.also or scene.parameters:
        # Imported late: a scene in plain numbers starts without the grammar of formulas.
        from .formula_checks import check_equations, check_parameters, values_of

        values, found = values_of(formulas, scene.parameters)
        problems += check_parameters(scene.parameters)
        problems += [*found, *check_equations(scene.boundary.also, scene.parameters)]
    for name in ("start", "end"):
        problems += _frame(getattr(scene.boundary, name), ("boundary", name), values)
    return problems


def _interval(interval: tuple[float, float]) -> Iterator[Problem]:
    start, end = interval
    if not start < end:
        message = "must go from a smaller to a larger arclength"
        yield Problem(("interval",), message, f"[{start:g}, {end:g}]")


def _formulas(value: Any, path: Path) -> Iterator[tuple[Path, str]]:
    """Yield the formulas in vectors; other texts (`directors: identity`, `also`) are no values."""
    members: list[tuple[str | int, Any]]
    if is_dataclass(value):
        members = [(member.name, getattr(value, member.name)) for member in fields(value)]
        vector = not isinstance(value, Boundary | End)
    elif isinstance(value, tuple):
        members = list(enumerate(value))
        vector = path[-1] != "also"
    else:
        return
    for key, member in members:
        if isinstance(member, str) and vector:
            yield (*path, key), member
        yield from _formulas(member, (*path, key))


def _frame(end: End, path: Path, values: Mapping[Path, float]) -> Iterator[Problem]:
    """Yield contradictions among the directors prescribed at one end."""
    whole = end.directors if isinstance(end.directors, Directors) else None
    if whole and sum(getattr(whole, name) is not None for name in _NAMES) < 2:
        message = "needs two or three of d1, d2, d3; give a single director beside it, as d1: [...]"
        yield Problem((*path, "directors"), message)
    singles = [name for name in _NAMES if getattr(end, name) is not None]
    if end.directors is not None and singles:
        for name in singles:
            yield Problem((*path, name), "given twice: `directors` holds the frame; keep one")
        return
    if whole:
        path = (*path, "directors")
    units: dict[str, list[float]] = {}
    for name in _NAMES:
        components = _components(getattr(whole or end, name), (*path, name), values)
        if message := _not_unit(components):
            yield Problem((*path, name), message)
        elif len(components) == 3:
            units[name] = components
    yield from _not_orthonormal(units, path)


def _components(
    vector: tuple[Value, Value, Value] | LabVector | None,
    path: Path,
    values: Mapping[Path, float],
) -> list[float]:
    """Return the components that are prescribed and have a value; a bad formula tells its own."""
    if isinstance(vector, LabVector):
        given: dict[str | int, Value | None] = {axis: getattr(vector, axis) for axis in _AXES}
    else:
        given = {index: value for index, value in enumerate(vector or ())}
    numbers = {
        key: values.get((*path, key)) if isinstance(value, str) else value
        for key, value in given.items()
    }
    return [float(number) for number in numbers.values() if number is not None]


def _not_unit(components: list[float]) -> str:
    length = math.hypot(*components)
    if len(components) == 3 and abs(length - 1) > _TOLERANCE:
        return f"has length {length:.6g}, expected 1 (a director is a unit vector)"
    if length > 1 + _TOLERANCE:
        return f"has components of length {length:.6g}, more than the 1 of a unit vector"
    return ""


def _not_orthonormal(units: Mapping[str, list[float]], path: Path) -> Iterator[Problem]:
    orthogonal = True
    for first, second in combinations(units, 2):
        product = sum(a * b for a, b in zip(units[first], units[second], strict=True))
        if abs(product) > _TOLERANCE:
            orthogonal = False
            message = f"is not orthogonal to {first}: their product is {product:.6g}, expected 0"
            yield Problem((*path, second), message)
    if orthogonal and len(units) == 3:
        d1, d2, d3 = (units[name] for name in _NAMES)
        handed = sum(d3[i] * (d1[i - 2] * d2[i - 1] - d1[i - 1] * d2[i - 2]) for i in range(3))
        if handed < 0:
            message = "makes a left-handed frame; expected d3 = d1 x d2, so turn its sign"
            yield Problem((*path, "d3"), message)
