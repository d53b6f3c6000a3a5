"""Standard streams that are closed, full, or read by nobody: told once, if there is anybody."""

from __future__ import annotations

import os
import sys
from contextlib import suppress

from .common import BAD_INPUT, READER_GONE
from .terminal import complain


def open_standard_streams() -> None:
    """Open what the shell has closed (`>&-`), so that no file of ours is taken for it.

    What is printed to a closed stdout then fails as it does on a full disk; what would be said on
    a closed stderr is dropped.
    """
    for descriptor in range(3):
        try:
            os.fstat(descriptor)
        except OSError:  # closed: the lowest that is free is the next to be opened
            os.open(os.devnull, os.O_WRONLY if descriptor == 2 else os.O_RDONLY)
    if sys.stdout is None:
        sys.stdout = open(1, "w", closefd=False)
    if sys.stderr is None:
        sys.stderr = open(os.devnull, "w")


def flushed(status: int) -> int:
    """Have all that was printed leave, and return the exit status."""
    try:
        sys.stdout.flush()
    except (OSError, ValueError) as error:
        return unheard(error)
    return status


def unheard(error: BaseException | None) -> int:
    """Say why stdout takes nothing, drop what it should have taken, return the exit status."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if isinstance(error, BrokenPipeError):
        return READER_GONE  # on purpose, as by `head`: nobody to tell
    reason = getattr(error, "strerror", None) or error
    complain(f"the standard output cannot be written ({reason}); what is on disk is kept")
    return BAD_INPUT
