"""The JSON schema of files, from the annotations that validation reads and from docstrings.

An object is told by its class: `title` is its name, `description` its docstring. Where a key holds
one, what the docstring of the holder says of the key comes first, a paragraph of its own.
"""

from __future__ import annotations

from dataclasses import MISSING, Field, fields, is_dataclass
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from .annotations import branches, classes_of, hints, key_of, only_in_python, types_of
from .bounds import Bounds
from .described import Described, described, prose

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def json_schema_of(cls: type) -> dict[str, Any]:
    """Return the JSON schema of a dataclass and of all that it contains."""
    return {"$schema": DIALECT, **_object(cls)}


def _schema(annotation: Any) -> dict[str, Any]:
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin in (Union, UnionType):
        return _union(annotation)
    if origin is Annotated:
        return _limits(arguments[1]) | _schema(arguments[0])
    if origin is Literal:
        return _literal(arguments)
    if origin is tuple and arguments[-1] is Ellipsis:
        return {"items": _schema(arguments[0]), "type": "array"}
    if origin is tuple:
        items = [_schema(item) for item in arguments]
        sizes = {"maxItems": len(items), "minItems": len(items)}
        return {**sizes, "prefixItems": items, "type": "array"}
    if origin is dict:
        return {"additionalProperties": _schema(arguments[1]), "type": "object"}
    if is_dataclass(annotation) and isinstance(annotation, type):
        return _object(annotation)
    if annotation is Any:
        return {}
    plain = {float: "number", int: "integer", bool: "boolean", str: "string", NoneType: "null"}
    return {"type": plain[annotation]}


def _limits(bounds: Bounds) -> dict[str, Any]:
    """Return the limits of a number; one on its size is told as both."""
    low = -bounds.most if bounds.most is not None and bounds.ge is None else bounds.ge
    high = bounds.most if bounds.le is None else bounds.le
    told = {
        "exclusiveMaximum": bounds.lt,
        "exclusiveMinimum": bounds.gt,
        "maximum": high,
        "minimum": low,
    }
    return {name: limit for name, limit in told.items() if limit is not None}


def _literal(values: tuple[Any, ...]) -> dict[str, Any]:
    kind = "string" if isinstance(values[0], str) else "integer"
    told = {"const": values[0]} if len(values) == 1 else {"enum": list(values)}
    return {**told, "type": kind}


def _union(annotation: Any) -> dict[str, Any]:
    members = {tag: some for tag, some in branches(annotation).items() if not only_in_python(some)}
    several = len(classes_of(annotation)) > 1
    told = [
        _object(some, type_required=several) if is_dataclass(some) else _schema(some)
        for some in members.values()
    ]
    if several and (types := types_of(annotation)) and "text" not in members:
        told.append(_literal(tuple(types)))  # a name alone stands for its class
    return told[0] if len(told) == 1 else {"oneOf": told}


def _object(cls: Any, *, type_required: bool = False) -> dict[str, Any]:
    """Return the schema of a dataclass; `type` is required where it has picked the class."""
    members = [
        (key_of(member.name), hint, member)
        for member in fields(cls)
        if not only_in_python(hint := hints(cls)[key_of(member.name)])
    ]
    required = [
        key
        for key, _, member in members
        if (member.default is MISSING and member.default_factory is MISSING)
        or (type_required and member.name == "type")
    ]
    says = described(cls)

    def words_of(key: str) -> Described:
        """Return what is said of a key; of a `type`, which is but a name, what the class is."""
        summary = prose(cls).partition("\n")[0] if key == "type" else ""
        return says.get(key, Described(summary, ()))  # python -OO knows no docstrings

    told: dict[str, Any] = {"description": prose(cls)}
    if required:
        told["required"] = required
    return {
        **told,
        "title": cls.__name__,
        "type": "object",
        "properties": {
            key: _member(hint, member, key in required, words_of(key))
            for key, hint, member in members
        },
        "additionalProperties": False,
    }


def _member(hint: Any, member: Field[Any], required: bool, said: Described) -> dict[str, Any]:
    schema, default = _schema(hint), member.default
    if "title" in schema:  # of a class, whose default says nothing
        both = (said.text, schema["description"])
        return {**schema, "description": "\n\n".join(both), **_examples(said)}
    told: dict[str, Any] = {**schema, "title": key_of(member.name).title().replace("_", " ")}
    told |= {"description": said.text, **_examples(said)}
    if not (required or default in (MISSING, None) or is_dataclass(default)):
        told["default"] = list(default) if isinstance(default, tuple) else default
    return dict(sorted(told.items()))


def _examples(said: Described) -> dict[str, Any]:
    return {"examples": list(said.examples)} if said.examples else {}
