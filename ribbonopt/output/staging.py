"""Folders of results, and single files, that appear whole or not at all.

Files are written to a folder beside the wanted one, which takes its place when complete. An older
result there is replaced; other files are never touched.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from ribbonopt.errors import OutputError

from .declared import PICTURES, foreign_in

#: files of a result that every version knows; others are declared by the folder itself
OWN_FILES = frozenset(("scene.yaml", "summary.json", "solution.npz", "equilibria", *PICTURES))


@dataclass(frozen=True, eq=False)
class Stage:
    """A folder beside the wanted one, into which a result is written first."""

    folder: Path
    target: Path
    own: Collection[str]

    def commit(self, failure: str = "") -> Path:
        """Put the files in place and return where: a failed solve never hides an older result.

        `failure` names what there is instead of a result, such as "not-converged".
        """
        target = self.target
        if failure:
            target = target.with_name(f"{target.name}.{failure}")
            _refuse_foreign(target, self.own)
        _replace(target, self.folder)
        return target


@contextmanager
def staged_result(target: str | Path, own: Collection[str] = OWN_FILES) -> Iterator[Stage]:
    """Give a stage to write into; what is not committed leaves no trace.

    `own` names the files that an older result may consist of, besides those that it declares: what
    would be replaced.

    Raises
    ------
    OutputError
        If `target` cannot be written, is a file, or holds files that are not a result.
    """
    target = Path(target)
    _refuse_foreign(target, own)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        folder = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
        folder.chmod(0o777 & ~_umask())
    except OSError as error:
        raise unwritable(target, error) from error
    try:
        yield Stage(folder, target, own)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def beside(path: Path) -> Path:
    """Return where a file is for a moment, before it takes its place."""
    return path.with_name(f".{path.name}.new")


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
    new = beside(path)
    try:
        with open(new, "w", encoding="utf-8", newline=newline, errors=errors) as file:
            yield file
        new.replace(path)
    finally:
        with suppress(OSError):
            new.unlink(missing_ok=True)


def picture_folder(target: str | Path) -> Path:
    """Return a folder for pictures, made if need be; a file of a result stands for its folder.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    folder = Path(target)
    folder = folder.parent if folder.is_file() else folder
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise unwritable(folder, error) from error
    return folder


def _refuse_foreign(target: Path, own: Collection[str]) -> None:
    try:
        foreign = foreign_in(target, own) if target.exists() else []
    except NotADirectoryError as error:
        raise OutputError(f"{target}: is a file, expected a folder for results") from error
    except OSError as error:
        raise OutputError(f"{target}: cannot be read ({error.strerror})") from error
    if foreign:
        raise OutputError(
            f"{target}: holds files that are not a result of ribbonopt ({', '.join(foreign[:3])}); "
            "choose a new or an empty folder"
        )


def _replace(target: Path, staging: Path) -> None:
    """Put the complete staging folder in the place of `target`, which may hold an older result."""
    try:
        if target.exists():
            retired = Path(tempfile.mkdtemp(prefix=f".{target.name}.old.", dir=target.parent))
            target.replace(retired)
            try:
                staging.replace(target)
            except OSError:
                retired.replace(target)
                raise
            shutil.rmtree(retired, ignore_errors=True)
        else:
            staging.replace(target)
    except OSError as error:
        raise unwritable(target, error) from error


def unwritable(target: Path, error: OSError) -> OutputError:
    """Return the error of a place that cannot be written."""
    return OutputError(f"{target}: cannot be written ({error.strerror}); choose another folder")


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
