"""What annotations say, and which branch of a union the shape of a value picks.

Every branch of a union has a tag: the name of a dataclass, or the shape a value must have.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from numbers import Real
from types import NoneType, SimpleNamespace, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from ribbonopt.scene.faults import nearest

from .bounds import InPython


def key_of(name: str) -> str:
    """Return the key of a field: its name without the underscore that tells it from a keyword."""
    return name.removesuffix("_")


@cache
def _hint(cls: type, key: str) -> Any:
    member = next(some for some in fields(cls) if key_of(some.name) == key)
    # Where it stands in the code decides what its words mean.
    owners = [base for base in cls.__mro__ if _own_field(base, member.name) is member]
    one = SimpleNamespace(__annotations__={key: member.type})
    return get_type_hints(one, vars(sys.modules[owners[-1].__module__]), include_extras=True)[key]


def _own_field(cls: type, name: str) -> Any:
    return vars(cls).get("__dataclass_fields__", {}).get(name)


class Hints(Mapping[str, Any]):
    """What the keys of a dataclass may hold; each annotation is read when it is asked for."""

    def __init__(self, cls: type) -> None:
        self._cls, self._keys = cls, keys_of(cls)

    def __getitem__(self, key: str) -> Any:
        if key not in self._keys:
            raise KeyError(key)
        return _hint(self._cls, key)

    def __iter__(self) -> Iterator[str]:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)


@cache
def hints(cls: type) -> Hints:
    """Return the annotations of a dataclass, by the key of the field."""
    return Hints(cls)


def keys_of(cls: type) -> list[str]:
    """Return the keys of a dataclass."""
    return [key_of(member.name) for member in fields(cls)]


def only_in_python(annotation: Any) -> bool:
    """Whether no file can say what an annotation asks for: `InPython`, or a list of that."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is tuple:
        return only_in_python(arguments[0])
    return origin is Annotated and isinstance(arguments[1], InPython)


def written_keys(cls: type) -> list[str]:
    """Return the keys of a dataclass that a file may have."""
    return [key for key, annotation in hints(cls).items() if not only_in_python(annotation)]


@cache
def branches(annotation: Any) -> Mapping[str, Any]:
    """Return the branches of a union by tag; empty for what is not a union."""
    if get_origin(annotation) not in (Union, UnionType):
        return {}
    tagged: dict[str, Any] = {}
    for branch in get_args(annotation):
        tag = _tag_of_annotation(branch)
        if tag in tagged:
            raise TypeError(f"two branches of {annotation} look alike: {tagged[tag]} and {branch}")
        tagged[tag] = branch
    return tagged


def classes_of(annotation: Any) -> dict[str, type]:
    """Return the dataclasses among the branches of a union, by tag."""
    members = branches(annotation).items()
    return {tag: cls for tag, cls in members if is_dataclass(cls) and isinstance(cls, type)}


def types_of(annotation: Any) -> dict[str, str]:
    """Return the values of `type` that pick a dataclass of a union, each with its tag."""
    return {
        name: tag
        for tag, cls in classes_of(annotation).items()
        if "type" in hints(cls)
        for name in get_args(hints(cls)["type"])
    }


def tag_chooser(annotation: Any) -> Callable[[Any], str | None]:
    """Return the function that picks the branch of a union by the shape of a value.

    A mapping goes to the dataclass named by its `type`; where the dataclasses have no `type`, to
    the one that owns most of its keys, or else names like them. No branch may exist for the tag
    that is returned.
    """
    classes = {tag: hints(cls) for tag, cls in classes_of(annotation).items()}
    types, known = types_of(annotation), branches(annotation)
    own = {tag: get_args(some)[0] for tag, some in known.items() if only_in_python(some)}

    def choose(value: Any) -> str | None:
        if not isinstance(value, dict) or not classes:
            tag = _tag_of_value(value)
            cls = known.get(tag)
            # In Python 3.10 a parameterized tuple is a type, too.
            named = isinstance(cls, type) and not get_origin(cls) and not isinstance(value, cls)
            mine = own if named or tag not in known else {}
            return next((name for name, cls in mine.items() if isinstance(value, cls)), tag)
        if len(classes) == 1:
            return next(iter(classes))
        if types:
            name = value.get("type")
            return types.get(name) if isinstance(name, str) else None
        keys = [key for key in value if isinstance(key, str)]
        owned = {tag: sum(key in classes[tag] for key in keys) for tag in classes}
        if not any(owned.values()):
            names = [name for members in classes.values() for name in members]
            meant = [nearest(key, names) for key in keys]
            owned = {tag: sum(name in classes[tag] for name in meant) for tag in classes}
        best = max(owned, key=lambda tag: owned[tag])
        return best if owned[best] else None

    return choose


def inside(annotation: Any, step: str | int) -> Any:
    """Return the annotation of what a key or an index leads to; None where nothing is."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if is_dataclass(annotation) and isinstance(annotation, type):
        return hints(annotation).get(str(step))
    if origin is dict:
        return arguments[1]
    if origin is tuple and isinstance(step, int):
        return arguments[0] if arguments[-1] is Ellipsis else arguments[step]
    return None


def _tag_of_annotation(annotation: Any) -> str:
    origin, arguments = get_origin(annotation), get_args(annotation)
    if only_in_python(annotation):
        return str(arguments[0].__name__)
    if origin is Annotated:
        return _tag_of_annotation(arguments[0])
    if origin is Literal:
        return _tag_of_value(arguments[0])
    samples: dict[Any, object] = {float: 0.0, int: 0, bool: True, str: "", NoneType: None}
    samples |= {tuple: (), dict: {}}
    shape = origin or annotation
    return _tag_of_value(samples[shape]) if shape in samples else annotation.__name__


def _tag_of_value(value: object) -> str:
    if isinstance(value, str):
        return "text"
    if isinstance(value, bool):
        return "truth"
    if isinstance(value, Real):
        return "number"
    if isinstance(value, list | tuple):
        return "list"
    if isinstance(value, dict):
        return "mapping"
    return "null" if value is None else type(value).__name__
