"""Faults of data in the words of a scene: what was found, expected, and the remedy.

Validation says where and of what kind a fault is; what was expected is read from the annotation at
that place, so that a bound or a choice is always told in full.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import is_dataclass
from types import NoneType
from typing import Annotated, Any, Literal, NamedTuple, get_args, get_origin

from ribbonopt.scene.faults import KeyPath, Problem, nearest, shown, suggestion

from .annotations import (
    branches,
    classes_of,
    hints,
    inside,
    only_in_python,
    types_of,
    written_keys,
)
from .bounds import Bounds
from .foreign import elsewhere, unmodelled
from .found import Fault, Kind


class _Place(NamedTuple):
    """Where a fault is: its path, the annotations of the value and what holds it, the class."""

    path: KeyPath
    annotation: Any
    owner: Any
    union: Any
    root: type


def explain(cls: type, faults: Iterable[Fault]) -> list[Problem]:
    """Return faults as problems of the scene; a misspelt key is not told as missing as well.

    Parameters
    ----------
    cls
        The dataclass that was validated.
    faults
        What is wrong.
    """
    placed = [(_place(cls, fault), fault) for fault in faults]
    excused: set[KeyPath] = set()
    for place, fault in placed:
        if fault.kind is Kind.UNKNOWN:
            excused.update((*place.path[:-1], name) for name in _meant(place))
    problems = [
        _problem(place, fault)
        for place, fault in placed
        if not (fault.kind is Kind.MISSING and place.path in excused)
    ]
    return list(dict.fromkeys(problems))


def _place(cls: type, fault: Fault) -> _Place:
    """Follow the location of a fault, which holds tags of unions, as the path does not."""
    path: KeyPath = ()
    annotation: Any = cls
    union: Any = None
    owner: Any = None
    for step in fault.loc:
        if branches(annotation):
            # A name that stands for a dataclass is no branch of its own.
            union, annotation = annotation, branches(annotation).get(str(step), annotation)
        else:
            owner, annotation = annotation, inside(annotation, step)
            path = (*path, step)
    return _Place(path, annotation, owner, union, cls)


def _problem(place: _Place, fault: Fault) -> Problem:
    path, annotation, owner, union, _ = place
    kind, value = fault.kind, fault.found
    if kind is Kind.KEY:
        return Problem(path, "expected text as the key", shown(value))
    if kind is Kind.UNKNOWN:
        return Problem(path, _unknown_key(place))
    if kind is Kind.MISSING and get_origin(owner) is tuple:
        return Problem(path[:-1], f"expected {expected(owner)}", shown(value))
    if kind is Kind.MISSING:
        return Problem(path, f"missing; expected {expected(annotation)}")
    if isinstance(value, dict) and (types := types_of(annotation)):
        return _without_type((*path, "type"), value, types)
    remedy = ""
    if isinstance(value, int) and (most := _most(annotation)) and abs(value) > most:
        return Problem(path, f"expected at most {most:,}", shown(value))
    if isinstance(value, float) and not math.isfinite(value):
        remedy = "; it must be finite"
    elif isinstance(value, str):
        remedy = suggestion(value, [*_words(annotation), *types_of(annotation)])
        if not remedy:
            annotation = union if fault.loc[-1:] == ("text",) else annotation
            remedy = _as_mapping(value, annotation)
    return Problem(path, f"expected {expected(annotation)}{remedy}", shown(value))


def expected(annotation: Any) -> str:
    """Return what an annotation asks for, in words."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if only_in_python(annotation):
        return "what only Python can say"
    if origin is Annotated:
        return expected(arguments[0]) + _limits(*arguments[1:])
    if branches(annotation):
        return _expected_of_union(annotation)
    if origin is Literal:
        return _one_of(arguments)
    if origin is tuple:
        if arguments[-1] is Ellipsis:
            return f"a list, each item {expected(arguments[0])}"
        return f"a list of {len(arguments)} items, each {expected(arguments[0])}"
    if origin is dict:
        return f"a mapping of names, each to {expected(arguments[1])}"
    if is_dataclass(annotation) and isinstance(annotation, type):
        return f"a mapping with keys among {', '.join(written_keys(annotation))}"
    words = {float: "a number", int: "a whole number", bool: "true or false", str: "text"}
    return words.get(annotation, "null")


def _expected_of_union(annotation: Any) -> str:
    parts = []
    members = [
        branch
        for branch in branches(annotation).values()
        if branch is not NoneType and not only_in_python(branch)
    ]
    types, classes = types_of(annotation), classes_of(annotation).values()
    grouped = bool(types) or len(classes) > 1
    for branch in members:
        if branch is str and float in members:
            parts.append("a formula")  # text in the place of a number
        elif not (grouped and is_dataclass(branch)):
            parts.append(expected(branch))
    if types:
        parts.append(f"a mapping whose `type` is {_one_of(types)}, or that name alone")
    elif grouped:
        keys = ", or ".join(", ".join(written_keys(member)) for member in classes)
        parts.append(f"a mapping with keys {keys}")
    return " or ".join(parts)


def _limits(bounds: Bounds) -> str:
    if bounds.ge is not None and bounds.le is not None:
        return f" from {bounds.ge:g} to {bounds.le:g}"
    signs = {">": bounds.gt, ">=": bounds.ge, "<": bounds.lt, "<=": bounds.le}
    limits = [f"{sign} {limit:g}" for sign, limit in signs.items() if limit is not None]
    return " " + " and ".join(limits) if limits else ""


def _most(annotation: Any) -> int | None:
    bounds = next((b for b in get_args(annotation) if isinstance(b, Bounds)), None)
    return None if bounds is None else bounds.most


def _one_of(values: Iterable[object]) -> str:
    texts = [repr(value) for value in values]
    return ", ".join(texts[:-1]) + " or " + texts[-1] if len(texts) > 1 else texts[0]


def _words(annotation: Any) -> list[str]:
    members = list(branches(annotation).values()) or [annotation]
    literals = [word for member in members for word in _literals(member)]
    return [word for word in literals if isinstance(word, str)]


def _literals(annotation: Any) -> tuple[Any, ...]:
    return get_args(annotation) if get_origin(annotation) is Literal else ()


def _without_type(path: KeyPath, value: dict[str, Any], types: dict[str, str]) -> Problem:
    if "type" not in value:
        return Problem(path, f"missing; expected {_one_of(types)}")
    name = value["type"]
    hint = suggestion(name, types) if isinstance(name, str) else ""
    return Problem(path, f"expected {_one_of(types)}{hint}", shown(name))


def _as_mapping(word: str, annotation: Any) -> str:
    """Return the mapping that a single word was probably meant to be, as a remedy."""
    classes = list(classes_of(annotation).values())
    if is_dataclass(annotation) and isinstance(annotation, type):
        classes = [annotation]
    for cls in classes:
        for name, inner in hints(cls).items():
            if name == word:
                return f"; did you mean {{{name}: ...}}?"
            if word in _words(inner):
                return f"; did you mean {{{name}: {word}}}?"
    return ""


def _meant(place: _Place) -> list[str]:
    """Return the keys that an unknown key stands for: one it is like, or all of another class."""
    key, own = str(place.path[-1]), hints(place.owner)
    if _rivals(place):
        return list(own)
    return [near] if (near := nearest(key, own)) else []


def _rivals(place: _Place) -> list[type]:
    """Return the other classes of a union without `type` that own an unknown key."""
    classes = classes_of(place.union).values()
    if types_of(place.union) or place.owner not in classes:
        return []
    return [cls for cls in classes if cls is not place.owner and place.path[-1] in hints(cls)]


def _unknown_key(place: _Place) -> str:
    key, known = str(place.path[-1]), written_keys(place.owner)
    if _rivals(place):
        return f"cannot stand beside {', '.join(known)}; keep one of the two"
    if message := unmodelled(key) or elsewhere(key, place.path, place.root):
        return message
    message = f"unknown key{suggestion(key, known)} (known keys: {', '.join(known)})"
    classes = classes_of(place.union)
    if place.owner in classes.values():
        types = types_of(place.union).items()
        owners = [name for name, tag in types if key in hints(classes[tag])]
        message += f"; {key!r} belongs to type {_one_of(owners)}" if owners else ""
    return message
