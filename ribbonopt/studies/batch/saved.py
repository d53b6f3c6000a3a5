"""What a batch folder says, checked as it is read: `study.json` and the rows of `rows.jsonl`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

from ribbonopt.output.records import checked
from ribbonopt.plain import Row
from ribbonopt.reading import MEGA, Kind, read_json
from ribbonopt.scene.quantities import ANSWERS
from ribbonopt.scene.schema.bounds import Bounds
from ribbonopt.studies.lines import whole_lines

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


def read_rows(folder: Path, study: dict[str, Any]) -> list[Row]:
    """Return the rows of a batch folder, none if none was begun.

    Raises
    ------
    OutputError
        Names the first line that is none of its study, and says what to do.
    """
    path = folder / ROWS

    def row_of(data: Any, where: str) -> Row:
        found = checked(SavedRow, data, where, LINES)
        if found.number > study["ribbons"]:
            fault = f"number: found {found.number}, the study has {study['ribbons']} ribbons"
            raise LINES.damaged(where, fault)
        for name in ANSWERS:
            if not isinstance(data.get(name), int | float | None):
                raise LINES.damaged(where, f"{name}: expected a number")
        row: Row = data
        return row

    return whole_lines(path, LINES, row_of) if path.exists() else []
