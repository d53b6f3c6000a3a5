"""Where results may go: what cannot be written or replaced is refused before solving."""

from __future__ import annotations

import os
import stat
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ribbonopt.errors import OutputError

from .declared import foreign_in

LONGEST = 255  # bytes of a name that file systems take
LOCK, NEW = ".lock", ".new"


def place_of(path: str | Path) -> Path:
    """Return the path of a folder for results, by a name of its own.

    Raises
    ------
    OutputError
        If it is a link, which is not followed, or can be the path of nothing.
    """
    if "\0" in str(path):
        raise OutputError(f"{str(path)!r}: cannot be written (it holds a null character)")
    path = Path(path)
    if path.name in ("", ".."):  # such as `.`
        path = Path(os.path.realpath(path))
    try:
        if path.is_symlink():
            raise OutputError(
                f"{path}: {_link(path)}; links are not followed, name the place itself"
            )
    except OutputError:  # an OSError too, but one that says what to do
        raise
    except OSError as error:
        raise unwritable(path, error) from error
    return path


@contextmanager
def made_folders(folder: Path) -> Iterator[None]:
    """Make a folder and those that it is in; those that were made, and stay empty, go again.

    Raises
    ------
    OutputError
        If it cannot be made.
    """
    made: list[Path] = []
    try:
        try:
            missing = folder
            while not missing.exists():
                if missing.is_symlink():
                    raise OutputError(f"{missing}: {_link(missing)}; choose another folder")
                made.insert(0, missing)
                missing = missing.parent
            for path in made:
                path.mkdir(exist_ok=True)
        except OutputError:  # an OSError too, but one that says what to do
            raise
        except OSError as error:
            raise unwritable(folder, error) from error
        yield
    finally:
        for path in reversed(made):
            with suppress(OSError):
                path.rmdir()


def refuse_foreign(folder: Path, own: Collection[str]) -> None:
    """Refuse a folder of other files than `own` ones and those that it declares.

    Raises
    ------
    OutputError
        If there is one, or the folder is a file or cannot be read.
    """
    try:
        names = foreign_in(folder, own) if folder.exists() else []
    except NotADirectoryError as error:
        raise OutputError(f"{folder}: is a file, expected a folder for results") from error
    except OSError as error:
        raise OutputError(f"{folder}: cannot be read ({error.strerror})") from error
    mine = {LOCK, *(f".{name}{NEW}" for name in own)}  # of a process that was killed there
    if foreign := [name for name in names if name not in mine]:
        raise OutputError(
            f"{folder}: holds files that are not a result of ribbonopt ({', '.join(foreign[:3])}); "
            "choose a new or an empty folder"
        )


def refuse_links(folder: Path, own: Collection[str]) -> None:
    """Raise OutputError where a file of ours in a folder is a link: it is not written through."""
    for path in (folder / name for name in sorted(own)):
        if path.is_symlink():
            raise OutputError(
                f"{path}: {_link(path)}; links are not followed, remove it or choose another folder"
            )


def refuse_irreplaceable(target: Path, ending: str) -> None:
    """Refuse a folder that another cannot take the place of.

    `ending` is the longest that a name beside it may have.

    Raises
    ------
    OutputError
        If it cannot be moved: of this process, of a disk, of another user, or read-only.
    """
    if not target.name:
        raise _fixed(target, "it is the root of the file system")
    if len(os.fsencode(lock_beside(target.with_name(f"{target.name}.{ending}")).name)) > LONGEST:
        raise OutputError(
            f"{target}: its name is too long ({len(os.fsencode(target.name))} bytes); choose a "
            "shorter one"
        )
    if not target.is_dir():
        return
    real = Path(os.path.realpath(target))
    with suppress(FileNotFoundError):  # the working folder was removed
        here = Path(os.path.realpath(os.getcwd()))
        if real == here or real in here.parents:
            raise _fixed(target, "the working folder is in it")
    if os.path.ismount(target):
        raise _fixed(target, "a file system is mounted there")
    if not os.access(target, os.W_OK | os.X_OK):
        raise _fixed(target, "it is read-only")
    if hasattr(os, "geteuid") and os.geteuid() != 0:
        parent, own = target.parent.stat(), target.stat()
        if parent.st_mode & stat.S_ISVTX and os.geteuid() not in (parent.st_uid, own.st_uid):
            raise _fixed(target, "it belongs to another user")


def lock_beside(folder: Path) -> Path:
    """Return the lock of a folder that is replaced as a whole."""
    return folder.with_name(f".{folder.name}{LOCK}")


def unwritable(target: Path, error: OSError) -> OutputError:
    """Return the error of a place that cannot be written."""
    if target.name.startswith(".") and target.name.endswith(NEW):  # on the way to its place
        target = target.with_name(target.name[1 : -len(NEW)])
    return OutputError(
        f"{target}: cannot be written ({error.strerror or error}); choose another folder"
    )


def _fixed(target: Path, reason: str) -> OutputError:
    return OutputError(f"{target}: cannot be replaced ({reason}); choose a new folder")


def _link(path: Path) -> str:
    if not path.exists():
        return f"is a link to {os.readlink(path)}, which is not there"
    return f"is a link to {os.path.realpath(path)}"
