"""Faults of what a scene says of the search for all its equilibria."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from ribbonopt.scene.equilibria import Equilibria
from ribbonopt.scene.faults import InvalidSceneError, KeyPath, Problem, dotted
from ribbonopt.scene.lens import fault_of, value_at, with_value
from ribbonopt.scene.model import Scene
from ribbonopt.scene.schema.validation import validate
from ribbonopt.scene.wording import written

Check = Callable[[Scene], list[Problem]]


def check_equilibria(scene: Scene, asked: Equilibria, check: Check | None) -> Iterator[Problem]:
    """Yield what is wrong with the numbers that move in a search, and with their ranges.

    Parameters
    ----------
    scene
        A scene whose single values are valid.
    asked
        What it says of the search.
    check
        How to check the scenes at the ends of ranges; None where the rest is not sound.
    """
    paths = list(asked.along)
    for number, path in enumerate(paths):
        key = path if isinstance(asked.along, dict) else number
        where: KeyPath = ("equilibria", "along", key)
        if fault := fault_of(scene, path):
            yield Problem(where, fault)
        elif path in paths[:number]:
            yield Problem(where, "stands there twice; remove one of the two", repr(path))
        elif range_ := asked.ranges[path]:
            yield from _range(scene, path, range_, where, check)


def _range(
    scene: Scene, path: str, range_: tuple[float, float], where: KeyPath, check: Check | None
) -> Iterator[Problem]:
    own, (low, high) = value_at(scene, path), range_
    if not low < own < high:
        message = f"expected one value below and then one above the scene's own {path}, {own:g}"
        yield Problem(
            where, f"{message}; write for example [{own - 1:g}, {own + 1:g}]", written(range_)
        )
        return
    for index, value in enumerate(range_ if check else ()):
        trial = replace(with_value(scene, path, value), continuation=None, equilibria=None)
        try:
            problems = check(validate(Scene, trial)) if check else []
        except InvalidSceneError as error:
            problems = list(error.problems)
        for problem in problems:
            message = "which makes no valid scene; choose another value: "
            yield Problem(
                (*where, index), f"{message}{dotted(problem.path)}: {problem}", f"{value:g}"
            )
