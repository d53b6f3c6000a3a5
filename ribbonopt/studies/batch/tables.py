"""Inputs of ribbons from a table (CSV): a column for each key, a line for each ribbon.

Messages name lines and columns and quote no cell: what is no table of ours may be for no eyes.
"""

from __future__ import annotations

import csv
import io
from typing import Any

from ribbonopt.errors import SceneError
from ribbonopt.reading import MEGA, Kind
from ribbonopt.scene import Scene
from ribbonopt.scene.schema.annotations import written_keys

from .cells import of_cell

CSV = Kind("a table of inputs", most=100 * MEGA, error=SceneError, piped=True)


def table_of(text: str, source: str) -> list[dict[str, Any]]:
    """Return what the lines of a table say, by key; `source` names it in messages.

    Raises
    ------
    SceneError
        If it is no table, or none of its keys is one of a scene.
    """
    lines = csv.reader(io.StringIO(text, newline=None))
    try:
        # Lines of a spreadsheet's end may hold nothing but separators.
        rows = [(lines.line_num, row) for row in lines if any(cell.strip() for cell in row)]
    except csv.Error as error:
        raise SceneError(f"{source}, line {lines.line_num}: cannot be read: {error}") from None
    if not rows:
        raise SceneError(f"{source}: is empty; expected a line of keys and a line for each ribbon")
    (first, names), *rest = rows
    keys = [name.strip() for name in names]
    before: set[str] = set()
    for column, key in enumerate(keys, start=1):
        if not key or key in before:
            raise SceneError(
                f"{source}, line {first}, column {column}: {'a key again' if key else 'no key'}; "
                "expected keys, each of them once"
            )
        before.add(key)
    for line, row in rest:
        if len(row) != len(keys):
            raise SceneError(
                f"{source}, line {line}: found {len(row)} values, expected {len(keys)}"
            )
    found = [
        {
            key: of_cell(text, f"{source}, line {line}, column {column}")
            for column, (key, text) in enumerate(zip(keys, row, strict=True), start=1)
        }
        for line, row in rest
    ]
    # No message is to quote what is no table of ours.
    if not {key.partition(".")[0] for key in keys} & {*written_keys(Scene)}:
        raise SceneError(
            f"{source}, line {first}: none of its cells is a key of a scene; expected keys such as "
            "law.epsilon"
        )
    return found
