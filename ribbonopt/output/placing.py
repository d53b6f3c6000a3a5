"""How a complete folder takes its place, and how that is put right after a kill at any moment.

A folder is written as `.NAME.new`; an older result steps aside as `.NAME.old` for the moment in
which the new one takes its place. `.NAME.lock` is held all the while, so that who holds it finds
only what dead processes have left.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from itertools import count
from pathlib import Path

from ribbonopt.errors import OutputError

from .disk import sync, sync_all
from .locks import take
from .places import NEW, lock_beside, refuse_foreign, unwritable

OLD = ".old"


def put_right(target: Path) -> None:
    """Complete or remove what a dead process has left of a folder; not if another writes there."""
    if any(map(os.path.lexists, (beside(target), aside(target), lock_beside(target)))):
        with suppress(OSError), locked(target):
            recover(target)


def beside(path: Path) -> Path:
    """Return where a file or folder is for a moment, before it takes its place."""
    return path.with_name(f".{path.name}{NEW}")


def aside(target: Path) -> Path:
    """Return where an older result is for a moment."""
    return target.with_name(f".{target.name}{OLD}")


@contextmanager
def locked(target: Path, wait: float = 0.0) -> Iterator[None]:
    """Lock a folder that is replaced as a whole."""
    try:
        lock = take(lock_beside(target), target, wait)
    except OutputError:  # an OSError too, but one that says what to do
        raise
    except OSError as error:
        raise unwritable(target, error) from error
    try:
        yield
    finally:
        lock.release()


def place(staged: Path, target: Path, own: Collection[str], durable: bool) -> None:
    """Put a complete staging folder in the place of `target`, which may hold an older result."""
    old = aside(target)
    try:
        if durable:
            sync_all(staged)
    except OSError as error:
        raise unwritable(target, error) from error
    try:
        refuse_foreign(target, own)
        if os.path.lexists(target):
            target.replace(old)
        try:
            staged.replace(target)
        except OSError:
            if os.path.lexists(old):
                old.replace(target)
            raise
        if durable:
            sync(target.parent)
    except OSError as error:
        raise _kept(staged, target, error) from error


def _kept(staged: Path, target: Path, error: OSError) -> OutputError:
    """Put what cannot go where it should beside it, and return the error that says so."""
    names = (f"{target.name}.kept{number or ''}" for number in count())
    place = next(p for name in names if not os.path.lexists(p := target.with_name(name)))
    try:
        staged.replace(place)
    except OSError:
        return error if isinstance(error, OutputError) else unwritable(target, error)
    reason = str(error) if isinstance(error, OutputError) else f"{target}: {error.strerror}"
    return OutputError(f"{reason}; the result is kept in {place}")


def recover(target: Path) -> None:
    """Put a folder right whose writer has ended, whenever that was; its lock is held."""
    new, old = beside(target), aside(target)
    if os.path.lexists(old):
        if not os.path.lexists(target):
            # The old one steps aside for one that is complete only.
            (new if new.is_dir() else old).replace(target)
        _remove(old)
    _remove(new)


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)
