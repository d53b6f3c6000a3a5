"""Batches on disk: a row for each ribbon, appended as it comes; nothing that is there is lost.

`rows.jsonl` holds one JSON object in a line; `table.csv` has them sorted by number; `study.json`
says which study it is; `solutions/NUMBER` are full results.
"""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

from ribbonopt.errors import OutputError
from ribbonopt.staging import unwritable

from .sweep import Study

ROWS, TABLE, STUDY, SOLUTIONS = "rows.jsonl", "table.csv", "study.json", "solutions"

Row = dict[str, Any]


class BatchFolder:
    """A folder that rows are written to."""

    def __init__(self, folder: str | Path, study: Study, *, resume: bool) -> None:
        """Claim the folder.

        Raises
        ------
        OutputError
            If it cannot be written, holds other files, rows that are not to be added to, or rows
            of another study.
        """
        self.folder, self.study = Path(folder), study
        self.rows: list[Row] = []
        try:
            self._claim(resume)
        except OutputError:  # an OSError too, but one that says what to do
            raise
        except OSError as error:
            raise unwritable(self.folder, error) from error

    @property
    def known(self) -> set[int]:
        """Numbers of the ribbons whose rows are there."""
        return {row["number"] for row in self.rows}

    def append(self, row: Row) -> None:
        """Add a row, on disk before this returns."""
        try:
            self._file.write(json.dumps(row) + "\n")
            self._file.flush()
        except OSError as error:
            raise unwritable(self.folder, error) from error
        self.rows.append(row)

    def close(self) -> None:
        """Write the table, sorted by number, and close the file of rows."""
        try:
            self._file.close()
            names: dict[str, None] = {}
            for row in self.rows:
                names |= dict.fromkeys(row)
            with open(self.folder / TABLE, "w", newline="", encoding="utf-8") as file:
                writer = csv.DictWriter(file, sorted_columns(list(names), self.study))
                writer.writeheader()
                writer.writerows(sorted(self.rows, key=lambda row: row["number"]))
        except OSError as error:
            raise unwritable(self.folder, error) from error

    def _claim(self, resume: bool) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        found = sorted(path.name for path in self.folder.iterdir())
        own = {ROWS, TABLE, STUDY, SOLUTIONS}
        foreign = [name for name in found if name not in own]
        if foreign:
            raise OutputError(
                f"{self.folder}: holds files that are no batch ({', '.join(foreign[:3])}); choose "
                "a new or an empty folder"
            )
        said = {"name": self.study.name, "ribbons": self.study.count, "digest": self.study.digest}
        if STUDY in found:
            known = json.loads((self.folder / STUDY).read_text(encoding="utf-8"))
            if known.get("digest") != said["digest"]:
                raise OutputError(
                    f"{self.folder}: holds rows of another study ({known.get('name')}); choose "
                    "another folder"
                )
            if not resume:
                raise OutputError(
                    f"{self.folder}: holds rows of this study already; go on by --resume, or "
                    "choose another folder"
                )
            self.rows = _read(self.folder / ROWS)
        text = "".join(json.dumps(row) + "\n" for row in self.rows)
        (self.folder / STUDY).write_text(json.dumps(said, indent=2) + "\n", encoding="utf-8")
        beside = self.folder / f"{ROWS}.new"
        beside.write_text(text, encoding="utf-8")
        beside.replace(self.folder / ROWS)
        self._file = open(self.folder / ROWS, "a", encoding="utf-8")


def sorted_columns(names: list[str], study: Study) -> list[str]:
    """Return columns: number, scene, inputs, what came out, and what it cost last."""
    first = ["number", "scene", *study.keys, "status", "verified", "energy"]
    last = ["start", "iterations", "path", "message", "seconds"]
    middle = [name for name in sorted(names) if name not in (*first, *last)]
    return [name for name in (*first, *middle, *last) if name in names]


def _read(path: Path) -> list[Row]:
    """Whole lines of a file of rows; one that was cut short is left out."""
    rows: list[Row] = []
    if not path.exists():
        return rows
    for line in path.read_text(encoding="utf-8").splitlines():
        try:
            rows.append(json.loads(line))
        except ValueError:
            break
    return rows
