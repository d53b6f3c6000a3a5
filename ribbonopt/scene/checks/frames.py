"""What is wrong with the frame at one end: directors and rotations that are none."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from itertools import combinations

from ribbonopt.scene.ends import End
from ribbonopt.scene.faults import KeyPath, Problem
from ribbonopt.scene.frames import Directors, LabVector, Quaternion, Turn, Turns, Value
from ribbonopt.scene.wording import given, written

TOLERANCE = 1e-6
"""How far lengths may be from 1, and products from 0."""

_NAMES = ("d1", "d2", "d3")
_AXES = ("x", "y", "z")
_TURN = "{x: 90*deg}"


def check_frame(end: End, path: KeyPath, values: Mapping[KeyPath, float]) -> Iterator[Problem]:
    """Yield contradictions among the directors prescribed at one end."""
    yield from _rotation(end, (*path, "directors"), values)
    whole = end.directors if isinstance(end.directors, Directors) else None
    singles = [name for name in _NAMES if getattr(end, name) is not None]
    if end.directors is not None and singles:
        for name in singles:
            yield Problem((*path, name), "given twice: `directors` holds the frame; keep one")
        return
    if whole:
        path = (*path, "directors")
    units: dict[str, list[float]] = {}
    for name in _NAMES:
        components = known(getattr(whole or end, name), (*path, name), values)
        if message := _not_unit(components):
            yield Problem((*path, name), message)
        elif len(components) == 3:
            units[name] = components
    yield from _not_orthonormal(units, path)


def known(
    vector: tuple[Value, ...] | LabVector | None, path: KeyPath, values: Mapping[KeyPath, float]
) -> list[float]:
    """Return the components that are prescribed and have a value; a bad formula tells its own."""
    if isinstance(vector, LabVector):
        given: dict[str | int, Value | None] = {axis: getattr(vector, axis) for axis in _AXES}
    else:
        given = {index: value for index, value in enumerate(vector or ())}
    numbers = (number_at(value, (*path, key), values) for key, value in given.items())
    return [number for number in numbers if number is not None]


def number_at(value: Value | None, path: KeyPath, values: Mapping[KeyPath, float]) -> float | None:
    """Return a number or the value of a formula; None for what is not given or has no value."""
    if value is None:
        return None
    return values.get(path) if isinstance(value, str) else float(value)


def _rotation(end: End, path: KeyPath, values: Mapping[KeyPath, float]) -> Iterator[Problem]:
    match end.directors:
        case Directors() as frame if sum(getattr(frame, name) is not None for name in _NAMES) < 2:
            message = "needs two or three of d1, d2, d3; "
            yield Problem(path, message + "give a single director beside it, as d1: [...]")
        case Quaternion(quaternion):
            path = (*path, "quaternion")
            yield from _quaternion(known(quaternion, path, values), path)
        case Turns(turns=()):
            message = 'expected at least one turn; write for example "turns: [{}]"'
            yield Problem((*path, "turns"), message.format(_TURN), "[]")
        case Turns(turns):
            for index, turn in enumerate(turns):
                yield from _turn(turn, (*path, "turns", index))


def _quaternion(numbers: list[float], path: KeyPath) -> Iterator[Problem]:
    length = math.hypot(*numbers)
    if len(numbers) == 4 and abs(length - 1) > TOLERANCE:
        unit = [number / length for number in numbers] if length else [1, 0, 0, 0]
        example = f'write for example "quaternion: [{", ".join(f"{n:.9g}" for n in unit)}]"'
        yield Problem(path, f"has length {length:.6g}, expected 1 (it is no rotation); {example}")


def _turn(turn: Turn, path: KeyPath) -> Iterator[Problem]:
    found = given(turn)
    if len(found) != 1:
        example = ", ".join(written(Turn(**{axis: angle})) for axis, angle in found.items())
        message = "expected one axis (x, y, z, d1, d2 or d3) with its angle; write for example "
        yield Problem(path, f'{message}"{example or _TURN}"', written(turn))


def _not_unit(components: list[float]) -> str:
    length = math.hypot(*components)
    if len(components) == 3 and abs(length - 1) > TOLERANCE:
        return f"has length {length:.6g}, expected 1 (a director is a unit vector)"
    if length > 1 + TOLERANCE:
        return f"has components of length {length:.6g}, more than the 1 of a unit vector"
    return ""


def _not_orthonormal(units: Mapping[str, list[float]], path: KeyPath) -> Iterator[Problem]:
    orthogonal = True
    for first, second in combinations(units, 2):
        product = sum(a * b for a, b in zip(units[first], units[second], strict=True))
        if abs(product) > TOLERANCE:
            orthogonal = False
            message = f"is not orthogonal to {first}: their product is {product:.6g}, expected 0"
            yield Problem((*path, second), message)
    if orthogonal and len(units) == 3:
        d1, d2, d3 = (units[name] for name in _NAMES)
        handed = sum(d3[i] * (d1[i - 2] * d2[i - 1] - d1[i - 1] * d2[i - 2]) for i in range(3))
        if handed < 0:
            message = "makes a left-handed frame; expected d3 = d1 x d2, so turn its sign"
            yield Problem((*path, "d3"), message)
