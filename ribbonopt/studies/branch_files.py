"""Branches on disk: every accepted point is appended at once, so that nothing accepted is lost.

`branch.jsonl` holds one JSON object in a line: a point (`row`: what is recorded; `state`: what it
takes to go on from there, arrays as base64 of their bytes), or how a stage has ended. A line that
was cut short is not read. `branch.csv` has the rows as a table.
"""

from __future__ import annotations

import base64
import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import OutputError
from ribbonopt.scene import Scene, dump_scene
from ribbonopt.solution import Solution
from ribbonopt.staging import unwritable
from ribbonopt.transcription import Mesh

from .branches import Key
from .continuation import Continuation
from .curve import Curve
from .points import POINT, Point
from .walk import Ending

FILE, TABLE, SCENE = "branch.jsonl", "branch.csv", "scene.yaml"
FIGURES = ("branch.png", "ribbons.png")


class Stored:
    """What a branch file holds: the history that a continuation goes on from."""

    def __init__(self, continuation: Continuation, lines: list[dict[str, Any]]) -> None:
        """Read parsed lines."""
        self.endings: dict[Key, Ending] = {}
        self._lines: dict[Key, list[dict[str, Any]]] = {}
        self._prepared, scene = continuation.prepared, continuation.scene
        self._curves: list[Curve] = []
        for stage in continuation.stages:
            self._curves.append(Curve(scene, stage))
            scene = self._curves[-1].scene_at(self._curves[-1].goals[-1])
        for line in lines:
            if "ending" in line:
                ending = line["ending"]
                key = ending["stage"], ending["branch"]
                self.endings[key] = Ending(ending["reached"], ending["reason"])
            else:
                row = line["row"]
                self._lines.setdefault((row["stage"], row["branch"]), []).append(line)

    def points(self, stage: int, branch: int, kind: str) -> list[Point]:
        """Points of a kind, in order."""
        lines = self._lines.get((stage, branch), [])
        return [self.point(line) for line in lines if line["row"]["kind"] == kind]

    def point(self, line: dict[str, Any]) -> Point:
        """Return the point of a line."""
        row, state = line["row"], line["state"]
        curve = self._curves[row["stage"]]
        arrays = {name: _array(state[name]) for name in ("w", "widths", "tangent")}
        mesh = Mesh(tuple(np.split(arrays["widths"], np.cumsum(state["elements"])[:-1])))
        search = self._prepared.search(curve.scene_at(state["position"]))
        solution = search.on_mesh(tuple(state["sheets"]), mesh).restored(arrays["w"])
        return Point(
            solution,
            state["position"],
            arrays["tangent"],
            state["sign"],
            state["step"],
            row["number"],
            row["stage"],
            row["branch"],
            row["kind"],
            row,
        )


class BranchFolder:
    """A folder that a branch is written to, point by point."""

    def __init__(self, folder: str | Path, scene: Scene, *, resume: bool) -> None:
        """Claim the folder.

        Raises
        ------
        OutputError
            If it cannot be written, holds other files, holds a branch that is not to be resumed,
            or one of another scene.
        """
        self.folder, self.scene = Path(folder), scene
        self.lines: list[dict[str, Any]] = []
        own = {FILE, TABLE, SCENE, *FIGURES}
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            found = sorted(path.name for path in self.folder.iterdir())
            foreign = [name for name in found if name not in own]
            if foreign:
                raise OutputError(
                    f"{folder}: holds files that are no branch ({', '.join(foreign[:3])}); choose "
                    "a new or an empty folder"
                )
            if FILE in found and not resume:
                raise OutputError(
                    f"{folder}: holds a branch already; go on with it by --resume, or choose "
                    "another folder"
                )
            text = dump_scene(scene)
            if FILE in found:
                self._same(text)
                self.lines = _read(self.folder / FILE)
            self._replace(FILE, "".join(_line(line) for line in self.lines))
            (self.folder / SCENE).write_text(text, encoding="utf-8")
            self._file = open(self.folder / FILE, "a", encoding="utf-8")
        except OSError as error:
            raise unwritable(self.folder, error) from error

    @property
    def rows(self) -> list[dict[str, Any]]:
        """Rows of all points."""
        return [line["row"] for line in self.lines if "row" in line]

    def follow(self, continuation: Continuation) -> Iterator[Point]:
        """Points of a continuation from where the folder's end, each written before it is given."""
        history = Stored(continuation, self.lines)
        known = set(history.endings)
        try:
            for point in continuation.resume(history):
                known = self._note_endings(continuation, known)
                self._append({"row": dict(point.row), "state": _state(point)})
                yield point
            self._note_endings(continuation, known)
        finally:
            self.write_table()

    def spread(
        self, continuation: Continuation, count: int
    ) -> list[tuple[dict[str, Any], Solution]]:
        """Rows and solutions of a few points, spread over all branches."""
        lines = [line for line in self.lines if "row" in line and line["row"]["kind"] == POINT]
        history = Stored(continuation, [])
        places = np.linspace(0, len(lines) - 1, min(count, len(lines))).round()
        chosen = [lines[int(i)] for i in places]
        return [(line["row"], history.point(line).solution) for line in chosen]

    def write_table(self) -> None:
        """Write the rows as CSV."""
        rows = self.rows
        names = list(rows[0]) if rows else []
        with open(self.folder / TABLE, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(names)
            for row in rows:
                writer.writerow([_cell(row[name]) for name in names])

    def _note_endings(self, continuation: Continuation, known: set[Key]) -> set[Key]:
        for key, ending in continuation.endings.items():
            if key not in known:
                stage, branch = key
                self._append(
                    {
                        "ending": {
                            "stage": stage,
                            "branch": branch,
                            "reached": ending.reached,
                            "reason": ending.reason,
                        }
                    }
                )
        return set(continuation.endings)

    def _append(self, line: dict[str, Any]) -> None:
        self.lines.append(line)
        try:
            self._file.write(_line(line))
            self._file.flush()
        except OSError as error:
            raise unwritable(self.folder, error) from error

    def _same(self, text: str) -> None:
        scene = self.folder / SCENE
        if not scene.exists() or scene.read_text(encoding="utf-8") != text:
            raise OutputError(
                f"{self.folder}: holds a branch of another scene; resume with the scene (and "
                "--set) it was begun with, or choose another folder"
            )

    def _replace(self, name: str, text: str) -> None:
        """Write a file so that it is whole at any time."""
        beside = self.folder / f".{name}.new"
        beside.write_text(text, encoding="utf-8")
        beside.replace(self.folder / name)


def _read(path: Path) -> list[dict[str, Any]]:
    """Whole lines; special points after the last regular one will be found again."""
    lines = []
    for text in path.read_text(encoding="utf-8").splitlines():
        try:
            lines.append(json.loads(text))
        except ValueError:
            break  # cut short when the process died, and nothing after it
    while lines and "row" in lines[-1] and lines[-1]["row"]["kind"] != POINT:
        lines.pop()
    return lines


def _state(point: Point) -> dict[str, Any]:
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


def _line(value: dict[str, Any]) -> str:
    return json.dumps(value) + "\n"


def _bytes(array: Array) -> str:
    return base64.b64encode(np.asarray(array, dtype="<f8").tobytes()).decode("ascii")


def _array(text: str) -> Array:
    return np.array(np.frombuffer(base64.b64decode(text), dtype="<f8"), dtype=float)


def _cell(value: Any) -> Any:
    if isinstance(value, list):
        return " ".join(repr(item) for item in value)
    return "" if value is None else value
