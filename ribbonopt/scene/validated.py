"""From plain data to a scene that is sound: single values, what follows from them, the whole."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from .along import TableFile, numbers_along
from .checks.whole import check
from .ends import Boundary
from .faults import InvalidSceneError, Problem
from .laws import Sadowsky
from .model import Scene
from .schema.validation import validate


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
    scene = completed(as_written(data), says_interval(data), folder)
    if problems := check(scene):
        raise InvalidSceneError(problems)
    return scene


def as_written(data: object) -> Scene:
    """Return the scene that plain data say, each value sound by itself; or InvalidSceneError."""
    try:
        return validate(Scene, data)
    except InvalidSceneError as error:
        raise InvalidSceneError([*error.problems, *_further(data, error.problems)]) from None


def says_interval(data: object) -> bool:
    """Whether the interval of a scene is said, so that it does not follow from its ribbon."""
    return not isinstance(data, dict) or "interval" in data


def completed(scene: Scene, told: bool, folder: str) -> Scene:
    """Return a scene with its tables in it, and with the interval of its ribbon unless `told`."""
    if not told and scene.ribbon is not None:
        scene = replace(scene, interval=scene.ribbon.interval(scene.boundary.loop))
    if any(isinstance(value, TableFile) for _, value in numbers_along(scene)):
        from .tables import embedded  # few scenes have any

        scene, faults = embedded(scene, folder)
        if faults:
            raise InvalidSceneError(faults)
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
