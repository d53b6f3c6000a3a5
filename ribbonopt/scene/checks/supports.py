"""What is wrong with the supports of a scene: keys that they lack, contradict or do not know.

Which keys a support needs and takes is data, `RULES`. The frame stands there as `directors`, which
may as well be given as two or three whole directors.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Literal, NamedTuple

from ribbonopt.scene.ends import AnyVector, Boundary, End, LabVector, Support, Triple
from ribbonopt.scene.faults import KeyPath, Problem
from ribbonopt.scene.wording import given, listed, written

from .frames import TOLERANCE, known, number_at

EndName = Literal["start", "end"]


class Rule(NamedTuple):
    """Keys that a support needs, and those that it takes beside them."""

    needs: tuple[str, ...]
    takes: tuple[str, ...] = ()

    @property
    def keys(self) -> tuple[str, ...]:
        """All keys it knows."""
        return self.needs + self.takes


RULES: dict[Support, Rule] = {
    "clamped": Rule(("position", "directors")),
    "pinned": Rule(("position",), ("moment",)),
    "hinged": Rule(("position", "axis", "along"), ("moment",)),
    "sliding": Rule(("position", "directors", "along"), ("force",)),
    "free": Rule((), ("force", "moment")),
    "held": Rule(("distance",), ("moment",)),
    "flip": Rule(("position", "axis", "along")),
}
EXAMPLES = {
    "position": "position: [0, 0, 0]",
    "directors": "directors: identity",
    "axis": "axis: d2",
    "along": "along: [0, 1, 0]",
    "distance": "distance: 0.5",
}
_ONLY_OF_SUPPORTS = ("axis", "along", "distance")
_DIRECTORS = ("d1", "d2", "d3")
_AXES = ("x", "y", "z")
_HELD = '"end: {support: held, distance: 0.5}"'
_NO_DIRECTION = 1e-12


def check_supports(boundary: Boundary, values: Mapping[KeyPath, float]) -> Iterator[Problem]:
    """Yield what is wrong with the supports of both ends, and with the keys only they use."""
    ends: tuple[tuple[EndName, End], ...] = (("start", boundary.start), ("end", boundary.end))
    for name, end in ends:
        path: KeyPath = ("boundary", name)
        if end.support is None:
            yield from _without_support(name, end, path)
        elif end.support == "held" and name == "start":
            message = "which only the end can be, by a string from the start; write for example "
            yield Problem((*path, "support"), message + _HELD, "'held'")
        else:
            yield from _missing(end.support, end, path)
            yield from _contradicting(name, end.support, end, path)
            yield from _loads(end.support, end, path, values)
        yield from _sizes(end, path, values)
    if boundary.end.support == "held":
        yield from _start_of_string(boundary.start, ("boundary", "start"))


def _supports_with(key: str, name: EndName) -> tuple[str, str]:
    """Return the supports that know a key, and an example of one at this end, quoted."""
    key = "directors" if key in _DIRECTORS else key
    supports = [support for support, rule in RULES.items() if key in rule.keys]
    if name == "start" and supports == ["held"]:
        return "held, of the end", _HELD
    return listed(supports, "or"), f'"support: {supports[0]}"'


def _without_support(name: EndName, end: End, path: KeyPath) -> Iterator[Problem]:
    for key in _ONLY_OF_SUPPORTS:
        if getattr(end, key) is None:
            continue
        supports, example = _supports_with(key, name)
        message = f"is used only with support: {supports}; remove it, or write for example "
        yield Problem((*path, key), message + example)


def _missing(support: Support, end: End, path: KeyPath) -> Iterator[Problem]:
    lacks = [key for key in RULES[support].needs if getattr(end, key) is None]
    if "directors" in lacks and (singles := [d for d in _DIRECTORS if getattr(end, d) is not None]):
        lacks.remove("directors")
        yield from _singles(support, end, singles, path)
    if lacks:
        example = ", ".join(EXAMPLES[key] for key in lacks)
        message = f'support: {support} needs {listed(lacks)}; add for example "{example}"'
        yield Problem(path, message)
    if "position" in RULES[support].needs:
        yield from check_whole_position(f"support: {support} needs", end.position, path)


def _singles(support: Support, end: End, singles: list[str], path: KeyPath) -> Iterator[Problem]:
    partial = [name for name in singles if len(given(getattr(end, name))) < 3]
    if len(singles) - len(partial) < 2:
        message = f"support: {support} needs the whole frame, or two whole directors; write for "
        example = f'example "directors: identity" in place of {listed(singles)}'
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
    rule = RULES[support]
    for key in given(end):
        known_as = "directors" if key in _DIRECTORS else key
        if key == "support" or known_as in rule.keys:
            continue
        message = f"contradicts support: {support}, which takes only {listed(rule.keys)}"
        if key in ("force", "moment"):
            message += " (this load is a reaction there, or zero)"
        _, example = _supports_with(key, name)
        yield Problem((*path, key), f"{message}; remove it, or write for example {example}")


def _loads(
    support: Support, end: End, path: KeyPath, values: Mapping[KeyPath, float]
) -> Iterator[Problem]:
    """Yield loads whose components are not those that the support leaves to be given."""
    for key in ("force", "moment"):
        load: Triple | AnyVector | None = getattr(end, key)
        if load is None or key not in RULES[support].keys:
            continue
        if support == "hinged":
            message = _off_hinge(load, end.axis or "d2")
        elif support == "sliding":
            message = _off_line(load, known(end.along, (*path, "along"), values))
        elif set(given(load)) in (set(_AXES), set(_DIRECTORS)):
            message = ""
        else:
            message = "needs all its components, of one frame; write for example "
            message += f'"{key}: [0, 0, 0]" or "{key}: {{d1: 0, d2: 0, d3: 0}}"'
        if message:
            yield Problem((*path, key), f"support: {support} {message}", written(load))


def _off_hinge(moment: Triple | AnyVector, axis: str) -> str:
    if isinstance(moment, AnyVector) and set(given(moment)) == {axis}:
        return ""
    example = f'write for example "moment: {{{axis}: 0}}"'
    return f"takes the moment about the hinge, {axis}, and no other; {example}"


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


def _start_of_string(start: End, path: KeyPath) -> Iterator[Problem]:
    """Yield what keeps the start from being the fixed point where a string to the end begins."""
    what = "support: held at the end is a string from a fixed point, the start"
    if start.support in ("sliding", "free", "flip"):
        message = f'{what}, which {start.support} is not; write for example "support: pinned"'
        yield Problem((*path, "support"), message, repr(start.support))
    elif start.support is None and start.position is None:
        yield Problem(path, f'{what}; add for example "{EXAMPLES["position"]}"')
    elif start.support is None:
        yield from check_whole_position(f"{what}, and needs", start.position, path)
