"""Faults of a map: its two numbers, their ranges, and what lies outside of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

from ribbonopt.scene.faults import InvalidSceneError, KeyPath, Problem, dotted
from ribbonopt.scene.lens import fault_of, steps_to, with_value
from ribbonopt.scene.maps import MapPlan
from ribbonopt.scene.model import Scene
from ribbonopt.scene.schema.validation import validate
from ribbonopt.scene.wording import written

from .continuation import Check

ROOT: KeyPath = ("map",)
EXAMPLE = '"parameters: {parameters.angle: [0, 60], parameters.distance: [0.05, 0.4]}"'


def check_map(scene: Scene, plan: MapPlan, check: Check | None) -> list[Problem]:
    """Return what is wrong with a map.

    Parameters
    ----------
    scene, plan
        A scene whose single values are valid, and its map.
    check
        How to check the scenes at the corners of the map; None where all the rest of this scene is
        not sound, so that they would tell nothing.
    """
    problems = list(_numbers(scene, plan))
    if problems:
        return problems
    problems = [*_places(plan), *_kinds(plan)]
    if check and not problems:
        problems += _corners(scene, plan, check)
    return problems


def _numbers(scene: Scene, plan: MapPlan) -> Iterator[Problem]:
    where: KeyPath = (*ROOT, "parameters")
    if len(plan.parameters) != 2:
        names = ", ".join(plan.parameters) or "none"
        message = f"expected two numbers of the scene, each with its range, such as {EXAMPLE}"
        yield Problem(where, message, names)
        return
    faults = {path: fault for path in plan.parameters if (fault := fault_of(scene, path))}
    for path, fault in faults.items():
        yield Problem((*where, path), fault)
    if not faults and steps_to(scene, plan.x) == steps_to(scene, plan.y):
        message = "are the same number; expected two that differ, one for each direction of the map"
        yield Problem(where, message, f"{plan.x} and {plan.y}")
    for path, (low, high) in plan.parameters.items():
        if not low < high:
            message = "expected a range from a smaller to a larger number; write for example "
            example = [high, low] if high < low else [low, low + 1]
            yield Problem(
                (*where, path), f'{message}"[{example[0]:g}, {example[1]:g}]"', written((low, high))
            )


def _places(plan: MapPlan) -> Iterator[Problem]:
    """Yield what lies outside of the ranges, or is said twice."""
    if plan.lines == () and not plan.across:
        message = "expected at least one value, at which branches are followed; or leave it out"
        yield Problem((*ROOT, "lines"), message)
    for key, values, path in (("lines", plan.lines or (), plan.y), ("across", plan.across, plan.x)):
        for i, value in enumerate(values):
            yield from _outside(value, plan.parameters[path], path, (*ROOT, key, i))
            if value in values[:i]:
                yield Problem((*ROOT, key, i), "is there already; remove it", f"{value:g}")
    for i, point in enumerate(plan.points):
        for j, (value, path) in enumerate(zip(point, plan.parameters, strict=True)):
            yield from _outside(value, plan.parameters[path], path, (*ROOT, "points", i, j))


def _outside(
    value: float, limits: tuple[float, float], path: str, where: KeyPath
) -> Iterator[Problem]:
    low, high = limits
    if not low <= value <= high:
        message = f"expected a number in the range of {path}, {low:g} to {high:g}; or widen that"
        yield Problem(where, message, f"{value:g}")


def _kinds(plan: MapPlan) -> Iterator[Problem]:
    if not plan.of or len(set(plan.of)) != len(plan.of):
        message = 'expected fold, branch point, or both; write for example "of: [fold]"'
        yield Problem((*ROOT, "of"), message, written(plan.of))


def _corners(scene: Scene, plan: MapPlan, check: Check) -> Iterator[Problem]:
    """Yield the corners of the rectangle that no scene may have; the first of them will do."""
    for x, y in product(*plan.ranges):
        trial = with_value(with_value(scene, plan.x, x), plan.y, y)
        trial = replace(trial, map=None, continuation=None)
        try:
            problems = check(validate(Scene, trial))
        except InvalidSceneError as error:
            problems = list(error.problems)
        if problems:
            first = problems[0]
            message = "is a corner that makes no valid scene; choose other ranges: "
            yield Problem(
                (*ROOT, "parameters"),
                f"{message}{dotted(first.path)}: {first}",
                f"{plan.x} = {x:g}, {plan.y} = {y:g}",
            )
            return
