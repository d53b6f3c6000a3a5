"""Overrides of single values of a scene, such as `law.epsilon=1e-3`.

A dotted path leads through mappings and list indices; the value is read as YAML.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import Any

from ribbonopt.classes import dataclass
from ribbonopt.errors import SceneError
from ribbonopt.scene.faults import KeyPath, Place, Problem, dotted, quotable, shown

from .yamltext import PlainData, YamlTextError, plain_number, read

Reader = Callable[[str], PlainData]
Kind = tuple[tuple[str, str | None], ...]


@dataclass(frozen=True)
class Overridden:
    """Plain data with other values put in.

    Attributes
    ----------
    data
        What the scene says now; all that was not on the way to a new value is the file's own.
    problems : list of Problem
        Faults of the file, and of the new values.
    put : list of tuples
        The path of each new value, list indices as numbers, and the override that said it.
    """

    data: Any
    problems: list[Problem]
    put: Sequence[tuple[KeyPath, str]]
    _written: Mapping[KeyPath, Place]

    @cached_property
    def places(self) -> dict[KeyPath, Place]:
        """Where values were written, by path: only messages ask for that."""
        places = dict(self._written)
        for steps, text in self.put:
            count = len(steps)
            places = {known: place for known, place in places.items() if known[:count] != steps}
            for length in range(1, count + 1):
                places.setdefault(steps[:length], Place(override=text))
        return places


def override(scene: PlainData, overrides: Sequence[str], read: Reader = read) -> Overridden:
    """Return plain data with values replaced, each remembering the override it came from.

    Parameters
    ----------
    scene
        What the file says, which stays as it is.
    overrides
        Texts of the form `path=value`, applied in turn. Mappings missing on the way are made.
    read
        Reads the values that are no plain numbers; one that remembers them saves time.

    Raises
    ------
    SceneError
        If a text has not that form, or its path leads through something that has no keys.
    """
    data, problems = scene.data, list(scene.problems)
    put: list[tuple[KeyPath, str]] = []
    for text in overrides:
        path, value, faults = _parse(text, read)
        data, steps = _with(data, path, value, text)
        put.append((steps, text))
        problems += [fault._replace(path=steps + fault.path) for fault in faults]
    return Overridden(data, problems, put, scene.places)


def numbers_of(overrides: Sequence[str]) -> tuple[Kind, list[int | float]]:
    """Return the plain numbers among values, and all the rest that overrides say."""
    kind: list[tuple[str, str | None]] = []
    numbers: list[int | float] = []
    for text in overrides:
        key, equals, value = text.partition("=")
        number = plain_number(value) if equals else None
        kind.append((key, None) if number is not None else (key + equals, value))
        if number is not None:
            numbers.append(number)
    return tuple(kind), numbers


def _parse(text: str, read: Reader) -> tuple[list[str], Any, Sequence[Problem]]:
    key, equals, value = text.partition("=")
    path = key.strip().split(".")
    if not equals or not all(path):
        raise SceneError(f"--set {quotable(text)}: expected path=value, such as law.epsilon=1e-3")
    try:
        key.encode()
        number = plain_number(value)  # as of most rows of a study
        if number is not None:
            return path, number, ()
        found = read(value)
        return path, found.data, found.problems
    except UnicodeEncodeError:
        raise SceneError(f"--set {quotable(text)}: the key is no text in UTF-8") from None
    except YamlTextError as error:
        raise SceneError(f"--set {quotable(text)}: the value is {error}") from None


def _with(data: Any, path: Sequence[str], value: Any, text: str) -> tuple[Any, KeyPath]:
    """Return data with a value put at a path, and the path with its list indices as numbers.

    What is on the way is copied, all else is shared.
    """
    steps: KeyPath = ()
    changed = holder = _copy(data)
    for depth, name in enumerate(path):
        step = _step(holder, name, steps, text)
        steps = (*steps, step)
        if depth == len(path) - 1:
            holder[step] = value
        else:
            # An empty key (`boundary:`) is a mapping not yet begun.
            empty = isinstance(holder, dict) and holder.get(name) is None
            holder[step] = {} if empty else _copy(holder[step])
            holder = holder[step]
    return changed, steps


def _copy(data: Any) -> Any:
    return data.copy() if isinstance(data, dict | list) else data


def _step(holder: Any, name: str, steps: KeyPath, text: str) -> str | int:
    where, said = quotable(dotted(steps)) or "the scene", quotable(text)
    if isinstance(holder, dict):
        return name
    if isinstance(holder, list):
        if name.isascii() and name.isdigit() and int(name[:9]) < len(holder):
            return int(name)
        raise SceneError(
            f"--set {said}: {where} is a list of {len(holder)} items; "
            f"found {shown(name)}, expected an index from 0 to {len(holder) - 1}"
        )
    raise SceneError(f"--set {said}: {where} is {shown(holder)}, which has no key {shown(name)}")
