"""What is wrong with the loads beside a support: components that it does not leave to be given."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ribbonopt.scene.ends import End
from ribbonopt.scene.faults import KeyPath, Problem
from ribbonopt.scene.frames import AnyVector, Triple
from ribbonopt.scene.supports import ForceAlongLine, LoadAlongAxis, LoadVector, Part, Support
from ribbonopt.scene.wording import given, listed, written

from .frames import TOLERANCE, known

_DIRECTORS = ("d1", "d2", "d3")
_AXES = ("x", "y", "z")


def check_loads(
    support: Support, end: End, path: KeyPath, values: Mapping[KeyPath, float]
) -> Iterator[Problem]:
    """Yield the loads that are given otherwise than the parts of a support take them."""
    for key in ("force", "moment"):
        load: Triple | AnyVector | None = getattr(end, key)
        if load is None:
            continue
        for part in support.parts:
            if key not in part.takes:
                continue
            line = known(end.along, (*path, "along"), values)
            if message := _misfit(part, key, load, end.axis or "d2", line):
                found = written(load)
                yield Problem((*path, key), f"support: {support.name} {message}", found)


def _misfit(part: Part, key: str, load: Triple | AnyVector, axis: str, line: list[float]) -> str:
    match part:
        case LoadAlongAxis():
            return _off_axis(key, load, axis)
        case ForceAlongLine():
            return _off_line(load, line)
        case LoadVector(_, axes):
            return _not_whole(key, load, axes)
    return ""


def _off_axis(key: str, load: Triple | AnyVector, axis: str) -> str:
    if isinstance(load, AnyVector) and set(given(load)) == {axis}:
        return ""
    which = f"moment about the hinge, {axis}" if key == "moment" else f"force along {axis}"
    return f'takes the {which}, and no other; write for example "{key}: {{{axis}: 0}}"'


def _off_line(force: Triple | AnyVector, line: list[float]) -> str:
    """Say what is wrong with a dead load on a slider, of which the part along the line acts."""
    sizes = dict(zip(_AXES, map(abs, line), strict=True)) if len(line) == 3 else {}
    longest = max(sizes, key=lambda axis: sizes[axis], default="z")
    example = f'write for example "force: {{{longest}: 0}}"'
    found = given(force)
    if set(found) & set(_DIRECTORS):
        return f"takes a load in lab components, of which the part along the line acts; {example}"
    if all(axis in sizes and sizes[axis] < TOLERANCE * sizes[longest] for axis in found):
        return f"takes the load along the line; {listed(found)} is across it; {example}"
    return ""


def _not_whole(key: str, load: Triple | AnyVector, axes: str) -> str:
    frames = [set(axes)] if axes != "xyz" else [set(_AXES), set(_DIRECTORS)]
    if set(given(load)) in frames:
        return ""
    if axes != "xyz":
        example = f'"{key}: {{{", ".join(f"{axis}: 0" for axis in axes)}}}"'
        return f"takes the components {listed(axes)}, and no other; write for example {example}"
    return (
        "needs all its components, of one frame; write for example "
        f'"{key}: [0, 0, 0]" or "{key}: {{d1: 0, d2: 0, d3: 0}}"'
    )
