"""Overrides of single values of a scene, such as `law.epsilon=1e-3`.

A dotted path leads through mappings and list indices; the value is read as YAML.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ribbonopt.errors import SceneError
from ribbonopt.scene.faults import KeyPath, Place, dotted, quotable, shown

from .yamltext import PlainData, YamlTextError, read


def override(scene: PlainData, overrides: Sequence[str]) -> PlainData:
    """Return plain data with values replaced, each remembering the override it came from.

    Parameters
    ----------
    scene
        What the file says; its data are changed in place.
    overrides
        Texts of the form `path=value`, applied in turn. Mappings missing on the way are made.

    Raises
    ------
    SceneError
        If a text has not that form, or its path leads through something that has no keys.
    """
    places = dict(scene.places)
    problems = list(scene.problems)
    for text in overrides:
        path, value = _parse(text)
        steps = _put(scene.data, path, value.data, text)
        places = {known: place for known, place in places.items() if known[: len(steps)] != steps}
        for length in range(1, len(steps) + 1):
            places.setdefault(steps[:length], Place(override=text))
        problems += [fault._replace(path=steps + fault.path) for fault in value.problems]
    return PlainData(scene.data, places, problems)


def _parse(text: str) -> tuple[list[str], PlainData]:
    key, equals, value = text.partition("=")
    path = key.strip().split(".")
    if not equals or not all(path):
        raise SceneError(f"--set {quotable(text)}: expected path=value, such as law.epsilon=1e-3")
    try:
        key.encode()
        return path, read(value)
    except UnicodeEncodeError:
        raise SceneError(f"--set {quotable(text)}: the key is no text in UTF-8") from None
    except YamlTextError as error:
        raise SceneError(f"--set {quotable(text)}: the value is {error}") from None


def _put(data: Any, path: list[str], value: Any, text: str) -> KeyPath:
    """Put a value at a path and return the path with its list indices as numbers."""
    steps: KeyPath = ()
    holder = data
    for depth, name in enumerate(path):
        step = _step(holder, name, steps, text)
        steps = (*steps, step)
        if depth == len(path) - 1:
            holder[step] = value
        else:
            # An empty key (`boundary:`) is a mapping not yet begun.
            if isinstance(holder, dict) and holder.get(name) is None:
                holder[name] = {}
            holder = holder[step]
    return steps


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
