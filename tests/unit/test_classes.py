"""Frozen dataclasses of the house against the standard ones, whose place they take."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
from collections.abc import Callable
from dataclasses import field
from typing import Any, Generic, TypeVar

import pytest

from ribbonopt import classes

T = TypeVar("T")
STANDARD = dataclasses.dataclass(frozen=True)
OURS = classes.dataclass(frozen=True)


def pair(make: Callable[[Any], Any]) -> tuple[Any, Any]:
    return make(OURS), make(STANDARD)


def points(decorate: Any) -> Any:
    @decorate
    class Point:
        """A point."""

        x: float
        y: float = 2.0
        tags: list[str] = field(default_factory=list)

    return Point


def lonely(decorate: Any) -> Any:
    @decorate
    class Lonely:
        value: Any

    return Lonely


def blank(decorate: Any) -> Any:
    @decorate
    class Blank:
        pass

    return Blank


def worked(decorate: Any) -> Any:
    @decorate
    class Worked:
        width: float
        area: float = field(default=0.0, init=False)
        kept: dict[str, int] = field(default_factory=dict, init=False, repr=False, compare=False)

        def __post_init__(self) -> None:
            object.__setattr__(self, "area", self.width**2)

    return Worked


def own(decorate: Any) -> Any:
    @decorate
    class Own:
        x: int

        def __repr__(self) -> str:
            return "own"

        def __eq__(self, other: object) -> bool:
            return True

    return Own


def generic(decorate: Any) -> Any:
    @decorate
    class Box(Generic[T]):
        _set: T
        self_: int = 1
        _missing: int = 2

    return Box


CALLS: list[tuple[Callable[[Any], Any], tuple[Any, ...], dict[str, Any]]] = [
    (points, (1.0,), {}),
    (points, (1.0, 3.0), {"tags": ["a"]}),
    (points, (), {"y": 0.0, "x": 5.0}),
    (lonely, (float("nan"),), {}),
    (blank, (), {}),
    (worked, (3.0,), {}),
    (own, (1,), {}),
    (generic, (1,), {"self_": 4}),
]


@pytest.mark.parametrize(("make", "values", "named"), CALLS)
def test_it_is_the_standard_one(make: Any, values: Any, named: Any) -> None:
    ours, standard = (cls(*values, **named) for cls in pair(make))
    assert repr(ours) == repr(standard)
    assert vars(ours) == vars(standard)
    assert list(vars(ours)) == list(vars(standard))
    for one in (ours, standard):
        cls = type(one)
        assert one == one
        assert one == cls(*values, **named)
        assert dataclasses.is_dataclass(one)
        assert cls.__dataclass_params__.frozen
    names = [[f.name for f in dataclasses.fields(one)] for one in (ours, standard)]
    assert names[0] == names[1]
    assert type(ours).__match_args__ == type(standard).__match_args__


@pytest.mark.parametrize("make", [points, lonely, blank, worked, own, generic])
def test_its_signature_is_told_before_an_instance_is_made(make: Any) -> None:
    ours, standard = pair(make)
    told = inspect.signature(ours)
    assert list(told.parameters) == list(inspect.signature(standard).parameters)
    for name, parameter in inspect.signature(standard).parameters.items():
        found = told.parameters[name]
        assert (found.annotation, found.kind) == (parameter.annotation, parameter.kind)
        assert (found.default is inspect.Parameter.empty) == (
            parameter.default is inspect.Parameter.empty
        )


def test_a_subclass_with_a_constructor_of_its_own_tells_its_own() -> None:
    class Sub(points(OURS)):  # type: ignore[misc]
        def __init__(self, radius: float) -> None:
            super().__init__(radius, radius)

    assert list(inspect.signature(Sub).parameters) == ["radius"]
    assert Sub(2.0).y == 2.0
    assert Sub(2.0) == Sub(2.0)
    assert Sub(2.0) != points(OURS)(2.0, 2.0)


@pytest.mark.parametrize("arguments", [((), {}), ((1, 2, [], 4), {}), ((1,), {"z": 1})])
def test_wrong_arguments_are_refused(arguments: Any) -> None:
    values, named = arguments
    for cls in pair(points):
        with pytest.raises(TypeError):
            cls(*values, **named)


@pytest.mark.parametrize("decorate", [OURS, STANDARD])
def test_nothing_of_it_changes(decorate: Any) -> None:
    point = points(decorate)(1.0)
    for name in ("x", "other"):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(point, name, 2.0)
        with pytest.raises(dataclasses.FrozenInstanceError):
            delattr(point, name)
    assert point.x == 1.0


@pytest.mark.parametrize("decorate", [OURS, STANDARD])
def test_a_subclass_may_add_what_is_no_field(decorate: Any) -> None:
    class Sub(points(decorate)):  # type: ignore[misc]
        pass

    sub = Sub(1.0)
    sub.more = 3
    del sub.more
    with pytest.raises(dataclasses.FrozenInstanceError):
        sub.x = 2.0


@pytest.mark.parametrize("decorate", [OURS, STANDARD])
def test_fields_are_inherited(decorate: Any) -> None:
    @decorate
    class Solid(points(decorate)):  # type: ignore[misc]
        z: float = 9.0

    assert repr(Solid(1.0)).endswith("Solid(x=1.0, y=2.0, tags=[], z=9.0)")
    with pytest.raises(dataclasses.FrozenInstanceError):
        Solid(1.0).z = 1.0


def test_the_standard_decorator_may_follow_upon_ours() -> None:
    @STANDARD
    class Solid(points(OURS)):  # type: ignore[misc]
        z: float = 9.0

    assert Solid(1.0) == Solid(1.0, 2.0, [], 9.0)


def test_hashes_follow_equality() -> None:
    lonely_ours, lonely_standard = pair(lonely)
    assert hash(lonely_ours(3)) == hash(lonely_ours(3)) == hash(lonely_standard(3))
    for cls in (points(OURS), points(STANDARD)):
        with pytest.raises(TypeError, match="unhashable"):
            hash(cls(1.0))  # it holds a list
    ours, standard = pair(own)
    assert hash(ours(2)) == hash(standard(2))


def test_without_equality_it_is_compared_by_identity() -> None:
    for decorator in (classes.dataclass, dataclasses.dataclass):
        cls = lonely(decorator(frozen=True, eq=False))
        one = cls(1)
        assert one != cls(1)
        assert hash(one) == object.__hash__(one)


def test_defaults_made_anew_are_not_shared() -> None:
    cls = points(OURS)
    one, other = cls(1.0), cls(1.0)
    one.tags.append("mine")
    assert other.tags == []


def test_copies_and_replacements() -> None:
    point = points(OURS)(1.0, tags=["a"])
    assert copy.copy(point) == point
    deep = copy.deepcopy(point)
    assert deep == point
    assert deep.tags is not point.tags
    assert dataclasses.replace(point, y=5.0) == points_like(point, 5.0)
    assert dataclasses.asdict(point) == {"x": 1.0, "y": 2.0, "tags": ["a"]}


def points_like(point: Any, y: float) -> Any:
    return type(point)(point.x, y, point.tags)


@classes.dataclass(frozen=True)
class Packed:
    """What is pickled has to have a name that can be found."""

    x: float
    inner: Packed | None = None


def test_it_is_packed_and_unpacked() -> None:
    packed = pickle.dumps(Packed(1.0, Packed(2.0)))
    assert pickle.loads(packed) == Packed(1.0, Packed(2.0))


def test_what_holds_itself_is_shown() -> None:
    shown = []
    for cls in pair(points):
        point = cls(1.0)
        point.tags.append(point)
        shown.append(repr(point))
    assert shown[0] == shown[1]


def test_what_changes_changes() -> None:
    for decorator in (classes.dataclass, dataclasses.dataclass):
        cls = points(decorator(eq=False))
        point = cls(1.0)
        point.x = 2.0
        del point.y
        assert point.x == point.y == 2.0  # y is that of the class
        assert not cls.__dataclass_params__.frozen
        assert hash(point) == object.__hash__(point)
    with pytest.raises(TypeError, match="unhashable"):
        hash(lonely(classes.dataclass())(1))


def test_what_changes_is_inherited() -> None:
    base = points(classes.dataclass(eq=False))

    @classes.dataclass(eq=False)
    class Solid(base):  # type: ignore[misc, valid-type]
        z: float = 9.0

    solid = Solid(1.0)
    solid.z = 1.0
    assert vars(solid) == {"x": 1.0, "y": 2.0, "tags": [], "z": 1.0}
