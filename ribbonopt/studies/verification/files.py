"""Numbers with sources as files: rows as CSV, everything as JSON, a page to read."""

from __future__ import annotations

from pathlib import Path

from ribbonopt.errors import OutputError
from ribbonopt.output.table import write_table
from ribbonopt.plain import json_text

from .page import page
from .run import NAME, Verification

FILES = tuple(f"{NAME}.{kind}" for kind in ("csv", "json", "md"))


def save_verification(study: Verification, folder: str | Path) -> None:
    """Write verification.csv, .json and .md into an existing folder.

    Raises
    ------
    OutputError
        If they cannot be written.
    """
    folder, plain = Path(folder), study.plain()
    try:
        write_table(folder / FILES[0], list(plain["rows"][0]), plain["rows"])
        (folder / FILES[1]).write_text(json_text(plain), encoding="utf-8")
        (folder / FILES[2]).write_text(page(study), encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written ({error.strerror})") from error
