"""Data to instances of annotated frozen dataclasses, or every fault of the data at its place.

The classes of a scene are the only description of it; this file reads their annotations, of those
classes only that a scene has. A union is "tagged by shape": what was written (a list, a mapping, a
number, a text) picks one branch before validation, so that an error speaks of that branch alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, Field, fields, is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin

from ribbonopt.scene.faults import InvalidSceneError

from .annotations import branches, classes_of, hints, key_of, keys_of, tag_chooser, types_of
from .bounds import Bounds, InPython
from .found import Fault, Kind, Loc
from .values import Check, fixed, items, literal, mapping, number, plain, step, text

T = TypeVar("T")


def validate(cls: type[T], data: object) -> T:
    """Build a frozen dataclass from plain data, or check an instance and all it contains.

    Parameters
    ----------
    cls
        A dataclass whose annotations describe the data.
    data
        Mappings, lists and scalars as read from a file, or an instance built in Python.

    Returns
    -------
    T
        An instance of `cls`; lists have become tuples and whole numbers floats where annotated so.

    Raises
    ------
    InvalidSceneError
        With every problem of the data, each at its path.
    """
    faults: list[Fault] = []
    root: type = cls
    instance: T = check_of(root)(data, (), faults)
    if faults:
        from .explain import explain  # only a mistake pays for it

        raise InvalidSceneError(explain(cls, faults))
    return instance


@cache
def check_of(annotation: Any) -> Check:
    """Return what checks data against an annotation.

    Parameters
    ----------
    annotation
        float, int, bool, str, None, Literal, tuple, dict, a dataclass, Annotated with `Bounds` or
        `InPython`, or a union of those.
    """
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated and isinstance(arguments[1], InPython):
        return plain(lambda value: isinstance(value, arguments[0]))
    if origin is Annotated and arguments[0] in (float, int):
        return number(arguments[0], arguments[1])
    if annotation in (float, int):
        return number(annotation, Bounds())
    if annotation is bool:
        return plain(lambda value: isinstance(value, bool))
    if annotation is str:
        return text
    if annotation in (None, NoneType):
        return plain(lambda value: value is None)
    if origin is Literal:
        return literal(arguments)
    if origin is tuple and arguments[-1] is Ellipsis:
        return items(check_of(arguments[0]))
    if origin is tuple:
        return fixed([check_of(item) for item in arguments])
    if origin is dict:
        return mapping(check_of(arguments[0]), check_of(arguments[1]))
    if origin in (Union, UnionType):
        return _union(annotation)
    if is_dataclass(annotation) and isinstance(annotation, type):
        return _dataclass(annotation)
    raise TypeError(f"a scene cannot hold {annotation!r}")


def _dataclass(cls: type, *, type_required: bool = False) -> Check:
    """Return the check of a class; `type` must be given where it has picked the class."""
    members = [
        (member.name, key_of(member.name), member.default, _made(member, type_required))
        for member in fields(cls)
    ]
    keys = set(keys_of(cls))
    check_of_key = cache(lambda key: check_of(hints(cls)[key]))  # of those keys only that occur

    def check(value: Any, loc: Loc, faults: list[Fault]) -> Any:
        if isinstance(value, cls):
            value = {key: getattr(value, name) for name, key, _, _ in members}
        elif not isinstance(value, dict):
            faults.append(Fault(Kind.VALUE, loc, value))
            return None
        before, built = len(faults), {}
        for name, key, default, made in members:
            if key not in value:
                if made is None:
                    faults.append(Fault(Kind.MISSING, (*loc, key), value))
                else:
                    built[name] = made()
            elif value[key] is default:  # sound, as the class says
                built[name] = default
            else:
                built[name] = check_of_key(key)(value[key], (*loc, key), faults)
        if len(value) > len(keys) or not keys.issuperset(value):
            faults.extend(_foreign(value, keys, loc))
        return cls(**built) if len(faults) == before else None

    return check


def _foreign(value: dict[Any, Any], keys: set[str], loc: Loc) -> list[Fault]:
    """Return the faults of keys that a class does not have."""
    return [
        Fault(Kind.UNKNOWN, (*loc, key), item)
        if isinstance(key, str)
        else Fault(Kind.KEY, (*loc, step(key)), key)
        for key, item in value.items()
        if key not in keys
    ]


def _made(member: Field[Any], type_required: bool) -> Callable[[], Any] | None:
    if type_required and member.name == "type":
        return None
    if member.default is not MISSING:
        return lambda: member.default
    return None if member.default_factory is MISSING else member.default_factory


def _union(annotation: Any) -> Check:
    tagged, choose = branches(annotation), tag_chooser(annotation)
    several = len(classes_of(annotation)) > 1
    named = types_of(annotation) if several and "text" not in tagged else {}

    @cache
    def check_of_branch(tag: str) -> Check | None:
        if tag == "text" and named:
            return check_name
        if tag not in tagged:
            return None
        if several and is_dataclass(tagged[tag]):
            return _dataclass(tagged[tag], type_required=True)
        return check_of(tagged[tag])

    def check_name(value: Any, loc: Loc, faults: list[Fault]) -> Any:
        # A name alone stands for the dataclass of that type, with nothing but defaults.
        if value in named:
            return tagged[named[value]](type=str(value))
        faults.append(Fault(Kind.VALUE, loc, value))
        return None

    def check(value: Any, loc: Loc, faults: list[Fault]) -> Any:
        tag = choose(value)
        branch = None if tag is None else check_of_branch(tag)
        if tag is None or branch is None:
            faults.append(Fault(Kind.VALUE, loc, value))
            return None
        return branch(value, (*loc, tag), faults)

    return check
