"""One loader for all that is written: results, branches, batches and maps, told apart by files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from ribbonopt.errors import OutputError
from ribbonopt.output.results import load_solution
from ribbonopt.output.saved import NUMBERS, SUMMARY
from ribbonopt.output.staging import recovered
from ribbonopt.reading import is_file
from ribbonopt.scene import Scene
from ribbonopt.scene.faults import nearest
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers.status import Status
from ribbonopt.text import one_line

from .batch.saved import ROWS, STUDY
from .continuation.saved import FILE
from .maps.saved import FILE as MAP
from .maps.saved import JOBS

if TYPE_CHECKING:
    from .batch.results import Batch
    from .continuation.branch import Branch
    from .maps.map import Map

EXPECTED = "expected a folder written by ribbonopt solve, continue, batch or map, or a file in it"
#: what other verbs write, by the file that only they write
OTHERS = {
    "comparison.json": "a comparison (ribbonopt compare)",
    "laws.json": "a comparison of laws (ribbonopt compare --laws)",
    "benchmark.json": "a benchmark (ribbonopt bench)",
    "verification.json": "a verification (ribbonopt verify)",
    "stress.json": "a stress test (ribbonopt stress)",
}
YAML = (".yaml", ".yml")
#: what the name of a scene may have behind it as a folder: of its branch, of what failed
BESIDE = ("-branch", "-map", *dict.fromkeys(f".{way.failure}" for way in Status if way.failure))
SHOWN = 5  # results that a message names


def load(path: str | Path, scene: Scene | None = None) -> Solution | Branch | Batch | Map:
    """Load what `ribbonopt solve`, `continue`, `batch` or `map` has written.

    Parameters
    ----------
    path
        The folder, or any of the files in it.
    scene
        The scene of a solution that was declared in Python, so that no file says it.

    Returns
    -------
    Solution, Branch, Batch or Map
        A result, the points of a continuation, the rows of a study, the map of a scene.

    Raises
    ------
    OutputError
        If there is none of these, or its files are damaged. The message says what is there, and
        what may have been meant.
    """
    folder = folder_of(path)
    if is_file(folder / FILE):
        from .continuation.branch import Branch

        return Branch.load(folder)
    if is_file(folder / STUDY) or is_file(folder / ROWS):
        from .batch.results import Batch

        return Batch.load(folder)
    if is_file(folder / MAP) or is_file(folder / JOBS):
        from .maps.map import Map

        return Map.load(folder)
    return load_solution(folder, scene)


def folder_of(path: str | Path) -> Path:
    """Return the folder of a result, branch, batch or map, given by itself or by a file in it.

    Raises
    ------
    OutputError
        If it holds none of these. The message says what is there, and what may have been meant.
    """
    if "\0" in os.fspath(path):
        raise OutputError(f"{os.fspath(path)!r}: no such folder (it holds a null character)")
    given = recovered(path)
    if not os.path.lexists(given):
        raise OutputError(f"{path}: no such folder; {EXPECTED}{_meant(given)}")
    folder = given.parent if is_file(given) else given
    if is_file(folder / FILE) or is_file(folder / STUDY) or is_file(folder / ROWS):
        return folder
    if any(os.path.lexists(folder / name) for name in (SUMMARY, NUMBERS, MAP, JOBS)):
        return folder
    raise OutputError(f"{path}: {_found(given, folder)}; {EXPECTED}{_inside(folder)}")


def _meant(path: Path) -> str:
    """Return a suggestion for a path that is not there: what failed, a branch, the nearest name."""
    for ending in BESIDE:
        beside = path.with_name(f"{path.name}{ending}") if path.name else path
        if os.path.isdir(beside):
            return f"; did you mean {one_line(str(beside))}?"
    try:
        near = nearest(path.name, os.listdir(path.parent))
    except OSError:  # nor is the folder that it should be in
        return ""
    return f"; did you mean {one_line(str(path.with_name(near)))}?" if near else ""


def _found(given: Path, folder: Path) -> str:
    """Say what is there in the place of a result."""
    if given != folder:
        reads = "load_scene or load_study reads it" if given.suffix in YAML else "not in a result"
        return f"is a file, and no result of ribbonopt ({reads})"
    for name, what in OTHERS.items():
        if is_file(folder / name):
            return f"holds {what}, which has tables and no ribbons; read {name}"
    return "is a folder without a result of ribbonopt"


def _inside(folder: Path) -> str:
    """Name the results that are in a folder."""
    try:
        inner = sorted(path for path in folder.iterdir() if path.is_dir())
    except OSError:  # cannot be read: then nothing is known of it
        return ""
    marks = (FILE, STUDY, SUMMARY, MAP)
    found = [path for path in inner if any(is_file(path / mark) for mark in marks)]
    if not found:
        return ""
    names = ", ".join(one_line(str(path)) for path in found[:SHOWN])
    more = f" and {len(found) - SHOWN} more" if len(found) > SHOWN else ""
    return f"; it holds results: {names}{more}"
