"""What is wrong with the supports of a scene: keys that they lack, contradict or do not know.

What a support needs and takes follows from the parts it is composed of (`scene.supports`). The
frame stands there as `directors`, which may as well be given as two or three whole directors.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Literal

from ribbonopt.scene.ends import Boundary, End
from ribbonopt.scene.faults import KeyPath, Problem
from ribbonopt.scene.frames import LabVector, Triple
from ribbonopt.scene.supports import EXAMPLES, SUPPORTS, Support
from ribbonopt.scene.wording import given, listed, written

from .frames import known, number_at

EndName = Literal["start", "end"]

_ONLY_OF_SUPPORTS = ("axis", "along", "distance")
_DIRECTORS = ("d1", "d2", "d3")
_AXES = ("x", "y", "z")
_NO_DIRECTION = 1e-12


def check_supports(boundary: Boundary, values: Mapping[KeyPath, float]) -> Iterator[Problem]:
    """Yield what is wrong with the supports of both ends, and with the keys only they use."""
    ends: tuple[tuple[EndName, End], ...] = (("start", boundary.start), ("end", boundary.end))
    for name, end in ends:
        path: KeyPath = ("boundary", name)
        support = end.declared_support
        if support is None:
            yield from _without_support(name, end, path)
        elif support.of_chord and name == "start":
            message = "which only the end can be, by a string from the start; write for example "
            yield Problem((*path, "support"), message + _at_end(support), repr(support.name))
        else:
            from .support_loads import check_loads

            yield from _missing(support, end, path)
            yield from _contradicting(name, support, end, path)
            yield from check_loads(support, end, path, values)
        yield from _sizes(end, path, values)
    support = boundary.end.declared_support
    if support is not None and support.of_chord:
        yield from _start_of_chord(support.name, boundary.start, ("boundary", "start"))


def _supports_with(key: str, name: EndName) -> tuple[str, str]:
    """Return the supports that know a key, and an example of one at this end, quoted."""
    key = "directors" if key in _DIRECTORS else key
    supports = [support for support in SUPPORTS.values() if key in support.keys]
    if name == "start" and all(support.of_chord for support in supports):
        return f"{listed(s.name for s in supports)}, of the end", _at_end(supports[0])
    return listed((s.name for s in supports), "or"), f'"support: {supports[0].name}"'


def _at_end(support: Support) -> str:
    """Return an example of a support that only the end can have, quoted."""
    keys = ", ".join(EXAMPLES[key] for key in support.needs)
    return f'"end: {{support: {support.name}, {keys}}}"'


def _without_support(name: EndName, end: End, path: KeyPath) -> Iterator[Problem]:
    for key in _ONLY_OF_SUPPORTS:
        if getattr(end, key) is None:
            continue
        supports, example = _supports_with(key, name)
        message = f"is used only with support: {supports}; remove it, or write for example "
        yield Problem((*path, key), message + example)


def _missing(support: Support, end: End, path: KeyPath) -> Iterator[Problem]:
    lacks = [key for key in support.needs if getattr(end, key) is None]
    if "directors" in lacks and (singles := [d for d in _DIRECTORS if getattr(end, d) is not None]):
        lacks.remove("directors")
        yield from _singles(support, end, singles, path)
    if lacks:
        example = ", ".join(_example(support, key) for key in lacks)
        message = f'support: {support.name} needs {listed(lacks)}; add for example "{example}"'
        yield Problem(path, message)
    if support.whole_position:
        yield from check_whole_position(f"support: {support.name} needs", end.position, path)
    elif support.holds and end.position is not None and {*given(end.position)} != {*support.holds}:
        message = f"support: {support.name} holds the components {listed(support.holds)} only; "
        message += f'write for example "{_example(support, "position")}"'
        yield Problem((*path, "position"), message, written(end.position))


def _example(support: Support, key: str) -> str:
    if key != "position" or support.whole_position:
        return EXAMPLES[key]
    return f"position: {{{', '.join(f'{axis}: 0' for axis in support.holds)}}}"


def _singles(support: Support, end: End, singles: list[str], path: KeyPath) -> Iterator[Problem]:
    partial = [name for name in singles if len(given(getattr(end, name))) < 3]
    if len(singles) - len(partial) < 2:
        message = f"support: {support.name} needs the whole frame, or two whole directors; write "
        example = f'for example "directors: identity" in place of {listed(singles)}'
        yield Problem(path, message + example)
        return
    for name in partial:
        message = "follows from the other two, which are whole; remove it"
        yield Problem((*path, name), message, written(getattr(end, name)))


def check_whole_position(
    needs: str, position: Triple | LabVector | None, path: KeyPath
) -> Iterator[Problem]:
    """Yield what a position lacks of its three components, as something `needs` them."""
    found = given(position)
    if position is not None and len(found) < 3:
        example = written([found.get(axis, 0) for axis in _AXES])
        message = f'{needs} all three components; write for example "position: {example}"'
        yield Problem((*path, "position"), message, written(position))


def _contradicting(name: EndName, support: Support, end: End, path: KeyPath) -> Iterator[Problem]:
    for key in given(end):
        known_as = "directors" if key in _DIRECTORS else key
        if key in ("support", "edge") or known_as in support.keys:
            continue  # what beside a support may be said of the edge, `edges` knows
        message = f"contradicts support: {support.name}, which takes only {listed(support.keys)}"
        if key in ("force", "moment"):
            message += " (this load is a reaction there, or zero)"
        _, example = _supports_with(key, name)
        yield Problem((*path, key), f"{message}; remove it, or write for example {example}")


def _sizes(end: End, path: KeyPath, values: Mapping[KeyPath, float]) -> Iterator[Problem]:
    """Yield directions and distances of no size."""
    direction = known(end.along, (*path, "along"), values)
    if len(direction) == 3 and math.hypot(*direction) < _NO_DIRECTION:
        message = 'expected a direction, of any length but 0; write for example "{}"'
        yield Problem((*path, "along"), message.format(EXAMPLES["along"]), written(end.along))
    distance = number_at(end.distance, (*path, "distance"), values)
    if distance is not None and distance <= 0:
        message = f'expected a number > 0; write for example "{EXAMPLES["distance"]}"'
        yield Problem((*path, "distance"), message, f"{distance:g}")


def _start_of_chord(support: str, start: End, path: KeyPath) -> Iterator[Problem]:
    """Yield what keeps the start from being the fixed point where a string to the end begins."""
    own = start.declared_support
    what = f"support: {support} at the end is a string from a fixed point, the start"
    if own is not None:
        if own.holds != "xyz" and not own.of_chord:
            message = f'{what}, which {own.name} is not; write for example "support: pinned"'
            yield Problem((*path, "support"), message, repr(own.name))
    elif start.position is None:
        yield Problem(path, f'{what}; add for example "{EXAMPLES["position"]}"')
    else:
        yield from check_whole_position(f"{what}, and needs", start.position, path)
