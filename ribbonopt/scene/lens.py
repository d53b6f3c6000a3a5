"""Single numbers of a scene by dotted path: which there are, what they are, and to replace one.

A path leads through fields and parameters by name, through vectors by x, y, z, through the triples
of a law, which are along directors, by d1, d2, d3, and through the interval by start, end (through
any list by index as well), such as `boundary.end.position.x` or `law.natural.d3`. Only
numbers of the ribbon that may vary continuously are offered: no whole numbers, no settings of the
computation.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from functools import cache
from numbers import Real
from typing import Annotated, Any, NamedTuple, get_args, get_origin

from ribbonopt.errors import SceneError

from .along import Table
from .faults import KeyPath, dotted, nearest
from .model import Scene
from .schema.annotations import branches, hints
from .wording import listed

_ROOTS: tuple[KeyPath, ...] = (
    ("law",),
    ("interval",),
    ("parameters",),
    ("boundary", "start"),
    ("boundary", "end"),
    ("loads",),
    ("gravity",),
    ("supports",),
    ("ribbon",),
    ("natural",),
    ("width",),
    ("membrane",),
)
_ITEMS = {2: ("start", "end"), 3: ("x", "y", "z")}
_OF_LAWS = {3: ("d1", "d2", "d3")}
_MOST_LISTED = 8
_WORD = re.compile(r"[A-Za-z_]\w*")


class _Part(NamedTuple):
    """What a path leads to: the steps to it, the value, and whether its place takes any number.

    `tabled` says that it is in a table, which no number of it changes continuously.
    """

    steps: KeyPath
    value: Any
    varies: bool
    tabled: bool = False


def value_at(scene: Scene, path: str) -> float:
    """Return the number at a path, in the units of the scene.

    Raises
    ------
    SceneError
        If no number is there that can be continued; says what is there and what to do.
    """
    return float(_number(scene, path).value)


def steps_to(scene: Scene, path: str) -> KeyPath:
    """Return the steps to the number at a path, as `replaced` takes them; SceneError as above."""
    return _number(scene, path).steps


def with_value(scene: Scene, path: str, value: float) -> Scene:
    """Return the scene with another number at a path; nothing is validated.

    Raises
    ------
    SceneError
        As `value_at` does.
    """
    changed: Scene = replaced(scene, steps_to(scene, path), float(value))
    return changed


def paths_of(scene: Scene) -> list[str]:
    """Return the paths of all numbers that can be continued."""
    parts = ((root, _part(scene, root)) for root in _ROOTS)
    return [
        path for root, part in parts if part for path in _numbers(part.value, part.varies, root)
    ]


def fault_of(scene: Scene, path: str) -> str:
    """Return why a path leads to no number that can be continued and what to do; "" if it does."""
    keys = tuple(path.split("."))
    part = _part(scene, keys)
    if part is None or not (_ours(part) or _is_real(part.value)):
        return f"{path!r} is no number of this scene{_meant(path, paths_of(scene))}"
    if _continues(part):
        return ""
    if part.tabled:
        instead = "write a formula of s and parameters, and continue one of those"
        return f"{path!r} is a table, which is not continued; {instead}"
    if _is_real(part.value):
        kind = "a setting of the computation" if part.varies else "a whole number"
        return f"{path!r} is {kind}, which is not continued{_some(paths_of(scene))}"
    if part.value is None:
        missing = dotted(keys[: len(part.steps)])
        return f"{path!r} has no value: {missing} is not given; give it the number to begin with"
    if part.varies and isinstance(part.value, str):
        return f"{path!r} is the formula {part.value!r}{_instead(part.value, scene)}"
    return f"{path!r} is no number of this scene{_meant(path, paths_of(scene))}"


def _number(scene: Scene, path: str) -> _Part:
    part = _part(scene, tuple(path.split(".")))
    if part is None or not _continues(part):
        raise SceneError(f"continuation.parameter: {fault_of(scene, path)}")
    return part


def _continues(part: _Part) -> bool:
    return part.varies and not part.tabled and _is_real(part.value) and _ours(part)


def _ours(part: _Part) -> bool:
    return any(part.steps[: len(root)] == root for root in _ROOTS)


def _part(scene: Scene, keys: KeyPath) -> _Part | None:
    """Follow a path as far as something is given; None where it leads nowhere."""
    holder: Any = None
    value: Any = scene
    steps: KeyPath = ()
    tabled = False
    for key in keys:
        if value is None:
            break
        step = _step(value, str(key), steps)
        if step is None:
            return None
        holder, steps = value, (*steps, step)
        value = getattr(value, str(step)) if is_dataclass(value) else value[step]
        tabled = tabled or isinstance(value, Table)
    return _Part(steps, value, _varies(holder, steps[-1]), tabled)


def _step(holder: Any, key: str, path: KeyPath) -> str | int | None:
    """Return the name or index that a key means inside a value; None where it means nothing."""
    if is_dataclass(holder):
        return key if any(member.name == key for member in fields(holder)) else None
    if isinstance(holder, dict):
        return key if key in holder else None
    if not isinstance(holder, tuple | list):
        return None
    names = _names(holder, path)
    if key in names:
        return names.index(key)
    return int(key) if key in map(str, range(len(holder))) else None


def _names(items: Any, path: KeyPath) -> tuple[str, ...]:
    """Return the names of the items of a list at a path."""
    known = _OF_LAWS if path[:1] == ("law",) else _ITEMS
    named = () if any(map(is_dataclass, items)) else known.get(len(items), ())
    return named or tuple(map(str, range(len(items))))


def _varies(holder: Any, step: str | int) -> bool:
    """Whether any number may stand at a place, not only a whole one or one of a choice."""
    cls: type = type(holder)
    return _takes_floats(cls, str(step)) if is_dataclass(holder) else True


@cache
def _takes_floats(cls: type, name: str) -> bool:
    annotation = hints(cls).get(name)
    options = list(branches(annotation).values()) or [annotation]
    plain = [get_args(some)[0] if get_origin(some) is Annotated else some for some in options]
    return float in plain


def _is_real(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _numbers(value: Any, varies: bool, path: KeyPath) -> Iterator[str]:
    """Yield the paths of the numbers that vary inside a value."""
    if isinstance(value, Table):
        return
    if is_dataclass(value):
        for name in (member.name for member in fields(value)):
            yield from _numbers(getattr(value, name), _varies(value, name), (*path, name))
    elif isinstance(value, dict):
        for name, item in value.items():
            if "." not in name:  # the names of units are no path
                yield from _numbers(item, True, (*path, name))
    elif isinstance(value, tuple | list):
        for name, item in zip(_names(value, path), value, strict=True):
            yield from _numbers(item, True, (*path, name))
    elif varies and _is_real(value):
        yield dotted(path)


def replaced(holder: Any, steps: KeyPath, value: Any) -> Any:
    """Return a value with another put in its place inside it, all else as it was."""
    if not steps:
        return value
    step, *rest = steps
    if isinstance(holder, dict):
        return {**holder, step: replaced(holder[step], tuple(rest), value)}
    if isinstance(step, int):
        inner = replaced(holder[step], tuple(rest), value)
        return (*holder[:step], inner, *holder[step + 1 :])
    return replace(holder, **{step: replaced(getattr(holder, step), tuple(rest), value)})


def _instead(formula: str, scene: Scene) -> str:
    """Say what to continue in place of a formula."""
    used = [f"parameters.{word}" for word in _WORD.findall(formula) if word in scene.parameters]
    if not used:
        return ", which no parameter changes; write it as a number"
    return f" of {listed(dict.fromkeys(used))}: continue that instead"


def _meant(path: str, known: list[str]) -> str:
    """Say which number an unknown path was probably meant to lead to."""
    if below := [name for name in known if name.startswith(f"{path}.")]:
        return _some(below)
    near = nearest(path, known)
    return f"; did you mean {near}?" if near else _some(known)


def _some(known: list[str]) -> str:
    if not known:
        return "; it has none"
    more = ["..."] if len(known) > _MOST_LISTED else []
    return f"; expected {listed([*known[:_MOST_LISTED], *more], 'or')}"
