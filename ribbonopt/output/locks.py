"""Locks of places: one process at a time writes there, and a dead one holds nothing.

A lock is a file that the system locks for as long as its holder lives (`flock`, also over NFS;
`msvcrt` on Windows). Where a file system has no locks, the file says who holds it, and a holder of
this machine that has died is passed over.
"""

from __future__ import annotations

import errno
import os
import platform
import stat
import time
from contextlib import suppress
from pathlib import Path

from ribbonopt.classes import dataclass
from ribbonopt.errors import OutputError

NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.EOPNOTSUPP, errno.EINVAL, errno.EBADF)
TAKEN = (errno.EAGAIN, errno.EACCES, errno.EDEADLK)
OFTEN = 0.05  # seconds between two tries of one that waits
LONGEST = 200  # bytes of a lock file that are read


@dataclass(frozen=True, eq=False)
class Lock:
    """A lock that is held until it is released, or the process ends."""

    path: Path
    descriptor: int

    def release(self) -> None:
        """Give it up; its file goes first, so that nobody locks one that is about to go."""
        _remove(self.path, self.descriptor)
        with suppress(OSError):
            os.close(self.descriptor)


def take(path: Path, place: Path, wait: float = 0.0) -> Lock:
    """Lock a place by a file.

    Parameters
    ----------
    path
        The file, made if need be.
    place
        What it stands for, for messages.
    wait
        Seconds to wait for another holder.

    Raises
    ------
    OutputError
        If another process holds it.
    OSError
        If the file cannot be written.
    """
    end = time.monotonic() + wait
    while True:
        lock = _try(path)
        if lock is not None:
            return lock
        if time.monotonic() >= end:
            raise OutputError(f"{place}: is being written by another process{_holder(path)}")
        time.sleep(OFTEN)


def refuse_held(path: Path, place: Path) -> None:
    """Raise OutputError where another process holds a lock; the file of a dead one is removed."""
    with suppress(FileNotFoundError):
        lock = _try(path, make=False)
        if lock is None:
            raise OutputError(f"{place}: is being written by another process{_holder(path)}")
        lock.release()


def _try(path: Path, make: bool = True) -> Lock | None:
    """Return the lock, or None if another holds it."""
    while True:
        descriptor, made = _opened(path, make)
        try:
            if not stat.S_ISREG(os.fstat(descriptor).st_mode):
                raise OSError(errno.EEXIST, "its lock is no file", str(path))
            ours = _locked(descriptor)
            if ours is None:  # no locks here: who makes the file holds it
                ours = made
                if not made and _is_dead(_said(descriptor)):
                    _remove(path, descriptor)
                    os.close(descriptor)
                    continue
            if ours and _is_that(path, descriptor):
                os.ftruncate(descriptor, 0)
                os.lseek(descriptor, 0, os.SEEK_SET)
                os.write(descriptor, f"{os.getpid()} {platform.node()}\n".encode())
                return Lock(path, descriptor)
        except BaseException:
            if made:
                with suppress(OSError):
                    path.unlink()
            os.close(descriptor)
            raise
        os.close(descriptor)
        if not ours:
            return None  # else it was removed by a holder that has just ended: once more


def _opened(path: Path, make: bool) -> tuple[int, bool]:
    """Open a lock file; also return whether it was made."""
    flags = os.O_RDWR | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    while True:
        if make:
            with suppress(FileExistsError):
                return os.open(path, flags | os.O_CREAT | os.O_EXCL, 0o666), True
        try:
            return os.open(path, flags), False
        except FileNotFoundError:
            if not make:
                raise


def _locked(descriptor: int) -> bool | None:
    """Lock an open file: whether it is ours now, None where files cannot be locked."""
    try:
        if os.name == "nt":
            import msvcrt

            getattr(msvcrt, "locking")(descriptor, getattr(msvcrt, "LK_NBLCK"), 1)  # noqa: B009
        else:
            import fcntl

            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except ImportError:
        return None
    except OSError as error:
        if error.errno in TAKEN:
            return False
        if error.errno in NO_LOCKS:
            return None
        raise
    return True


def _is_that(path: Path, descriptor: int) -> bool:
    """Whether a path still is the file that was opened."""
    try:
        return os.path.samestat(os.stat(path, follow_symlinks=False), os.fstat(descriptor))
    except FileNotFoundError:
        return False


def _remove(path: Path, descriptor: int) -> None:
    with suppress(OSError):
        if _is_that(path, descriptor):
            path.unlink()


def _said(descriptor: int) -> str:
    os.lseek(descriptor, 0, os.SEEK_SET)
    return os.read(descriptor, LONGEST).decode(errors="replace").strip()


def _is_dead(said: str) -> bool:
    """Whether the holder that a lock file names was of this machine and has ended."""
    process, _, host = said.partition(" ")
    if os.name == "nt" or not host or host != platform.node() or not process.isdigit():
        return False
    try:
        os.kill(int(process), 0)  # asks only
    except ProcessLookupError:
        return True
    except (OSError, OverflowError):
        return False
    return False


def _holder(path: Path) -> str:
    """Say who holds a lock, as far as its file says, and what to do."""
    process, host = "", ""
    with suppress(OSError):
        descriptor, _ = _opened(path, make=False)
        try:
            process, _, host = _said(descriptor).partition(" ")
        finally:
            os.close(descriptor)
    who = f" ({process} on {host})" if process.isdigit() and host else ""
    return f"{who}; wait for its end, or stop it (if there is none, remove {path})"
