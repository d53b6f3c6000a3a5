"""Folders that files are written to one by one: batches, branches, pictures."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ribbonopt.errors import OutputError

from .declared import (
    BATCH_PICTURES,
    BRANCH_PICTURES,
    MAP_PICTURES,
    MODES_PICTURES,
    PAGE,
    PICTURES,
)
from .locks import refuse_held, take
from .places import (
    LOCK,
    NEW,
    lock_beside,
    made_folders,
    place_of,
    refuse_foreign,
    refuse_links,
    unwritable,
)
from .placing import OLD, beside, put_right

DRAWN = (
    *PICTURES,
    *MODES_PICTURES,
    *BRANCH_PICTURES,
    *BATCH_PICTURES,
    *MAP_PICTURES,
    PAGE,
)


@contextmanager
def claimed(folder: str | Path, own: Collection[str], *, alone: bool = True) -> Iterator[Path]:
    """Lock a folder, made if need be, and give its path.

    What dead processes have left there is removed, and a folder that stays empty too.

    Parameters
    ----------
    folder
        Where.
    own
        Names of the files that are written there, besides those that it declares.
    alone
        Whether it may hold no others.

    Raises
    ------
    OutputError
        If it cannot be written, is written by another process, is a link or holds one by the name
        of a file of ours, or holds other files.
    """
    folder = place_of(folder)
    with made_folders(folder):
        if alone:
            refuse_foreign(folder, own)
        try:
            lock = take(folder / LOCK, folder)
        except OutputError:  # an OSError too, but one that says what to do
            raise
        except NotADirectoryError as error:
            raise OutputError(f"{folder}: is a file, expected a folder for results") from error
        except OSError as error:
            raise unwritable(folder, error) from error
        try:
            if folder.name:
                refuse_held(lock_beside(folder), folder)
            if alone:  # once more: meanwhile another may have come and gone
                refuse_foreign(folder, own)
            refuse_links(folder, own)
            with suppress(OSError):
                for name in own:
                    beside(folder / name).unlink(missing_ok=True)
            yield folder
        finally:
            lock.release()


@contextmanager
def pictures_in(target: str | Path) -> Iterator[Path]:
    """Give a folder for pictures, made if need be; a file of a result stands for its folder.

    Raises
    ------
    OutputError
        If it cannot be written, or is written by another process.
    """
    folder = Path(target)
    with claimed(folder.parent if folder.is_file() else folder, DRAWN, alone=False) as found:
        yield found


def put_all_right(folder: Path) -> None:
    """Complete or remove what dead processes have left of results in a folder of many."""
    names = os.listdir(folder) if folder.is_dir() else []
    for name in names:
        for ending in (NEW, OLD, LOCK):
            if name.startswith(".") and name[1:].endswith(ending):
                put_right(folder / name[1 : -len(ending)])
