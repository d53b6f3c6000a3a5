"""A text that says a scene, read once: a scene for each set of overrides, in numbers only or more.

What is written is parsed, and refused, once; each scene is validated as if it stood alone.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

from ribbonopt.errors import SceneError

from .along import TableFile, numbers_along
from .checks.whole import check
from .ends import Boundary
from .faults import InvalidSceneError, Problem, nearest, report
from .laws import Sadowsky
from .model import Scene
from .schema.annotations import written_keys
from .schema.validation import validate
from .text.yamltext import PlainData, YamlTextError, read

if TYPE_CHECKING:
    from .text.overrides import Overridden

LOOKED_AT, LONGEST = 20, 100  # keys that may be misspelt, of a file that may have any; letters
REMEMBERED = 64  # values of overrides that are no numbers, which rows of a study share


class Document:
    """YAML text of a scene; `source` names it in messages, and the folder of its tables."""

    def __init__(self, text: str, source: str = "<string>") -> None:
        """Read the text; SceneError if it says no scene."""
        self.text, self.source = text, source
        try:
            self._written = read(text)
        except YamlTextError as error:
            where = f"{source}, line {error.line}" if error.line else source
            raise SceneError(f"{where}: {error}") from None
        data = self._written.data
        if data is None:
            raise SceneError(f"{source}: is empty; expected a scene with name, law, boundary")
        if not isinstance(data, dict):
            kind = "a list" if isinstance(data, list) else "a single value"
            raise SceneError(f"{source}: is {kind}; expected keys such as name, law, boundary")
        refuse_foreign(self._written, source, written_keys(Scene))
        self._read = lru_cache(REMEMBERED)(read)

    def scene(self, overrides: Sequence[str] = ()) -> Scene:
        """Return the scene that it says with some values in place of its own.

        Raises
        ------
        SceneError
            For all problems of the scene together, each with its line or its override.
        """
        plain: PlainData | Overridden = self._written
        if overrides:
            from .text.overrides import override  # only scenes that are overridden pay for it

            plain = override(self._written, overrides, self._read)
        try:
            scene = validated(plain.data, os.path.dirname(self.source))
        except InvalidSceneError as error:
            problems = [*plain.problems, *error.problems]
            raise SceneError(report(self.source, problems, plain.places)) from None
        if plain.problems:
            raise SceneError(report(self.source, plain.problems, plain.places))
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


def validated(data: object, folder: str = "") -> Scene:
    """Return a checked scene; `folder` is what the paths of its tables are relative to.

    Parameters
    ----------
    data
        What a file says, as plain data, or a scene built in Python.

    Raises
    ------
    InvalidSceneError
        With all problems of the scene, each at its path.
    """
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
