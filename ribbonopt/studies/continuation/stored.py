"""Points as plain data and back: what it takes to go on from there, bit for bit."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping
from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import RibbonoptError
from ribbonopt.output.saved import SAME, answers_of, refuse_other
from ribbonopt.plain import Row
from ribbonopt.scene.quantities import START_VECTORS
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

from .continuation import Continuation
from .curve import Curve
from .locus.laid import Laid
from .saved import ARRAYS, BRANCH, packed, unpacked
from .walk.branches import Key
from .walk.points import POINT, Point
from .walk.walk import Ending


class Stored:
    """What a branch file holds: the history that a continuation goes on from."""

    def __init__(
        self,
        continuation: Continuation,
        lines: list[dict[str, Any]],
        source: str | os.PathLike[str] = "branch.jsonl",
    ) -> None:
        """Read checked lines of a source, which messages name.

        Raises
        ------
        OutputError
            If a point is not where its row says.
        """
        self.endings: dict[Key, Ending] = {}
        self._lines: dict[Key, list[dict[str, Any]]] = {}
        self._prepared, scene = continuation.prepared, continuation.scene
        self._curves: list[Curve] = []
        self._source = os.fspath(source)
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
                self._refuse_elsewhere(regular[-1])
                scene = self._curves[-1].scene_at(*_positions(regular[-1]["state"]))

    def points(self, stage: int, branch: int, kind: str) -> Iterator[Point[Solution]]:
        """Points of a kind, in order, each restored when it is asked for."""
        lines = self._lines.get((stage, branch), [])
        return (self.point(line) for line in lines if line["row"]["kind"] == kind)

    def point(self, line: dict[str, Any]) -> Point[Solution]:
        """Return the point of a line.

        Raises
        ------
        OutputError
            If its state is not that of its row and its scene.
        """
        row, state = line["row"], line["state"]
        self._refuse_elsewhere(line)
        try:
            arrays = {name: unpacked(state[name]) for name in ARRAYS}
            solution = self._solution(line, arrays["w"], arrays["widths"])
            refuse_other(answers_of(solution), _told(row))
        except (ValueError, ArithmeticError, RuntimeError) as error:
            raise self._damaged(row, str(error)) from error
        if state.get("across") is not None:
            solution.trajectory.found[Laid] = Laid(arrays["tangent"], unpacked(state["across"]))
        return Point(
            solution,
            np.append(arrays["w"], _positions(state)),
            arrays["tangent"],
            state["sign"],
            state["step"],
            row["number"],
            row["stage"],
            row["branch"],
            row["kind"],
            row,
            origin=row.get("origin"),
        )

    def _solution(self, line: dict[str, Any], w: Array, widths: Array) -> Solution:
        """Restore a solution; ValueError if its unknowns are not those of the scene."""
        state = line["state"]
        mesh = Mesh(tuple(np.split(widths, np.cumsum(state["elements"])[:-1])))
        curve = self._curves[line["row"]["stage"]]
        search = self._prepared.search(curve.posed_at(*_positions(state)))
        attempt = search.on_mesh(tuple(state["sheets"]), mesh)
        if len(w) != attempt.nlp.unknowns:
            raise ValueError(f"state.w: {len(w)} unknowns, its scene has {attempt.nlp.unknowns}")
        return attempt.restored(w)

    def _refuse_elsewhere(self, line: dict[str, Any]) -> None:
        """Refuse a position that is not the value of the row."""
        row, curve = line["row"], self._curves[line["row"]["stage"]]
        value, position = float(row[row["parameter"]]), line["state"]["position"]
        try:
            there = curve.value(position)
        except ArithmeticError:  # a logarithm of what no number is
            there = None
        if there is None or not np.isclose(there, value, rtol=SAME, atol=SAME * abs(value)):
            raise self._damaged(row, f"state.position: is not at {row['parameter']} = {value:.6g}")

    def _damaged(self, row: Row, fault: str) -> RibbonoptError:
        return BRANCH.damaged(f"{self._source}, point {row['number']}", fault)


def _told(row: Row) -> dict[str, Any]:
    """Return what a row tells of its solution; vectors where all their components are known."""
    vectors = zip(("n0", "m0", "u0"), START_VECTORS, strict=True)
    found = {name: [row.get(part) for part in parts] for name, parts in vectors}
    told = {name: vector for name, vector in found.items() if None not in vector}
    return {"energy": row.get("energy"), "H0": row.get("H0"), **told}


def restored(
    continuation: Continuation,
    lines: list[dict[str, Any]],
    numbers: Collection[int],
    source: str | os.PathLike[str] = "branch.jsonl",
) -> Iterator[tuple[int, Solution]]:
    """Yield numbers of points and their solutions, from checked lines of a source."""
    history = Stored(continuation, lines, source)
    for line in lines:
        if "row" in line and line["row"]["number"] in numbers:
            yield line["row"]["number"], history.point(line).solution


def _positions(state: Mapping[str, Any]) -> tuple[float, ...]:
    """Return the positions of a state: one on a branch, two on a locus."""
    first = state.get("first_position")
    return (state["position"],) if first is None else (first, state["position"])


def state_of(point: Point[Solution]) -> dict[str, Any]:
    """Return what a point is beside its row; arrays as base64 of their bytes."""
    solution = point.solution
    laid = solution.trajectory.found.get(Laid)
    located: dict[str, Any] = {}
    if isinstance(laid, Laid):
        located = {"first_position": float(point.unknowns[-2]), "across": packed(laid.across)}
    return {
        **located,
        "position": point.position,
        "step": point.step,
        "sign": point.sign,
        "sheets": list(solution.sheets),
        "elements": list(solution.dense.blocks.layout.elements),
        "w": packed(solution.dense.w),
        "widths": packed(solution.mesh.widths),
        "tangent": packed(point.tangent),
    }
