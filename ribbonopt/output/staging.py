"""Folders of results, and single files, that appear whole or not at all.

Files are written to `.NAME.new` beside the wanted place and take it when complete; an older result
steps aside as `.NAME.old` for that moment. Each place is locked by who writes there (`locks`), so
that what is found there under such a name is of a dead process: it is put right, then removed.
Other files are never touched.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from ribbonopt.classes import dataclass
from ribbonopt.errors import OutputError

from .declared import MODES_FILES, PAGE, PICTURES
from .disk import sync
from .locks import refuse_held
from .places import (
    LOCK,
    made_folders,
    place_of,
    refuse_foreign,
    refuse_irreplaceable,
    unwritable,
)
from .placing import beside, locked, place, put_right, recover

WAIT = 1.0  # seconds for who writes the result of a failed solve to the same place

#: files of a result that every version knows; others are declared by the folder itself
OWN_FILES = frozenset(
    (
        *("scene.yaml", "summary.json", "solution.npz", "equilibria"),
        *(PAGE, *PICTURES, *MODES_FILES),
    )
)


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
            place(self.folder, target, self.own, self.durable)
            return target
        target = target.with_name(f"{target.name}.{failure}")
        with locked(target, WAIT):
            recover(target)
            staged = beside(target)
            try:
                self.folder.replace(staged)  # under that name it is found after a kill
                place(staged, target, self.own, self.durable)
            finally:
                recover(target)
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
    refuse_foreign(target, own)
    refuse_irreplaceable(target, max(failures, key=len))
    folder = beside(target)
    with made_folders(target.parent), locked(target, wait):
        for failure in failures:
            put_right(target.with_name(f"{target.name}.{failure}"))
        try:
            recover(target)
            refuse_foreign(target, own)  # which may be another one now
            refuse_held(target / LOCK, target)
            folder.mkdir()
        except OutputError:  # an OSError too, but one that says what to do
            raise
        except OSError as error:
            raise unwritable(target, error) from error
        try:
            yield Stage(folder, target, own, durable)
        finally:
            recover(target)


def recovered(target: str | Path) -> Path:
    """Return a folder; a result that a process was just replacing when it died is put back."""
    target = Path(target)
    if target.name and not os.path.lexists(target):
        put_right(target)
    return target


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


def _failures() -> set[str]:
    """Return what a commit may be told there is instead of a result."""
    from ribbonopt.solvers.status import Status

    return {status.failure for status in Status} - {""}
