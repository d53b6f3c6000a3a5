"""Standard streams that are closed, full, or read by nobody: told once, wherever it can be."""

from __future__ import annotations

import os
import sys
from contextlib import suppress


def open_standard_streams() -> None:
    """Open what the shell has closed (`>&-`), so that no file of ours is taken for it.

    What is printed to a closed stdout then fails as it does on a full disk; to a closed stderr
    nothing can be said, and what would have been is dropped.
    """
    while True:
        descriptor = os.open(os.devnull, os.O_RDONLY)
        if descriptor > 2:
            os.close(descriptor)
            break
    if sys.stdout is None:
        sys.stdout = open(1, "w", closefd=False)
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")


def drop_output() -> None:
    """Take what stdout could not: it is lost, and not tried once more at exit."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def say(text: str) -> None:
    """Print to stderr, if there is anybody to read it."""
    with suppress(OSError, ValueError):
        print(text, file=sys.stderr, flush=True)
