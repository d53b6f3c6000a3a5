"""The one writer to stdout and stderr: what a file or a user says is shown, and never acts.

Characters that the stream cannot say are escaped. Where stdout is full, closed, or its reader has
left, that is for `main` to tell (`UnheardError`); where stderr is, there is nobody to tell.
"""

from __future__ import annotations

import argparse
import sys
from typing import Any, TextIO

from ribbonopt.text import one_line, printable, shortened

LONGEST = 8000  # characters of a message


class UnheardError(Exception):
    """What was to be printed on stdout finds no room, or no reader."""


def say(text: str) -> None:
    """Write what was asked for, of one or more lines, to stdout."""
    write(sys.stdout, printable(text) + "\n")


def say_line(text: str) -> None:
    """Write what others may read line by line, such as a path, to stdout."""
    write(sys.stdout, one_line(text) + "\n")


def say_json(value: dict[str, Any], indent: int | None = None) -> None:
    """Write one JSON object to stdout, in ASCII."""
    import json  # most commands print text

    write(sys.stdout, json.dumps(value, indent=indent, allow_nan=False) + "\n")


def complain(message: str) -> None:
    """Write a message to stderr: it begins with `ribbonopt:`, and no other line looks like that."""
    first, *others = printable(bounded(message)).split("\n")
    lines = [first, *(line if line.startswith("  ") else f"  {line}" for line in others)]
    write(sys.stderr, "ribbonopt: " + "\n".join(lines) + "\n")


def overwrite(*texts: str) -> None:
    """Write to stderr in place of the line that is there; each of several texts over the last."""
    if sys.stderr is not None:
        write(sys.stderr, "".join("\r" + one_line(text) for text in texts))
        sys.stderr.flush()


def seen() -> bool:
    """Whether somebody sees what is written to stderr as it comes."""
    return sys.stderr is not None and sys.stderr.isatty()


def bounded(message: str) -> str:
    """Return a message that a terminal has room for."""
    return shortened(message, LONGEST)


def write(stream: TextIO | None, text: str) -> None:
    """Write to a stream what it can say; nothing where the process was started without it."""
    if stream is None:
        return
    if not text.isascii():
        encoding = getattr(stream, "encoding", None) or "utf-8"
        text = text.encode(encoding, "backslashreplace").decode(encoding)
    try:
        stream.write(text)
    except (OSError, ValueError) as error:  # full, closed, or nobody reads it
        if stream is not sys.stderr:
            raise UnheardError(*error.args) from error


class Parser(argparse.ArgumentParser):
    """A parser whose words go through this writer."""

    @property
    def color(self) -> bool:
        """Whether help is coloured, by escapes, as it would be from Python 3.14 on."""
        return False

    @color.setter
    def color(self, wanted: bool) -> None:
        pass

    def error(self, message: str) -> Any:
        """Say what is wrong with the arguments, and exit with status 2."""
        super().error(one_line(bounded(message)))

    def _print_message(self, message: str, file: Any = None) -> None:
        write(file or sys.stderr, printable(message))
