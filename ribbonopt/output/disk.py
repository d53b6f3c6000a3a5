"""What has been written survives a power loss: the disk has it before anybody is told."""

from __future__ import annotations

import errno
import os
import time
from contextlib import suppress
from pathlib import Path
from typing import IO

EACH = 1.0  # seconds of lines that a power loss may cost


def sync(path: Path) -> None:
    """Have a file, or what a folder lists, on disk; OSError if the disk has not taken it."""
    try:
        descriptor = os.open(path, os.O_RDONLY)
    except OSError:
        if path.is_dir():  # some systems open no folders
            return
        raise
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in (errno.EINVAL, errno.ENOTSUP, errno.EBADF):  # of no disk
            raise
    finally:
        os.close(descriptor)


def sync_all(folder: Path) -> None:
    """Have a folder and all that is in it on disk; OSError if the disk has not taken it."""
    for where, _, names in os.walk(folder, topdown=False):
        for name in names:
            sync(Path(where, name))
        sync(Path(where))


class Appended:
    """A file of lines: each with the system before `write` returns, on disk a second later."""

    def __init__(self, file: IO[str]) -> None:
        """Take an open file."""
        self._file, self._synced = file, time.monotonic()

    def write(self, line: str) -> None:
        """Add a line; OSError if there is no room."""
        try:
            self._file.write(line)
            self._file.flush()
            if time.monotonic() - self._synced >= EACH:
                self._sync()
        except OSError:
            with suppress(OSError):  # it tries to write the rest of the line once more
                self._file.close()
            raise

    def close(self) -> None:
        """Have all lines on disk."""
        if not self._file.closed:
            try:
                self._file.flush()
                self._sync()
            finally:
                self._file.close()

    def _sync(self) -> None:
        with suppress(ValueError):  # of no file, as in a test
            sync(Path(self._file.name))
        self._synced = time.monotonic()
