"""Annotated frozen dataclasses to a schema of `pydantic_core`, and data to their instances.

The classes of a scene are the only description of it; this file reads their annotations.
pydantic's engine is used without pydantic itself, whose import would double the start-up time of a
command. A union is "tagged by shape": what was written (a list, a mapping, a number, a text) picks
one branch before validation, so that an error speaks of that branch alone.
"""

from __future__ import annotations

from dataclasses import MISSING, Field, fields, is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin

from pydantic_core import SchemaValidator, ValidationError, core_schema
from pydantic_core.core_schema import CoreSchema

from ribbonopt.scene.faults import InvalidSceneError

from .annotations import branches, classes_of, hints, key_of, tag_chooser, types_of
from .bounds import Bounds, InPython

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
    root: type = cls
    try:
        instance: T = _validator(root).validate_python(data)
    except ValidationError as error:
        from .explain import explain  # only a mistake pays for it

        details = error.errors(include_url=False)
        raise InvalidSceneError(explain(cls, details)) from None
    return instance


@cache
def _validator(cls: type) -> SchemaValidator:
    return SchemaValidator(schema_of(cls))


def schema_of(annotation: Any, *, type_required: bool = False) -> CoreSchema:
    """Return the core schema of an annotation; its list is in the design of the scene's classes.

    Parameters
    ----------
    annotation
        float, int, bool, str, None, Literal, tuple, dict, a dataclass, Annotated with `Bounds` or
        `InPython`, or a union of those.
    type_required
        Whether the field `type` of a dataclass must be given because it picks the dataclass.
    """
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated and isinstance(arguments[1], InPython):
        return core_schema.is_instance_schema(arguments[0])
    if origin is Annotated and arguments[0] in (float, int):
        return _number(arguments[0], *arguments[1:])
    if annotation in (float, int):
        return _number(annotation)
    if annotation is bool:
        return core_schema.bool_schema(strict=True)
    if annotation is str:
        return core_schema.str_schema(strict=True)
    if annotation in (None, NoneType):
        return core_schema.none_schema()
    if origin is Literal:
        return _literal(list(arguments))
    if origin is tuple:
        variadic = 0 if arguments[-1] is Ellipsis else None
        items = [schema_of(item) for item in arguments if item is not Ellipsis]
        return core_schema.tuple_schema(items, variadic_item_index=variadic)
    if origin is dict:
        return core_schema.dict_schema(schema_of(arguments[0]), schema_of(arguments[1]))
    if origin in (Union, UnionType):
        return _union(annotation)
    if is_dataclass(annotation) and isinstance(annotation, type):
        return _dataclass(annotation, type_required)
    raise TypeError(f"a scene cannot hold {annotation!r}")


def _number(number: Any, bounds: Bounds | None = None) -> CoreSchema:
    limits: dict[str, Any] = {
        name: limit
        for name in ("gt", "ge", "lt", "le")
        if (limit := getattr(bounds, name, None)) is not None
    }
    if bounds is not None and bounds.most is not None:
        limits = {"ge": -bounds.most, "le": bounds.most} | limits
    if number is int:
        return core_schema.int_schema(strict=True, **limits)
    return core_schema.float_schema(strict=True, allow_inf_nan=False, **limits)


def _literal(values: list[Any]) -> CoreSchema:
    literal = core_schema.literal_schema(values)
    if all(isinstance(value, str) for value in values):
        return literal
    # A literal 1 would take True and 1.0 as well, since they are equal to it.
    whole = core_schema.chain_schema([core_schema.int_schema(strict=True), literal])
    return core_schema.json_or_python_schema(json_schema=literal, python_schema=whole)


@cache
def _dataclass(cls: type, type_required: bool) -> CoreSchema:
    members = fields(cls)
    schema = core_schema.dataclass_schema(
        cls,
        core_schema.dataclass_args_schema(
            cls.__name__,
            [
                core_schema.dataclass_field(
                    name=member.name,
                    schema=_with_default(
                        member,
                        schema_of(hints(cls)[key_of(member.name)]),
                        required=type_required and member.name == "type",
                    ),
                    kw_only=True,
                    validation_alias=key_of(member.name),
                )
                for member in members
            ],
            extra_behavior="forbid",
        ),
        [member.name for member in members],
        revalidate_instances="always",
    )
    if all(key_of(member.name) == member.name for member in members):
        return schema
    # The engine would look in an instance for the names of its fields, in a mapping for the keys.
    return core_schema.no_info_before_validator_function(
        lambda value: (
            {key_of(member.name): getattr(value, member.name) for member in members}
            if isinstance(value, cls)
            else value
        ),
        schema,
    )


def _with_default(member: Field[Any], schema: CoreSchema, *, required: bool) -> CoreSchema:
    if required:
        return schema
    if member.default is not MISSING:
        return core_schema.with_default_schema(schema, default=member.default)
    if member.default_factory is not MISSING:
        return core_schema.with_default_schema(schema, default_factory=member.default_factory)
    return schema


@cache
def _union(annotation: Any) -> CoreSchema:
    tagged = branches(annotation)
    several = len(classes_of(annotation)) > 1
    choices: dict[Any, CoreSchema] = {
        tag: schema_of(branch, type_required=several and is_dataclass(branch))
        for tag, branch in tagged.items()
    }
    if several and (types := types_of(annotation)) and "text" not in tagged:
        # A name alone stands for the dataclass of that type, with nothing but defaults.
        named = {name: tagged[tag] for name, tag in types.items()}
        choices["text"] = core_schema.no_info_after_validator_function(
            lambda name: named[name](type=name), core_schema.literal_schema(list(named))
        )
    return core_schema.tagged_union_schema(choices, tag_chooser(annotation))
