"""Numbers of a scene that are finite, but not what becomes of them; see `ribbonopt.scene.limits`.

What a number is worth in units L = 1, Dw = 1 is known only when all sizes are, so that this is
looked at last, in a scene that is sound otherwise.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any

from ribbonopt.scene import limits
from ribbonopt.scene.faults import KeyPath, Problem, dotted
from ribbonopt.scene.laws import Stiff
from ribbonopt.scene.model import Scene
from ribbonopt.scene.schema.annotations import key_of
from ribbonopt.scene.sized import Sano
from ribbonopt.scene.units import Units, units_of

from .kinds import KINDS, Kind
from .sized import check_narrow

_OURS = __name__.partition(".checks")[0]
_NEVER_ZERO = (
    "ribbon",
    "B",
    "B2",
    "B3",
    "zeta",
    "first",
    "smallest",
    "largest",
    "tolerance",
    "distance",
    "membrane",
)


def as_written(value: Any, path: KeyPath = (), like: Any = None) -> Iterator[Problem]:
    """Yield the numbers whose products would not be finite, and lists that are too long.

    None of the parts that the value shares with a sound one that it is `like`.
    """
    if isinstance(value, float):
        yield from _size(value, path)
    elif isinstance(value, tuple | dict):
        most = limits.ITEMS_OF.get(str(path[-1]), limits.ITEMS)
        if len(value) > most:
            yield Problem(path, f"expected at most {most:,} of them", f"{len(value):,} items")
            return
        pairs = value.items() if isinstance(value, dict) else enumerate(value)
        for key, item in pairs:
            yield from as_written(item, (*path, key))
    elif is_dataclass(value):
        cls: type = type(value)
        for name, key in _members(cls):
            part, known = getattr(value, name), getattr(like, name, None)
            if part is not known and not isinstance(part, str):
                yield from as_written(part, (*path, key), known)
    if path == ("interval",) and value[0] < value[1]:
        yield from _interval(*value)


@cache
def _members(cls: type) -> tuple[tuple[str, str], ...]:
    """Return the fields of one of our dataclasses, each with its key; none of any other class."""
    ours = is_dataclass(cls) and cls.__module__.startswith(_OURS)
    return tuple((f.name, key_of(f.name)) for f in fields(cls)) if ours else ()


def _size(number: float, path: KeyPath) -> Iterator[Problem]:
    if abs(number) > limits.LARGEST:
        message = f"expected at most {limits.LARGEST:g} in size, so that squares stay finite"
        yield Problem(path, message, f"{number:g}")
    elif 0 < abs(number) < limits.SMALLEST and {*_NEVER_ZERO} & {*map(str, path)}:
        message = f"expected at least {limits.SMALLEST:g} in size, so that squares are not zero"
        yield Problem(path, message, f"{number:g}")


def _interval(start: float, end: float) -> Iterator[Problem]:
    length = end - start
    if length < limits.SMALLEST:
        message = f"has length {length:g}, expected at least {limits.SMALLEST:g}"
        yield Problem(("interval",), message, f"[{start:g}, {end:g}]")
    elif max(abs(start), abs(end)) > limits.REACH * length:
        message = (
            f"begins further from 0 than {limits.REACH:g} times its length, {length:g}, where "
        )
        example = f'rounding is seen in the shape; write for example "interval: [0, {length:g}]"'
        yield Problem(("interval",), message + example, f"[{start:.12g}, {end:.12g}]")


def in_units(
    scene: Scene, values: Mapping[KeyPath, float], like: Scene | None = None
) -> Iterator[Problem]:
    """Yield what is too large, or too unlike the rest, in units L = 1, Dw = 1.

    `values` are those of the formulas, by path; of what varies along the ribbon, the largest. A
    sound scene that is `like` this one has the same values: in the same units, what both share is
    not looked at again.
    """
    units = units_of(scene)
    like = like if like is not None and units_of(like) == units else None
    start, end = scene.interval
    yield from _length(end - start, units)
    if isinstance(scene.law, Stiff):
        yield from _ratios(scene.law)
    if isinstance(scene.law, Sano):
        yield from _moduli(scene.law)
    yield from check_narrow(scene, units)
    for path, kind in KINDS.items():
        root = str(path[0])
        if like is not None and getattr(scene, root) is getattr(like, root):
            continue
        for place, value in _at(scene, path):
            unit = kind.unit_of(units)
            for at, number in _numbers(value, place, values):
                if abs(number) > kind.limit * unit:
                    yield Problem(at, _message(number, kind, unit, units), f"{number:g}")


def _ratios(law: Stiff) -> Iterator[Problem]:
    """Yield stiffnesses too unlike the first, by which all are divided."""
    (first, unit), *others = law.stiffnesses.items()
    for path, value in others:
        ratio = value / unit
        if not 1 / limits.RATIO <= ratio <= limits.RATIO:
            message = f"which is {ratio:g} times {dotted(('law', *first))}; expected a ratio from "
            message += f"{1 / limits.RATIO:g} to {limits.RATIO:g}"
            yield Problem(("law", *path), message, f"{value:g}")


def _moduli(law: Sano) -> Iterator[Problem]:
    """Yield stiffnesses too unlike Dw, the unit of the term that they stand beside."""
    for name, value in (("B2", law.B2), ("B3", law.B3)):
        if value is not None and not 1 / limits.RATIO <= value <= limits.RATIO:
            message = f"in units of Dw; expected from {1 / limits.RATIO:g} to {limits.RATIO:g}"
            yield Problem(("law", name), message, f"{value:g}")


def _length(length: float, units: Units) -> Iterator[Problem]:
    ratio = length / units.length
    if not 1 / limits.REACH <= ratio <= limits.REACH:
        what = "ribbon.length" if units.si else "the unit of its law or loads, which is 1"
        message = f"has length {length:g}, {ratio:g} times {what}; expected from "
        message += f"{1 / limits.REACH:g} to {limits.REACH:g} of it"
        yield Problem(("interval",), message)


def _message(number: float, kind: Kind, unit: float, units: Units) -> str:
    # The unit of the stiffness is the law's own where that is far from 1.
    own = kind.unit if units.stiffness == 1 else kind.unit.replace("D w", "law.B2 D w")
    name = f" {own}" if own else ""
    worth = f"which is {abs(number) / unit:.3g}{name}, " if unit != 1 else ""
    advice = "; look at ribbon as well, whose sizes set the units" if units.si else ""
    return f"{worth}expected at most {kind.limit:g}{name} in size: {kind.reason}{advice}"


def _at(value: Any, path: KeyPath, before: KeyPath = ()) -> Iterator[tuple[KeyPath, Any]]:
    """Yield what is at the end of a path, in each item of a list on the way, with its own path."""
    for depth, key in enumerate(path):
        if isinstance(value, tuple):
            for index, item in enumerate(value):
                yield from _at(item, path[depth:], (*before, *path[:depth], index))
            return
        value = getattr(value, str(key), None)
        if value is None:  # as most are
            return
    yield (*before, *path), value


def _numbers(
    value: Any, path: KeyPath, values: Mapping[KeyPath, float]
) -> Iterator[tuple[KeyPath, float]]:
    """Yield the numbers in a value with their paths, those of formulas and tables as well."""
    if isinstance(value, float):
        yield path, value
    elif path in values:
        yield path, values[path]
    elif isinstance(value, tuple):
        for index, item in enumerate(value):
            yield from _numbers(item, (*path, index), values)
    elif is_dataclass(value):
        for member in fields(value):
            part = getattr(value, member.name)
            if part is not None:
                yield from _numbers(part, (*path, member.name), values)
