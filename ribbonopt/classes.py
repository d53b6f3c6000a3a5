"""Dataclasses whose constructors are written when they are worth it.

The standard decorator writes and compiles six methods a class, half a millisecond: for the 130
classes that a command imports, of which it makes every other, a quarter of all its time. Here
fields are declared as ever (`dataclasses.fields`, `replace`, `is_dataclass` know them), methods are
functions of the fields, and `__init__` is compiled for classes of which there are more than a few
instances. Frozen classes that inherit fields are left to the standard decorator.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from operator import attrgetter
from reprlib import recursive_repr
from typing import TYPE_CHECKING, Any, TypeVar

C = TypeVar("C", bound=type)
Fields = tuple[dataclasses.Field[Any], ...]
EARLY = 3  # instances of a class that are made without a constructor of its own: most have no more

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass  # to readers of types it is the same
else:

    def dataclass(*, frozen: bool = False, eq: bool = True) -> Callable[[C], C]:
        """Return `dataclasses.dataclass(frozen=frozen, eq=eq)`, which costs next to nothing."""

        def decorate(cls: C) -> C:
            # The standard one does not know that what it would make is not frozen only for now.
            inherits = frozen and any(map(dataclasses.is_dataclass, cls.__mro__[1:]))
            if inherits or (eq and not frozen):
                return dataclasses.dataclass(frozen=frozen, eq=eq)(cls)
            return _declared(cls, frozen, eq)

        return decorate


def _declared(cls: Any, frozen: bool, eq: bool) -> Any:
    cls.__doc__ = cls.__doc__ or cls.__name__  # or else its signature would be asked for
    dataclasses.dataclass(init=False, repr=False, eq=False)(cls)  # finds the fields, writes nothing
    says = cls.__dataclass_params__
    says.init, says.repr, says.eq, says.frozen = True, True, eq, frozen
    own = vars(cls)
    methods: dict[str, Any] = {"__repr__": _repr}
    if frozen:
        methods |= {"__setattr__": _set_one, "__delattr__": _delete}
    if "__init__" not in own:
        methods |= {"__init__": _first_init(cls), "__signature__": _Signature(cls)}
    if eq:
        methods |= _comparisons(cls)
        if own.get("__hash__") is None:  # as Python says where __eq__ stands alone
            cls.__hash__ = methods.pop("__hash__")
    for name, method in methods.items():
        if name not in own:
            setattr(cls, name, method)
    return cls


def _first_init(cls: Any) -> Callable[..., None]:
    left = EARLY

    def first(self: Any, /, *values: Any, **named: Any) -> None:
        nonlocal left
        left -= 1
        if left < 0 or not _bound(self, dataclasses.fields(cls), values, named):
            cls.__init__ = _init(cls)
            cls.__init__(self, *values, **named)

    return first


def _bound(self: Any, fields: Fields, values: tuple[Any, ...], named: dict[str, Any]) -> bool:
    """Do what a constructor does, but tell of arguments that do not fit by False."""
    names = [field.name for field in fields if field.init]
    given = dict(zip(names, values, strict=False)) | named
    if len(given) < len(values) + len(named):  # too many, or one given twice
        return False
    for field in fields:
        if field.init and field.name in given:
            value = given.pop(field.name)
        elif field.default_factory is not dataclasses.MISSING:
            value = field.default_factory()
        elif not field.init:
            continue
        elif (value := field.default) is dataclasses.MISSING:
            return False
        object.__setattr__(self, field.name, value)
    if given:  # unknown
        return False
    if hasattr(self, "__post_init__"):
        self.__post_init__()
    return True


def _init(cls: Any) -> Callable[..., None]:
    """Write and compile the constructor of a class."""
    fields: Fields = dataclasses.fields(cls)
    outside: dict[str, Any] = {
        "__set_field__": object.__setattr__,
        "__not_given__": dataclasses.MISSING,
    }
    arguments, lines = [], []
    for field in fields:
        name = value = field.name
        if field.default_factory is not dataclasses.MISSING:
            outside[f"__made_{name}__"] = field.default_factory
            value = f"__made_{name}__()"
            if field.init:
                arguments.append(f"{name}=__not_given__")
                value = f"{value} if {name} is __not_given__ else {name}"
        elif not field.init:
            continue
        elif field.default is not dataclasses.MISSING:
            outside[f"__default_{name}__"] = field.default
            arguments.append(f"{name}=__default_{name}__")
        else:
            arguments.append(name)
        lines.append(f"__set_field__(self, {name!r}, {value})")
    if hasattr(cls, "__post_init__"):
        lines.append("self.__post_init__()")
    text = f"def __init__({', '.join(['self', *arguments])}):\n "
    text += "\n ".join(lines or ["pass"])
    scope: dict[str, Any] = {}
    exec(text, outside, scope)
    init: Callable[..., None] = scope["__init__"]
    init.__qualname__ = f"{cls.__qualname__}.__init__"
    init.__module__ = cls.__module__
    init.__annotations__ = {f.name: f.type for f in fields if f.init} | {"return": None}
    return init


class _Signature:
    """The signature of a class for those who ask (`help`, editors), before its first instance."""

    def __init__(self, cls: type) -> None:
        self._cls = cls

    def __get__(self, instance: object, owner: Any) -> Any:
        from inspect import Signature, signature

        if owner is not self._cls:
            raise AttributeError("__signature__")
        _, *rest = signature(_init(owner)).parameters.values()
        return Signature(rest, return_annotation=None)


@recursive_repr()
def _repr(self: Any) -> str:
    shown = [f"{f.name}={getattr(self, f.name)!r}" for f in dataclasses.fields(self) if f.repr]
    return f"{self.__class__.__qualname__}({', '.join(shown)})"


def _comparisons(cls: Any) -> dict[str, Callable[..., Any]]:
    values = _values([field.name for field in dataclasses.fields(cls) if field.compare])

    def equal(self: Any, other: Any) -> Any:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return values(self) == values(other)

    def hashed(self: Any) -> int:
        return hash(values(self))

    return {"__eq__": equal, "__hash__": hashed}


def _values(names: list[str]) -> Callable[[Any], tuple[Any, ...]]:
    if len(names) > 1:
        return attrgetter(*names)
    return lambda instance: tuple(getattr(instance, name) for name in names)


def _set_one(self: Any, name: str, value: Any) -> None:
    if _is_field(self, name):
        raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")
    object.__setattr__(self, name, value)


def _delete(self: Any, name: str) -> None:
    if _is_field(self, name):
        raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")
    object.__delattr__(self, name)


def _is_field(self: Any, name: str) -> bool:
    """Whether an attribute is frozen: all but those that a class of one's own adds to a field's."""
    cls = type(self)
    return "__dataclass_fields__" in vars(cls) or name in cls.__dataclass_fields__
