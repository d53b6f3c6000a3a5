"""Points as plain data and back: what it takes to go on from there, bit for bit."""

from __future__ import annotations

import base64
from collections.abc import Collection, Iterator
from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

from .continuation import Continuation
from .curve import Curve
from .walk.branches import Key
from .walk.points import POINT, Point
from .walk.walk import Ending


class Stored:
    """What a branch file holds: the history that a continuation goes on from."""

    def __init__(self, continuation: Continuation, lines: list[dict[str, Any]]) -> None:
        """Read parsed lines."""
        self.endings: dict[Key, Ending] = {}
        self._lines: dict[Key, list[dict[str, Any]]] = {}
        self._prepared, scene = continuation.prepared, continuation.scene
        self._curves: list[Curve] = []
        for line in lines:
            if "ending" in line:
                ending = line["ending"]
                key = ending["stage"], ending["branch"]
                self.endings[key] = Ending(ending["reached"], ending["reason"])
            else:
                row = line["row"]
                self._lines.setdefault((row["stage"], row["branch"]), []).append(line)
        for i in range(len(continuation.stages)):
            self._curves.append(continuation.curve(i, scene))
            ways = range(len(self._curves[-1].ways))
            lines = [line for way in ways for line in self._lines.get((i, way), [])]
            regular = [line for line in lines if line["row"]["kind"] == POINT]
            if regular:  # where a stage ended, at its goal or before
                scene = self._curves[-1].scene_at(regular[-1]["state"]["position"])

    def points(self, stage: int, branch: int, kind: str) -> list[Point[Solution]]:
        """Points of a kind, in order."""
        lines = self._lines.get((stage, branch), [])
        return [self.point(line) for line in lines if line["row"]["kind"] == kind]

    def point(self, line: dict[str, Any]) -> Point[Solution]:
        """Return the point of a line."""
        row, state = line["row"], line["state"]
        curve = self._curves[row["stage"]]
        arrays = {name: _array(state[name]) for name in ("w", "widths", "tangent")}
        mesh = Mesh(tuple(np.split(arrays["widths"], np.cumsum(state["elements"])[:-1])))
        search = self._prepared.search(curve.posed_at(state["position"]))
        solution = search.on_mesh(tuple(state["sheets"]), mesh).restored(arrays["w"])
        return Point(
            solution,
            np.append(arrays["w"], state["position"]),
            arrays["tangent"],
            state["sign"],
            state["step"],
            row["number"],
            row["stage"],
            row["branch"],
            row["kind"],
            row,
            origin=row["origin"],
        )


def restored(
    continuation: Continuation, lines: list[dict[str, Any]], numbers: Collection[int]
) -> Iterator[tuple[int, Solution]]:
    """Yield numbers of points and their solutions, from parsed lines."""
    history = Stored(continuation, lines)
    for line in lines:
        if "row" in line and line["row"]["number"] in numbers:
            yield line["row"]["number"], history.point(line).solution


def state_of(point: Point[Solution]) -> dict[str, Any]:
    """Return what a point is beside its row; arrays as base64 of their bytes."""
    solution = point.solution
    return {
        "position": point.position,
        "step": point.step,
        "sign": point.sign,
        "sheets": list(solution.sheets),
        "elements": list(solution.dense.blocks.layout.elements),
        "w": _bytes(solution.dense.w),
        "widths": _bytes(solution.mesh.widths),
        "tangent": _bytes(point.tangent),
    }


def _bytes(array: Array) -> str:
    return base64.b64encode(np.asarray(array, dtype="<f8").tobytes()).decode("ascii")


def _array(text: str) -> Array:
    return np.array(np.frombuffer(base64.b64decode(text), dtype="<f8"), dtype=float)
