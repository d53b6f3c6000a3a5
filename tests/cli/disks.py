"""Disks that are full."""

import errno
import os
from typing import Any


class Full:
    """A file on a disk that is full after so many lines."""

    def __init__(self, file: Any, lines: int) -> None:
        self.file, self.left = file, lines

    def __getattr__(self, name: str) -> Any:
        return getattr(self.file, name)

    def __enter__(self) -> "Full":
        return self

    def __exit__(self, *_: object) -> None:
        self.file.close()

    def write(self, text: str) -> int:
        self.left -= 1
        if self.left < 0:
            self.file.write(text[: len(text) // 2])
            self.file.flush()
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return int(self.file.write(text))
