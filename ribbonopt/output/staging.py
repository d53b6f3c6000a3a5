"""Folders of results, and single files, that appear whole or not at all.

Files are written to `.NAME.new` beside the wanted place and take it when complete; an older result
steps aside as `.NAME.old` for that moment. Each place is locked by who writes there (`locks`), so
that what is found there under such a name is of a dead process: it is put right, then removed.
Other files are never touched.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import IO

from ribbonopt.errors import OutputError

from .declared import PICTURES
from .disk import sync, sync_all
from .locks import refuse_held, take
from .places import (
    LOCK,
    NEW,
    lock_beside,
    made_folders,
    place_of,
    refuse_foreign,
    refuse_irreplaceable,
    unwritable,
)

OLD = ".old"
WAIT = 1.0  # seconds for who writes the result of a failed solve to the same place

#: files of a result that every version knows; others are declared by the folder itself
OWN_FILES = frozenset(("scene.yaml", "summary.json", "solution.npz", "equilibria", *PICTURES))


@dataclass(frozen=True, eq=False)
class Stage:
    """A folder beside the wanted one, into which a result is written first."""

    folder: Path
    target: Path
    own: Collection[str]
    durable: bool = True

    def commit(self, failure: str = "") -> Path:
        """Put the files in place and return where: a failed solve never hides an older result.

        `failure` names what there is instead of a result, such as "not-converged".

        Raises
        ------
        OutputError
            If they cannot be put there (any more); then says where they are kept.
        """
        target = self.target
        if not failure:
            _place(self.folder, target, self.own, self.durable)
            return target
        target = target.with_name(f"{target.name}.{failure}")
        with _locked(target, WAIT):
            _recover(target)
            staged = beside(target)
            try:
                self.folder.replace(staged)  # under that name it is found after a kill
                _place(staged, target, self.own, self.durable)
            finally:
                _recover(target)
        return target


@contextmanager
def staged_result(
    target: str | Path,
    own: Collection[str] = OWN_FILES,
    *,
    wait: float = 0.0,
    durable: bool = True,
) -> Iterator[Stage]:
    """Give a stage to write into; what is not committed leaves no trace.

    Parameters
    ----------
    target
        Where the result is wanted.
    own
        The files that an older result may consist of, besides those that it declares: what would
        be replaced.
    wait
        Seconds to wait for another process that writes there.
    durable
        Whether the disk has the result when `commit` returns, which a power loss then spares.

    Raises
    ------
    OutputError
        If `target` cannot be written or replaced, is written by another process, is a file or a
        link, or holds files that are not a result.
    """
    target, failures = place_of(target), _failures()
    refuse_irreplaceable(target, max(failures, key=len))
    folder = beside(target)
    with made_folders(target.parent), _locked(target, wait):
        for failure in failures:
            put_right(target.with_name(f"{target.name}.{failure}"))
        try:
            _recover(target)
            refuse_foreign(target, own)
            refuse_held(target / LOCK, target)
            folder.mkdir()
        except OutputError:  # an OSError too, but one that says what to do
            raise
        except OSError as error:
            raise unwritable(target, error) from error
        try:
            yield Stage(folder, target, own, durable)
        finally:
            _recover(target)


def recovered(target: str | Path) -> Path:
    """Return a folder; a result that a process was just replacing when it died is put back."""
    target = Path(target)
    if target.name and not os.path.lexists(target):
        put_right(target)
    return target


def put_right(target: Path) -> None:
    """Complete or remove what a dead process has left of a folder; not if another writes there."""
    if any(map(os.path.lexists, (beside(target), _aside(target), lock_beside(target)))):
        with suppress(OSError), _locked(target):
            _recover(target)


def beside(path: Path) -> Path:
    """Return where a file or folder is for a moment, before it takes its place."""
    return path.with_name(f".{path.name}{NEW}")


@contextmanager
def replaced(path: Path) -> Iterator[Path]:
    """Give a path beside that of a file, which takes its place once it is complete.

    A link is replaced, not followed.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    new = beside(path)
    new.unlink(missing_ok=True)  # of a dead process, or a link
    try:
        yield new
        sync(new)
        new.replace(path)
    finally:
        with suppress(OSError):
            new.unlink(missing_ok=True)


@contextmanager
def replacing(
    path: Path, *, newline: str | None = None, errors: str | None = None
) -> Iterator[IO[str]]:
    """Give a text file that takes the place of another once it is complete; else the other stays.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    with (
        replaced(path) as new,
        open(new, "w", encoding="utf-8", newline=newline, errors=errors) as file,
    ):
        yield file


@contextmanager
def _locked(target: Path, wait: float = 0.0) -> Iterator[None]:
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


def _failures() -> set[str]:
    """Return what a commit may be told there is instead of a result."""
    from ribbonopt.solvers.status import Status

    return {status.failure for status in Status} - {""}


def _aside(target: Path) -> Path:
    """Return where an older result is for a moment."""
    return target.with_name(f".{target.name}{OLD}")


def _place(staged: Path, target: Path, own: Collection[str], durable: bool) -> None:
    """Put a complete staging folder in the place of `target`, which may hold an older result."""
    old = _aside(target)
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


def _recover(target: Path) -> None:
    """Put a folder right whose writer has ended, whenever that was; its lock is held."""
    new, old = beside(target), _aside(target)
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
