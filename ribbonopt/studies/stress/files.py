"""A study of stress as files: every trial as CSV, everything as JSON."""

from __future__ import annotations

from pathlib import Path

from ribbonopt.errors import OutputError
from ribbonopt.output.table import write_table
from ribbonopt.plain import json_text

from .run import COLUMNS
from .stress import Stress

TABLE, NUMBERS, FIGURE = "stress.csv", "stress.json", "stress.png"
FILES = TABLE, NUMBERS, FIGURE


def save_stress(study: Stress, folder: str | Path) -> None:
    """Write the table and the numbers into an existing folder.

    Raises
    ------
    OutputError
        If they cannot be written.
    """
    folder = Path(folder)
    try:
        write_table(folder / TABLE, COLUMNS, (row.plain() for row in study.rows))
        (folder / NUMBERS).write_text(json_text(study.plain()), encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written ({error.strerror})") from error
