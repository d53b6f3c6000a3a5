"""The special point of a saved branch that a locus begins with."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

from ribbonopt.errors import OutputError, SceneError
from ribbonopt.scene import Scene
from ribbonopt.scene.lens import value_at, with_value
from ribbonopt.solution.solution import Solution

from ..walk.points import POINT, Point
from .surface import Surface

#: keys in which the scene of a saved branch may differ from that of a locus that begins there
FREE = ("name", "continuation", "record", "labels", "tolerance", "guess")


def begun(surface: Surface) -> tuple[Point[Solution], Point[Solution]]:
    """Return the last point before the special point that a stage names, and that itself.

    Raises
    ------
    SceneError
        If the folder holds no branch, one of another scene, or none with such a point.
    """
    from ..continuation import Continuation  # which knows stages of loci
    from ..files import FILE, load_branch
    from ..stored import Stored

    stage, other = surface.stage, surface.other
    assert stage.branch is not None
    try:
        scene, lines = load_branch(stage.branch)
    except OutputError as error:
        raise SceneError(f"continuation.branch: {error}") from error
    where = f"continuation.branch: {stage.branch}"
    if unlike := _unlike(surface, scene):
        raise SceneError(
            f"{where}: holds a branch of another scene: its {unlike} is not that of this one; "
            "expected one that differs in the first parameter alone"
        )
    points = [line for line in lines if "row" in line and line["row"]["parameter"] == other]
    found = [line for line in points if line["row"]["kind"] == stage.of]
    if len(found) < stage.number:
        kinds = sorted({line["row"]["kind"] for line in points} - {POINT})
        there = ", ".join(kinds) if kinds else "no special points"
        raise SceneError(
            f"{where}: expected {stage.number} of the kind {stage.of!r} in {other}, found "
            f"{len(found)}; it has {there}; name another branch, or remove the key and say "
            "`between`"
        )
    special = found[stage.number - 1]
    key = special["row"]["stage"], special["row"]["branch"]
    before = [
        line
        for line in points[: points.index(special)]
        if (line["row"]["stage"], line["row"]["branch"]) == key and line["row"]["kind"] == POINT
    ]
    if not before:
        raise SceneError(f"{where}: its {stage.of} has no point before it on its branch")
    history = Stored(Continuation(scene), lines, f"{stage.branch}/{FILE}")
    return history.point(before[-1]), history.point(special)


def _unlike(surface: Surface, scene: Scene) -> str:
    """Return the first key in which the scene of a branch is another one, "" for none."""
    first, second = surface.stage.paths
    own: Any = replace(surface.scene, continuation=None)
    try:
        if value_at(scene, second) != surface.value(surface.begin):
            return second
        like: Any = with_value(scene, first, value_at(own, first))
    except SceneError:
        return first
    keys = [f.name for f in fields(Scene) if f.name not in FREE]
    return next((key for key in keys if getattr(own, key) != getattr(like, key)), "")
