"""Files of JSON lines that are appended to: whatever ends the process, whole lines are read."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ribbonopt.errors import OutputError


def whole_lines(path: Path, sound: Callable[[Any], bool]) -> list[dict[str, Any]]:
    """Return the objects of a file, a line each; the last one may have been cut short.

    Raises
    ------
    OutputError
        If a line is whole, but not sound.
    """
    lines: list[dict[str, Any]] = []
    for number, text in enumerate(path.read_bytes().split(b"\n"), start=1):
        if not text:
            continue
        try:
            line = json.loads(text)
        except ValueError:
            break  # cut short when the process died, and nothing after it
        if not sound(line):
            raise OutputError(
                f"{path}, line {number}: is damaged; remove it and all lines after it to go on"
            )
        lines.append(line)
    return lines
