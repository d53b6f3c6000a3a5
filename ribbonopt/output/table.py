"""The one writer of tables as CSV: no cell is a formula to a spreadsheet, whatever a row says."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import IO, Any

from ribbonopt.plain import Row
from ribbonopt.text import cell

from .staging import replacing


def write_table(path: Path, names: Sequence[str], rows: Iterable[Row]) -> None:
    """Write columns of rows, under their names; what is there is replaced once all is written.

    Numbers and truth values are written as Python says them, texts as `ribbonopt.text.cell` does,
    lists of numbers with spaces between them; what a row lacks is empty.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    with replacing(path, newline="") as file:
        _write(file, names, rows)


def table_text(names: Sequence[str], rows: Iterable[Row]) -> str:
    """Return what `write_table` writes."""
    file = io.StringIO(newline="")
    _write(file, names, rows)
    return file.getvalue()


def _write(file: IO[str], names: Sequence[str], rows: Iterable[Row]) -> None:
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(map(cell, names))
    for row in rows:
        writer.writerow([_cell(row.get(name)) for name in names])


def _cell(value: Any) -> Any:
    if isinstance(value, list) and all(isinstance(item, float | int) for item in value):
        return " ".join(map(repr, value))
    if value is None or isinstance(value, float | int):
        return value
    return cell(value if isinstance(value, str) else str(value))
