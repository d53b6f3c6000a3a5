"""Scenes in and out: YAML files with line numbers in every message, and the JSON schema."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from ribbonopt.errors import SceneError
from ribbonopt.reading import MEGA, Kind, read_text

from .along import TableFile, numbers_along
from .checks.whole import check
from .ends import Boundary
from .faults import InvalidSceneError, Problem, nearest, report
from .laws import Sadowsky
from .model import Scene
from .schema.annotations import written_keys
from .schema.validation import validate
from .supports import SUPPORTS
from .text.yamltext import PlainData, YamlTextError, read

#: what scenes, and studies of them, are read from; a megabyte holds thousands of them
SCENE = Kind("a scene file", most=10 * MEGA, error=SceneError, piped=True)
LOOKED_AT, LONGEST = 20, 100  # keys that may be misspelt, of a file that may have any; letters


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
    if overrides:
        from .text.overrides import override

        plain = override(plain, overrides)
    parts = tuple(int(part) if part.isdigit() else part for part in key.split("."))
    for length in range(len(parts), 0, -1):
        if parts[:length] in plain.places:
            return str(plain.places[parts[:length]])
    return ""


def loads_scene(text: str, source: str = "<string>", overrides: Sequence[str] = ()) -> Scene:
    """Read a scene from YAML text; `source` names it in messages, and the folder of its tables."""
    try:
        written = read(text)
    except YamlTextError as error:
        where = f"{source}, line {error.line}" if error.line else source
        raise SceneError(f"{where}: {error}") from None
    if written.data is None:
        raise SceneError(f"{source}: is empty; expected a scene with name, law, boundary")
    if not isinstance(written.data, dict):
        kind = "a list" if isinstance(written.data, list) else "a single value"
        raise SceneError(f"{source}: is {kind}; expected keys such as name, law, boundary")
    refuse_foreign(written, source, written_keys(Scene))
    plain = written
    if overrides:
        from .text.overrides import override  # only scenes that are overridden pay for it

        plain = override(written, overrides)
    try:
        scene = _validated(plain.data, os.path.dirname(source))
    except InvalidSceneError as error:
        problems = [*plain.problems, *error.problems]
        raise SceneError(report(source, problems, plain.places)) from None
    if plain.problems:
        raise SceneError(report(source, plain.problems, plain.places))
    return scene


def refuse_foreign(found: PlainData, source: str, known: Sequence[str]) -> None:
    """Refuse what has no key that it might have: no message is to quote what is no scene.

    Raises
    ------
    SceneError
        If all keys are foreign, and none is a known one misspelt.
    """
    keys = list(found.data) if isinstance(found.data, dict) else []
    if any(key in known for key in keys) or not (keys or found.problems):
        return
    if not any(nearest(key[:LONGEST], known) for key in keys[:LOOKED_AT]):
        raise SceneError(
            f"{source}: is no scene, none of its keys is one of a scene; expected keys such as "
            "name, law, boundary"
        )


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
        return _validated(scene)
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


def _validated(data: object, folder: str = "") -> Scene:
    """Return a checked scene; `folder` is what the paths of its tables are relative to."""
    try:
        scene = validate(Scene, data)
    except InvalidSceneError as error:
        raise InvalidSceneError([*error.problems, *_further(data, error.problems)]) from None
    if isinstance(data, dict) and "interval" not in data and scene.ribbon is not None:
        scene = replace(scene, interval=scene.ribbon.interval(scene.boundary.loop))
    if any(isinstance(value, TableFile) for _, value in numbers_along(scene)):
        from .tables import embedded  # few scenes have any

        scene, faults = embedded(scene, folder)
        if faults:
            raise InvalidSceneError(faults)
    if problems := check(scene):
        raise InvalidSceneError(problems)
    return scene


def _further(data: object, problems: Sequence[Problem]) -> list[Problem]:
    """Return what is wrong with the sound parts of a scene whose other parts are not."""
    if not isinstance(data, dict):
        return []
    faulty = {problem.path[0] for problem in problems}
    if "parameters" in faulty:
        faulty |= {"boundary", "guess", "width"}  # their formulas would seem to use unknown names
    if "interval" in faulty:
        faulty |= {"ribbon", "width"}  # which would seem not to be as long as the default
    parts = {"interval", "parameters", "boundary", "guess", "ribbon", "width", "law"} - faulty
    sound = {key: value for key, value in data.items() if key in parts}
    blank = {"name": "scene", "law": Sadowsky(), "boundary": Boundary()}
    found = check(validate(Scene, blank | sound))
    # Of a law that is not known here, or whose ribbon is not, nothing is said.
    return [
        problem
        for problem in found
        if not ("law" in faulty and problem.path[-1:] == ("edge",))
        and not ("ribbon" in faulty and problem.path[:1] == ("law",))
    ]
