"""Files from outside, read in one way: whatever a path leads to, reading it ends.

Regular files are read, and pipes where a kind of file may come from one (`ribbonopt solve <(...)`),
never more of them than that kind may have; devices, sockets and folders are refused. What is wrong
is told in one message, which quotes nothing of the file: it may be one that is not for all eyes.
"""

from __future__ import annotations

import os
import stat
import time
from collections.abc import Iterator
from typing import Any, NoReturn

from ribbonopt.classes import dataclass

from .errors import OutputError, RibbonoptError
from .plain import parsed

PATIENCE = 10.0  # seconds that all of a pipe may take to come
PIECE = 2**20
MEGA = 10**6

Path = str | os.PathLike[str]


@dataclass(frozen=True)
class Kind:
    """A kind of file.

    Attributes
    ----------
    name : str
        What is expected, in words.
    most : int
        Bytes that it may have.
    error : type
        What is raised where it cannot be read.
    piped : bool
        Whether it may come from a pipe.
    line : int
        Bytes that a line of it may have, where it is read by lines.
    remedy : str
        What to do where one is damaged.
    """

    name: str
    most: int
    error: type[RibbonoptError] = OutputError
    piped: bool = False
    line: int = 64 * MEGA
    remedy: str = ""

    def damaged(self, source: Path, fault: str) -> RibbonoptError:
        """Return the error of a file that is not as it was written."""
        remedy = self.remedy or f"expected {self.name}"
        return self.error(f"{os.fspath(source)}: is damaged ({fault}); {remedy}")


def read_bytes(path: Path, kind: Kind) -> bytes:
    """Return all that a file holds; raises the error of its kind."""
    with _Opened(path, kind) as file:
        pieces, size = [], 0
        while piece := file.next():
            pieces.append(piece)
            size += len(piece)
            if size > kind.most:
                file.refuse_size()
        return b"".join(pieces)


def read_text(path: Path, kind: Kind) -> str:
    """Return a text in UTF-8, with or without a byte order mark; raises the error of its kind."""
    data = read_bytes(path, kind)
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        utf16 = data[:2] in (b"\xff\xfe", b"\xfe\xff")
        remedy = "; it seems to be in UTF-16: save it in UTF-8" if utf16 else ""
        message = f"{os.fspath(path)}: not a text in UTF-8 (byte {error.start}){remedy}"
        raise kind.error(message) from None


def read_json(path: Path, kind: Kind) -> Any:
    """Return what a file of JSON says; raises the error of its kind."""
    text = read_text(path, kind)
    try:
        return parsed(text)
    except ValueError as error:
        raise kind.damaged(path, str(error)) from None


def read_lines(path: Path, kind: Kind) -> Iterator[bytes]:
    """Yield the lines of a file with their ends; raises the error of its kind."""
    with _Opened(path, kind) as file:
        rest: list[bytes] = []
        size = 0
        while piece := file.next():
            *whole, last = piece.split(b"\n")
            for line in whole:
                yield b"".join([*rest, line, b"\n"])
                rest, size = [], 0
            rest.append(last)
            size += len(last)
            if size > kind.line:
                file.refuse(f"has a line of more than {kind.line // MEGA} MB")
        if size:
            yield b"".join(rest)


def is_file(path: Path) -> bool:
    """Whether a path leads to a regular file; False where nobody can tell."""
    try:
        return os.path.isfile(path)
    except ValueError:  # a path that no system has
        return False


class _Opened:
    """An open file, given piece by piece."""

    def __init__(self, path: Path, kind: Kind) -> None:
        self.source, self.kind = os.fspath(path), kind
        flags = os.O_RDONLY
        for name in ("O_BINARY", "O_CLOEXEC", "O_NOCTTY", "O_NONBLOCK"):
            flags |= getattr(os, name, 0)  # not to wait for the writer of a pipe, for one
        try:
            self._refuse_odd(os.stat(path).st_mode)  # before it is opened, which may do things
            self._file = os.open(path, flags)
        except FileNotFoundError:
            raise kind.error(f"{self.source}: no such file") from None
        except (OSError, ValueError) as error:
            if isinstance(error, RibbonoptError):
                raise
            self._refuse_for(error)

    def __enter__(self) -> _Opened:
        try:
            found = os.fstat(self._file)
            self._refuse_odd(found.st_mode)
            self._pipe = stat.S_ISFIFO(found.st_mode)
            if found.st_size > self.kind.most:
                self.refuse_size()
        except BaseException:
            os.close(self._file)
            raise
        self._end = time.monotonic() + PATIENCE
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._file)

    def next(self) -> bytes:
        """Return the next piece, nothing at the end."""
        while True:
            if self._pipe:
                self._wait()
            try:
                return os.read(self._file, PIECE)
            except BlockingIOError:
                if not self._pipe:
                    self.refuse("gives nothing at once")
            except OSError as error:
                self._refuse_for(error)

    def refuse(self, fault: str) -> NoReturn:
        """Raise the error of a file that is no such file."""
        raise self.kind.error(f"{self.source}: {fault}; expected {self.kind.name}") from None

    def refuse_size(self) -> NoReturn:
        """Raise the error of a file that is too large."""
        self.refuse(f"is larger than {self.kind.most // MEGA} MB")

    def _refuse_for(self, error: Exception) -> NoReturn:
        reason = getattr(error, "strerror", None) or error
        raise self.kind.error(f"{self.source}: cannot be read: {reason}") from None

    def _refuse_odd(self, mode: int) -> None:
        if stat.S_ISREG(mode) or (stat.S_ISFIFO(mode) and self.kind.piped):
            return
        odd = {stat.S_ISDIR: "directory", stat.S_ISFIFO: "pipe", stat.S_ISSOCK: "socket"}
        word = next((word for has, word in odd.items() if has(mode)), "device")
        self.refuse(f"is a {word}")

    def _wait(self) -> None:
        """Wait until a pipe has more, or has ended."""
        import select

        if not hasattr(select, "poll"):
            self.refuse("is a pipe")
        look = select.poll()
        look.register(self._file, select.POLLIN)
        left = max(self._end - time.monotonic(), 0.0)
        if not look.poll(1000 * left):
            self.refuse(f"is a pipe that did not end within {PATIENCE:g} s; write a file first")
