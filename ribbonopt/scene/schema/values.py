"""Checks of what a scene is made of: numbers, words, lists, mappings.

Each takes a value, where it is, and the faults to add to; it returns the value as annotated, which
means nothing where it has added a fault.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from numbers import Real
from typing import Any

from .bounds import Bounds
from .found import Fault, Kind, Loc

Check = Callable[[Any, Loc, list[Fault]], Any]


def plain(good: Callable[[Any], bool]) -> Check:
    """Return the check of a value that is good or not."""

    def check(value: Any, loc: Loc, faults: list[Fault]) -> Any:
        if not good(value):
            faults.append(Fault(Kind.VALUE, loc, value))
        return value

    return check


def number(kind: Any, bounds: Bounds) -> Check:
    """Return the check of a finite float or a whole number (`kind`); a truth value is neither."""
    most = math.inf if bounds.most is None else bounds.most
    low = -most if bounds.ge is None else bounds.ge
    high = most if bounds.le is None else bounds.le
    above = -math.inf if bounds.gt is None else bounds.gt
    below = math.inf if bounds.lt is None else bounds.lt
    kinds = (float, int, Real) if kind is float else int  # the first two are found at once

    def within(value: float) -> bool:
        return low <= value <= high and above < value < below

    def check(value: Any, loc: Loc, faults: list[Fault]) -> Any:
        if isinstance(value, kinds) and not isinstance(value, bool):
            try:
                read = kind(value)
            except OverflowError:  # a whole number that no float can be
                read = math.nan
            if within(read):
                return read
        faults.append(Fault(Kind.VALUE, loc, value))
        return None

    return check


def text(value: Any, loc: Loc, faults: list[Fault]) -> Any:
    """Check a text, which becomes a plain one."""
    if isinstance(value, str):
        return str(value)
    faults.append(Fault(Kind.VALUE, loc, value))
    return None


def literal(values: tuple[Any, ...]) -> Check:
    """Return the check of one of some words or whole numbers."""

    def check(value: Any, loc: Loc, faults: list[Fault]) -> Any:
        # The literal 1 is not to take True and 1.0 as well, since they are equal to it.
        if isinstance(value, str | int) and not isinstance(value, bool) and value in values:
            return values[values.index(value)]
        faults.append(Fault(Kind.VALUE, loc, value))
        return None

    return check


def listed(value: Any) -> Sequence[Any] | None:
    """Return a value as a sequence, such as an array in a scene built in Python; None of others."""
    if isinstance(value, list | tuple):
        return value
    if isinstance(value, str | bytes | bytearray | Mapping) or not isinstance(value, Iterable):
        return None
    try:
        return list(value)
    except TypeError:  # of an array of no dimension
        return None


def items(check_item: Check) -> Check:
    """Return the check of a list of any length."""

    def check(value: Any, loc: Loc, faults: list[Fault]) -> Any:
        found = listed(value)
        if found is None:
            faults.append(Fault(Kind.VALUE, loc, value))
            return None
        return tuple([check_item(item, (*loc, i), faults) for i, item in enumerate(found)])

    return check


def fixed(items: list[Check]) -> Check:
    """Return the check of a list of which each item has its own."""

    def check(value: Any, loc: Loc, faults: list[Fault]) -> Any:
        found = listed(value)
        if found is None or len(found) > len(items):
            faults.append(Fault(Kind.VALUE, loc, value))
            return None
        if len(found) < len(items):
            faults.append(Fault(Kind.MISSING, (*loc, len(found)), value))
        pairs = enumerate(zip(items, found, strict=False))
        return tuple([check_item(item, (*loc, i), faults) for i, (check_item, item) in pairs])

    return check


def mapping(check_key: Check, check_value: Check) -> Check:
    """Return the check of a mapping of any keys."""

    def check(value: Any, loc: Loc, faults: list[Fault]) -> Any:
        if not isinstance(value, Mapping):
            faults.append(Fault(Kind.VALUE, loc, value))
            return None
        built = {}
        for key, item in value.items():
            place = (*loc, step(key))
            wrong: list[Fault] = []
            name = check_key(key, place, wrong)
            if wrong:
                faults.append(Fault(Kind.KEY, place, key))
            built[name] = check_value(item, place, faults)
        return built

    return check


def step(key: Any) -> str | int:
    """Return a key as it stands in a path."""
    return key if isinstance(key, str | int) else str(key)
