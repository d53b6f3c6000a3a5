"""Errors of `pydantic_core` in the words of a scene: what was found, expected, and the remedy.

The engine says where and of what kind an error is; what was expected is read from the annotation
at that place, so that a bound or a choice is always told in full.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import is_dataclass
from types import NoneType
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic_core import ErrorDetails

from .bounds import Bounds
from .problems import Path, Problem, shown, suggestion
from .shapes import branches, classes_of, hints, inside, types_of

_KEY_OF_MAPPING = "[key]"


def explain(cls: type, error: ErrorDetails) -> Problem:
    """Return one error as a problem of the scene.

    Parameters
    ----------
    cls
        The dataclass that was validated.
    error
        What `ValidationError.errors()` tells of one error; its location holds the tags of
        unions, which the path of the problem does not.
    """
    path: Path = ()
    annotation: Any = cls
    union: Any = None
    owner: Any = None
    for step in error["loc"]:
        if branches(annotation):
            union, annotation = annotation, branches(annotation)[str(step)]
        elif step != _KEY_OF_MAPPING:
            owner, annotation = annotation, inside(annotation, step)
            path = (*path, step)

    value, kind = error["input"], error["type"]
    if kind == "invalid_key" or error["loc"][-1:] == (_KEY_OF_MAPPING,):
        return Problem(path, "expected text as the key", shown(value))
    if kind == "unexpected_keyword_argument":
        return Problem(path, _unknown_key(str(path[-1]), owner, union))
    if kind == "missing" and get_origin(owner) is tuple:
        return Problem(path[:-1], f"expected {expected(owner)}", shown(value))
    if kind == "missing":
        return Problem(path, f"missing; expected {expected(annotation)}")
    if isinstance(value, dict) and (types := types_of(annotation)):
        return _without_type((*path, "type"), value, types)
    hint = suggestion(value, _words(annotation)) if isinstance(value, str) else ""
    finite = isinstance(value, float) and not math.isfinite(value)
    remedy = "; it must be finite" if finite else hint
    return Problem(path, f"expected {expected(annotation)}{remedy}", shown(value))


def expected(annotation: Any) -> str:
    """Return what an annotation asks for, in words."""
    origin, arguments = get_origin(annotation), get_args(annotation)
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
        return f"a mapping with keys among {', '.join(hints(annotation))}"
    words = {float: "a number", int: "a whole number", bool: "true or false", str: "text"}
    return words.get(annotation, "null")


def _expected_of_union(annotation: Any) -> str:
    parts = []
    members = [branch for branch in branches(annotation).values() if branch is not NoneType]
    types = types_of(annotation)
    for branch in members:
        if branch is str and float in members:
            parts.append("a formula")  # text in the place of a number
        elif not (types and is_dataclass(branch)):
            parts.append(expected(branch))
    if types:
        parts.append(f"a mapping whose `type` is {_one_of(types)}")
    return " or ".join(parts)


def _limits(bounds: Bounds) -> str:
    if bounds.ge is not None and bounds.le is not None:
        return f" from {bounds.ge:g} to {bounds.le:g}"
    signs = {">": bounds.gt, ">=": bounds.ge, "<": bounds.lt, "<=": bounds.le}
    limits = [f"{sign} {limit:g}" for sign, limit in signs.items() if limit is not None]
    return " " + " and ".join(limits) if limits else ""


def _one_of(values: Iterable[object]) -> str:
    texts = [repr(value) for value in values]
    return ", ".join(texts[:-1]) + " or " + texts[-1] if len(texts) > 1 else texts[0]


def _words(annotation: Any) -> list[str]:
    members = list(branches(annotation).values()) or [annotation]
    literals = [word for member in members for word in _literals(member)]
    return [word for word in literals if isinstance(word, str)]


def _literals(annotation: Any) -> tuple[Any, ...]:
    return get_args(annotation) if get_origin(annotation) is Literal else ()


def _without_type(path: Path, value: dict[str, Any], types: dict[str, str]) -> Problem:
    if "type" not in value:
        return Problem(path, f"missing; expected {_one_of(types)}")
    name = value["type"]
    hint = suggestion(name, types) if isinstance(name, str) else ""
    return Problem(path, f"expected {_one_of(types)}{hint}", shown(name))


def _unknown_key(key: str, owner: Any, union: Any) -> str:
    known = hints(owner)
    message = f"unknown key{suggestion(key, known)} (known keys: {', '.join(known)})"
    siblings = {tag: cls for tag, cls in classes_of(union).items() if cls is not owner}
    owners = [name for name, tag in types_of(union).items() if key in hints_of(siblings, tag)]
    if owner in classes_of(union).values() and owners:
        message += f"; {key!r} belongs to type {_one_of(owners)}"
    return message


def hints_of(classes: dict[str, type], tag: str) -> dict[str, Any]:
    """Return the annotations of the class of a tag; empty for a tag that is not there."""
    return hints(classes[tag]) if tag in classes else {}
