"""Files of JSON lines that are appended to: whatever ends the process, whole lines are read."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from ribbonopt.plain import parsed
from ribbonopt.reading import Kind, read_lines

T = TypeVar("T")


def whole_lines(path: Path, kind: Kind, checked: Callable[[Any, str], T]) -> list[T]:
    """Return what the lines of a file say; the last one, if it has no end, may have been cut short.

    Parameters
    ----------
    path, kind
        The file.
    checked
        Returns what the data of a line are, or raises the error of the kind; takes where that is.

    Raises
    ------
    OutputError
        If any other line is damaged: names it.
    """
    lines: list[T] = []
    for number, text in enumerate(read_lines(path, kind), start=1):
        where = f"{path}, line {number}"
        if not text.strip():
            continue
        try:
            data = parsed(text)
        except ValueError as error:
            if not text.endswith(b"\n") and (text.startswith(b"{") or not text.strip(b"\0")):
                break  # cut short when the process died, and nothing after it
            raise kind.damaged(where, str(error)) from None
        lines.append(checked(data, where))
    return lines
