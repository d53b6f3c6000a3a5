"""Branches on disk: every accepted point is appended at once, so that nothing accepted is lost.

`branch.jsonl` holds one JSON object in a line: a point (`row`: what is recorded; `state`: what it
takes to go on from there, arrays as base64 of their bytes), or how a stage has ended. A line that
was cut short is not read. `branch.csv` has the rows as a table.
"""

from __future__ import annotations

import json
import os
from collections.abc import Generator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from ribbonopt.errors import OutputError
from ribbonopt.output.claims import claimed
from ribbonopt.output.declared import BRANCH_PICTURES, PAGE
from ribbonopt.output.disk import Appended
from ribbonopt.output.places import unwritable
from ribbonopt.output.saved import SCENE as SAVED
from ribbonopt.output.saved import read_scene
from ribbonopt.output.staging import replacing
from ribbonopt.output.table import write_table
from ribbonopt.plain import finite
from ribbonopt.reading import read_text
from ribbonopt.scene import Scene, dump_scene
from ribbonopt.solution.solution import Solution

from .continuation import Continuation
from .saved import FILE, SCENE, read_branch
from .stored import Stored, state_of
from .walk.branches import Key
from .walk.points import Point

TABLE = "branch.csv"


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
                own = {FILE, SCENE, TABLE, PAGE, *BRANCH_PICTURES}
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
            self.lines = read_branch(self.folder / FILE, self.scene)
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
        history = Stored(continuation, self.lines, self.folder / FILE)
        known = set(history.endings)
        try:
            for point in continuation.resume(history):
                known = self._note_endings(continuation, known)
                self._append({"row": finite(dict(point.row)), "state": state_of(point)})
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
                            "points": len(self.rows),
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
        if not os.path.exists(scene) or read_text(scene, SAVED) != text:
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
    if not (os.path.exists(folder / FILE) and os.path.exists(folder / SCENE)):
        raise OutputError(f"{folder}: no branch; expected a folder written by ribbonopt continue")
    scene = read_scene(folder / SCENE)
    return scene, read_branch(folder / FILE, scene)


def rows_of(lines: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of all points."""
    return [line["row"] for line in lines if "row" in line]


def _line(value: dict[str, Any]) -> str:
    return json.dumps(value) + "\n"
