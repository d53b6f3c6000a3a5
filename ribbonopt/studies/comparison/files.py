"""A comparison or benchmark as files: every row as CSV, everything as JSON."""

from __future__ import annotations

from pathlib import Path

from ribbonopt.errors import OutputError
from ribbonopt.output.table import write_table
from ribbonopt.plain import json_text

from .benchmark import Benchmark
from .compare import Comparison
from .rows import COLUMNS


def files_of(name: str) -> tuple[str, ...]:
    """Return the files that a folder of a study holds: table, numbers, figure."""
    return tuple(f"{name}.{kind}" for kind in ("csv", "json", "png"))


def save_study(study: Comparison | Benchmark, folder: str | Path, name: str) -> None:
    """Write NAME.csv and NAME.json into an existing folder.

    Raises
    ------
    OutputError
        If they cannot be written.
    """
    folder = Path(folder)
    try:
        timing = study.timing.columns  # beside every time what the machine was doing
        rows = (row.plain() | timing for row in study.rows)
        write_table(folder / f"{name}.csv", (*COLUMNS, *timing), rows)
        (folder / f"{name}.json").write_text(json_text(study.plain()), encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written ({error.strerror})") from error
