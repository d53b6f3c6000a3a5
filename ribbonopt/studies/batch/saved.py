"""What a batch folder says, checked as it is read: `study.json` and the rows of `rows.jsonl`."""

from __future__ import annotations

import os
from dataclasses import field
from pathlib import Path
from typing import Annotated, Any

from ribbonopt.classes import dataclass
from ribbonopt.output.records import checked
from ribbonopt.plain import Row, finite, is_number
from ribbonopt.reading import MEGA, Kind, read_json
from ribbonopt.scene.faults import shown
from ribbonopt.scene.quantities import ANSWERS
from ribbonopt.scene.schema.bounds import Bounds
from ribbonopt.studies.lines import whole_lines

from .study import Study

ROWS, STUDY = "rows.jsonl", "study.json"

RECORD = Kind("what a batch says of its study", most=100 * MEGA, remedy="choose another folder")
LINES = Kind(
    "rows of a batch",
    most=4000 * MEGA,
    remedy="remove this line: the others are kept, and --resume solves its ribbon again",
)
Number = Annotated[int, Bounds(ge=1)]
Count = Annotated[int, Bounds(ge=0)]


@dataclass(frozen=True)
class SavedStudy:
    """What `study.json` says."""

    name: str
    ribbons: Count
    inputs: tuple[str, ...]
    digest: str
    labels: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class SavedRow:
    """What is known of all rows; a ribbon that failed has the first three, and what it can."""

    number: Number
    status: str
    verified: bool
    scene: str = ""
    message: str = ""
    note: str = ""
    start: str | None = None
    path: str | None = None
    iterations: Count | None = None
    seconds: float | None = None
    error: float | None = None


def read_study(folder: Path) -> dict[str, Any]:
    """Return what a batch folder says of its study; OutputError if that is damaged."""
    path = folder / STUDY
    record: dict[str, Any] = read_json(path, RECORD)
    checked(SavedStudy, record, str(path), RECORD)
    return record


def read_rows(folder: Path, record: dict[str, Any], study: Study | None = None) -> list[Row]:
    """Return the rows of a batch folder, none if none was begun.

    Parameters
    ----------
    folder, record
        The folder, and what it says of its study.
    study
        The study itself, where it is at hand: then rows must be of its ribbons.

    Raises
    ------
    OutputError
        Names the first line that is none of its study, and says what to do.
    """
    path = folder / ROWS
    if not os.path.exists(path):
        return []
    given = {} if study is None else {ribbon.number: ribbon.inputs for ribbon in study.ribbons}

    def row_of(data: Any, where: str) -> Row:
        row = checked(SavedRow, data, where, LINES)
        if row.number > record["ribbons"]:
            fault = f"number: found {row.number}, the study has {record['ribbons']} ribbons"
            raise LINES.damaged(where, fault)
        for name in ANSWERS:
            if data.get(name) is not None and not is_number(data[name]):
                raise LINES.damaged(where, f"{name}: expected a number")
        for key, value in finite(given.get(row.number, {})).items():
            if data.get(key, value) != value:
                fault = f"{key}: found {shown(data[key])}, its study has {shown(value)}"
                raise LINES.damaged(where, fault)
        found: Row = data
        return found

    return whole_lines(path, LINES, row_of)
