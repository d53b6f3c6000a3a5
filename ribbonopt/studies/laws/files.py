"""A comparison of laws as files: rows as CSV, everything with what a figure draws as JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from ribbonopt.errors import OutputError
from ribbonopt.output.table import write_table
from ribbonopt.plain import Row, json_text

FILES = ("laws.csv", "laws.json", "laws.png")


class Compared(Protocol):
    """A comparison of laws, of whatever."""

    @property
    def name(self) -> str:
        """Of the scene or the study."""

    @property
    def solved(self) -> bool:
        """Whether any law gave a verified solution."""

    @property
    def columns(self) -> Sequence[str]:
        """Names of the columns of `rows`."""

    @property
    def rows(self) -> Sequence[Row]:
        """What the table holds."""

    def plain(self) -> Mapping[str, Any]:
        """Return what is printed as JSON."""

    def with_curves(self) -> Mapping[str, Any]:
        """Return everything, with what a figure draws."""


def save_laws(study: Compared, folder: str | Path) -> None:
    """Write laws.csv and laws.json into an existing folder.

    Raises
    ------
    OutputError
        If they cannot be written.
    """
    folder = Path(folder)
    try:
        write_table(folder / FILES[0], study.columns, study.rows)
        (folder / FILES[1]).write_text(json_text(study.with_curves()), encoding="utf-8")
    except OSError as error:
        raise OutputError(f"{folder}: cannot be written ({error.strerror})") from error
