"""Scenes in and out: YAML files with line numbers in every message, and the JSON schema."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from ribbonopt.errors import SceneError
from ribbonopt.reading import MEGA, Kind, read_text

from .document import Document, refuse_foreign
from .faults import InvalidSceneError, report
from .model import Scene
from .supports import SUPPORTS
from .text.yamltext import PlainData, YamlTextError, read
from .validated import validated

#: what scenes, and studies of them, are read from; a megabyte holds thousands of them
SCENE = Kind("a scene file", most=10 * MEGA, error=SceneError, piped=True)


def load_scene(path: str | os.PathLike[str], overrides: Sequence[str] = ()) -> Scene:
    """Read a scene file.

    Parameters
    ----------
    path
        A YAML file in UTF-8.
    overrides
        Values to put in place of those of the file, such as "law.epsilon=1e-3".

    Returns
    -------
    Scene
        The validated scene. Relative paths in it stay as they are written, but tables that it
        names by their files, from its folder, are read and stand in it as numbers.

    Raises
    ------
    SceneError
        If the file cannot be read, or for all problems of the scene together, each with its line.
    """
    return loads_scene(read_text(path, SCENE), os.fspath(path), overrides)


def locate(path: str | os.PathLike[str], overrides: Sequence[str], key: str) -> str:
    """Say where a key of a readable scene was written.

    Parameters
    ----------
    path, overrides
        As `load_scene` was given them.
    key
        Dotted path, such as "boundary.end.d1"; the nearest key above it stands in for one that was
        not written.

    Returns
    -------
    str
        "line 7", "--set boundary.end.d1=...", or "" where nothing of it was written, or the file
        can be read only once.
    """
    try:
        plain = read(read_text(path, replace(SCENE, piped=False)))
    except SceneError:
        return ""
    places = plain.places
    if overrides:
        from .text.overrides import override

        places = override(plain, overrides).places
    parts = tuple(int(part) if part.isdigit() else part for part in key.split("."))
    for length in range(len(parts), 0, -1):
        if parts[:length] in places:
            return str(places[parts[:length]])
    return ""


def loads_scene(text: str, source: str = "<string>", overrides: Sequence[str] = ()) -> Scene:
    """Read a scene from YAML text; `source` names it in messages, and the folder of its tables."""
    return Document(text, source).scene(overrides)


def plain_yaml(text: str, source: str) -> Any:
    """Read YAML text as plain data; `source` names it in the SceneError of what is no YAML."""
    return read_yaml(text, source).data


def read_yaml(text: str, source: str, known: Sequence[str] = ()) -> PlainData:
    """Read YAML text as plain data with the places of its values; see `plain_yaml`.

    `known` are keys of which it should have one, see `refuse_foreign`.
    """
    try:
        found = read(text)
    except YamlTextError as error:
        where = f"{source}, line {error.line}" if error.line else source
        raise SceneError(f"{where}: {error}") from None
    if found.problems:
        if known:
            refuse_foreign(found, source, known)
        raise SceneError(report(source, found.problems, found.places))
    return found


def validate_scene(scene: Scene) -> Scene:
    """Check a scene built in Python as strictly as one read from a file.

    Returns
    -------
    Scene
        An equal scene, with tuples in place of lists and floats in place of whole numbers.

    Raises
    ------
    SceneError
        For all problems of the scene together, each with the path of its field.
    """
    try:
        return validated(scene)
    except InvalidSceneError as error:
        raise SceneError(report("scene", error.problems, {})) from None


def dump_scene(scene: Scene) -> str:
    """Write a scene as YAML text that loads back to an equal scene.

    Fields equal to their default are left out, except the law and every `type`.
    """
    from .text.dump import dump  # needed by no other function

    return dump(validate_scene(scene))


def unsayable(scene: Scene) -> str:
    """Return why no file can say a scene: what of it is declared in Python; "" where one can."""
    from .text import dump  # as above

    return dump.unsayable(scene)


def json_schema() -> dict[str, Any]:
    """Return the JSON schema of scene files, for editors to complete and check them."""
    from .schema.json_schema import json_schema_of  # only editors want it

    schema = json_schema_of(Scene)
    for end in ("start", "end"):
        keys = schema["properties"]["boundary"]["properties"][end]["properties"]
        keys["support"]["description"] = "\n".join(f"{s.name}: {s.says}" for s in SUPPORTS.values())
    return schema
