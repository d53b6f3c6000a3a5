"""Tables that a scene names by their files, read and embedded: a scene holds its numbers.

Messages quote nothing of a file, which may be another than was meant.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator

from ribbonopt.errors import SceneError
from ribbonopt.reading import MEGA, Kind, read_text

from .along import Table, TableFile, numbers_along
from .faults import Problem, quotable
from .lens import replaced
from .limits import ROWS
from .model import Scene

TABLE = Kind("a text of rows s, value", most=10 * MEGA, error=SceneError)


def embedded(scene: Scene, folder: str) -> tuple[Scene, list[Problem]]:
    """Return a scene whose tables are numbers, and what is wrong with the files of the others.

    Parameters
    ----------
    scene
        A scene whose single values are valid.
    folder
        What paths of files are relative to.
    """
    problems = []
    for path, value in list(numbers_along(scene)):
        if isinstance(value, TableFile):
            try:
                scene = replaced(scene, path, _table(value, folder))
            except SceneError as error:
                problems.append(Problem((*path, "file"), str(error)))
            except _ColumnError as error:
                problems.append(Problem((*path, "column"), str(error)))
    return scene, problems


class _ColumnError(Exception):
    """A column that is not there, or is not named."""


def _table(named: TableFile, folder: str) -> Table:
    source = os.path.join(folder, named.file)
    lines = list(_lines(read_text(source, TABLE)))
    names = lines.pop(0)[1] if lines and not any(map(_seems_number, lines[0][1])) else None
    if len(lines) > ROWS:
        remedy = f"; thin it, for example by every {-(-len(lines) // ROWS)}th of its rows"
        raise SceneError(f"{source}: has {len(lines):,} rows, expected at most {ROWS}{remedy}")
    width = len(names or (lines[0][1] if lines else ("s", "value")))
    column = _column(named.column, names, width, source)
    for number, words in lines:
        if len(words) != width or not all(map(_is_number, words)):
            expected = f"expected {width} numbers, with commas or blanks between"
            raise SceneError(f"{source}, line {number}: {expected}")
    rows = [(float(words[0]), float(words[column])) for _, words in lines]
    return Table(tuple(s for s, _ in rows), tuple(value for _, value in rows))


def _lines(text: str) -> Iterator[tuple[int, list[str]]]:
    """Yield the words of the lines that have any, with the number of the line."""
    for number, line in enumerate(text.splitlines(), 1):
        line = line.partition("#")[0].strip()
        if line:
            yield (
                number,
                [word.strip() for word in (line.split(",") if "," in line else line.split())],
            )


def _seems_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _is_number(word: str) -> bool:
    return _seems_number(word) and math.isfinite(float(word)) and "_" not in word


def _column(name: str | None, names: list[str] | None, width: int, source: str) -> int:
    """Return the index of the column of the values."""
    if name is None:
        if width != 2:
            has = f"{source}: has {width} column{'s' if width > 1 else ''}"
            raise SceneError(f"{has}, expected two, s and value; of more, name one: column: NAME")
        return 1
    if names is None:
        raise _ColumnError(
            f"{source}: names no columns; give them in its first row, or remove this"
        )
    if name not in names[1:]:
        raise _ColumnError(f"{source}: has no column {quotable(name)} after its first, which is s")
    return names.index(name, 1)
