"""The special point of a saved branch that a locus begins with."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np

from ribbonopt.errors import OutputError, SceneError
from ribbonopt.output.saved import read_scene
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.scene import Scene
from ribbonopt.scene.lens import value_at, with_value
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

from ..saved import FILE, SCENE, read_branch, unpacked
from ..walk.points import POINT, Point
from .surface import Surface

#: keys in which the scene of a saved branch may differ from that of a locus that begins there
FREE = ("name", "continuation", "record", "labels", "tolerance", "guess", "map", "equilibria")
Line = dict[str, Any]


def begun(surface: Surface, prepared: Prepared) -> tuple[Point[Solution], Point[Solution]]:
    """Return the last point before the special point that a stage names, and that itself.

    Raises
    ------
    SceneError
        If the folder holds no branch, one of another scene, or none with such a point.
    """
    stage, other = surface.stage, surface.other
    assert stage.branch is not None
    where = f"continuation.branch: {stage.branch}"
    scene, lines = _read(Path(stage.branch), where)
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
            f"{len(found)}; it has {there}; name another branch, or remove the key"
        )
    special = found[stage.number - 1]
    before = [
        line
        for line in points[: points.index(special)]
        if line["row"]["kind"] == POINT and _branch(line) == _branch(special)
    ]
    if not before:
        raise SceneError(f"{where}: its {stage.of} has no point before it on its branch")
    return _point(surface, prepared, before[-1]), _point(surface, prepared, special)


def _read(folder: Path, where: str) -> tuple[Scene, list[Line]]:
    """Return the scene and the lines of a branch."""
    if not ((folder / FILE).is_file() and (folder / SCENE).is_file()):
        raise SceneError(f"{where}: no branch; expected a folder written by ribbonopt continue")
    try:
        scene = read_scene(folder / SCENE)
        return scene, read_branch(folder / FILE, scene)
    except OutputError as error:
        raise SceneError(f"continuation.branch: {error}") from error


def _branch(line: Line) -> tuple[int, int]:
    return line["row"]["stage"], line["row"]["branch"]


def _point(surface: Surface, prepared: Prepared, line: Line) -> Point[Solution]:
    """Return the point of a line, on its own mesh."""
    row, state = line["row"], line["state"]
    w, widths, tangent = (unpacked(state[name]) for name in ("w", "widths", "tangent"))
    mesh = Mesh(tuple(np.split(widths, np.cumsum(state["elements"])[:-1])))
    search = prepared.search(surface.posed_at(float(row[surface.other]), surface.begin))
    attempt = search.on_mesh(tuple(state["sheets"]), mesh)
    if len(w) != attempt.nlp.unknowns:
        raise SceneError(
            f"continuation.branch: {surface.stage.branch}: point {row['number']} has {len(w)} "
            f"unknowns, this scene {attempt.nlp.unknowns}; expected a branch of the same scene"
        )
    unknowns = np.append(w, state["position"])
    return Point(
        attempt.restored(w),
        unknowns,
        tangent,
        state["sign"],
        state["step"],
        row["number"],
        kind=row["kind"],
        row=row,
    )


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
