"""Branches on disk: every accepted point is appended at once, so that nothing accepted is lost.

`branch.jsonl` holds one JSON object in a line: a point (`row`: what is recorded; `state`: what it
takes to go on from there, arrays as base64 of their bytes), or how a stage has ended. A line that
was cut short is not read. `branch.csv` has the rows as a table.
"""

from __future__ import annotations

import json
from collections.abc import Generator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from ribbonopt.errors import OutputError
from ribbonopt.output.claims import claimed
from ribbonopt.output.declared import BRANCH_PICTURES
from ribbonopt.output.disk import Appended
from ribbonopt.output.places import unwritable
from ribbonopt.output.staging import replacing
from ribbonopt.output.table import write_table
from ribbonopt.scene import Scene, dump_scene, load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.lines import whole_lines

from .continuation import Continuation
from .stored import Stored, state_of
from .walk.branches import Key
from .walk.points import POINT, Point

FILE, TABLE, SCENE = "branch.jsonl", "branch.csv", "scene.yaml"


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
        self._finished = False
        try:
            with ExitStack() as refused:
                own = {FILE, SCENE, TABLE, *BRANCH_PICTURES}
                self.folder = refused.enter_context(claimed(self.folder, own))
                self._begin(resume)
                self._claimed = refused.pop_all()  # the folder is ours until it is closed
        except OutputError:  # an OSError too, but one that says what to do
            raise
        except OSError as error:
            raise unwritable(self.folder, error) from error

    def _begin(self, resume: bool) -> None:
        there = (self.folder / FILE).is_file()
        if there and not resume:
            raise OutputError(
                f"{self.folder}: holds a branch already; go on with it by --resume, or choose "
                "another folder"
            )
        text = dump_scene(self.scene)
        if there:
            self._same(text)
            self.lines = _read(self.folder / FILE)
        if not (self.folder / SCENE).exists():
            self._replace(SCENE, text)
        self._replace(FILE, "".join(_line(line) for line in self.lines))
        self._file = Appended(open(self.folder / FILE, "a", encoding="utf-8"))

    @property
    def rows(self) -> list[dict[str, Any]]:
        """Rows of all points."""
        return rows_of(self.lines)

    def follow(self, continuation: Continuation) -> Generator[Point[Solution], None, None]:
        """Points of a continuation from where the folder's end, each written before it is given."""
        history = Stored(continuation, self.lines)
        known = set(history.endings)
        try:
            for point in continuation.resume(history):
                known = self._note_endings(continuation, known)
                self._append({"row": dict(point.row), "state": state_of(point)})
                yield point
            self._note_endings(continuation, known)
        finally:
            self.finish()

    def close(self) -> None:
        """Finish, if that is not done, and give the folder up."""
        with self._claimed:
            self.finish()

    def finish(self) -> None:
        """End the branch file and write the table; OutputError if the disk is full."""
        if self._finished:
            return
        self._finished = True
        try:
            self._file.close()
            if self.lines:
                self.write_table()
                return
            # Nothing was found, and so nothing stays.
            for name in (FILE, SCENE):
                (self.folder / name).unlink(missing_ok=True)
        except OSError as error:
            raise unwritable(self.folder, error) from error

    def write_table(self) -> None:
        """Write the rows as CSV."""
        rows = self.rows
        names = list(dict.fromkeys(name for row in rows for name in row))
        write_table(self.folder / TABLE, names, rows)

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
        with replacing(self.folder / name) as file:
            file.write(text)


def load_branch(folder: str | Path) -> tuple[Scene, list[dict[str, Any]]]:
    """Return the scene and the lines of a branch folder; OutputError if it holds none."""
    folder = Path(folder)
    if not ((folder / FILE).is_file() and (folder / SCENE).is_file()):
        raise OutputError(f"{folder}: no branch; expected a folder written by ribbonopt continue")
    return load_scene(folder / SCENE), _read(folder / FILE)


def rows_of(lines: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of all points."""
    return [line["row"] for line in lines if "row" in line]


def _read(path: Path) -> list[dict[str, Any]]:
    """Whole lines; special points after the last regular one will be found again."""
    lines = [_renamed(line) for line in whole_lines(path, _sound)]
    while lines and "row" in lines[-1] and lines[-1]["row"]["kind"] != POINT:
        lines.pop()
    return lines


def _renamed(line: dict[str, Any]) -> dict[str, Any]:
    """Return a line with its parameter under its own name, which once was called `value`."""
    row = line.get("row", {})
    if "value" not in row:
        return line
    path = row["parameter"]
    return {**line, "row": {path if key == "value" else key: row[key] for key in row}}


def _sound(line: Any) -> bool:
    """Whether a line holds what `BranchFolder` writes."""
    if not isinstance(line, dict):
        return False
    row, ending = line.get("row"), line.get("ending")
    if isinstance(ending, dict):
        return {"stage", "branch", "reached", "reason"} <= ending.keys()
    keys = {"number", "stage", "branch", "parameter", "kind"}
    return isinstance(row, dict) and keys <= row.keys() and isinstance(line.get("state"), dict)


def _line(value: dict[str, Any]) -> str:
    return json.dumps(value) + "\n"
