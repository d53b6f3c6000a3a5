"""Columns of rows by the words that users say for them: their own names, or what they end in."""

from __future__ import annotations

from collections.abc import Sequence

from ribbonopt.errors import SceneError
from ribbonopt.plain import Rows
from ribbonopt.scene.faults import shown, suggestion


def names_of(rows: Rows) -> list[str]:
    """Return the names of all columns, in the order in which rows have them."""
    return list(dict.fromkeys(name for row in rows for name in row))


def column_of(word: str, names: Sequence[str]) -> str:
    """Return the column that a word means: of its name or, where there is one, ending in it.

    So `angle` is `parameters.angle`, and `end.rotation` may be `boundary.end.rotation`.

    Raises
    ------
    SceneError
        If it means none, or several.
    """
    if word in names:
        return word
    found = [name for name in names if name.endswith(f".{word}")]
    if len(found) == 1:
        return found[0]
    if found:
        raise SceneError(f"found {shown(word)}, which may be each of {', '.join(found)}")
    short = [name.rpartition(".")[2] for name in names]
    near = suggestion(word, [*names, *short])
    raise SceneError(
        f"found {shown(word)}, expected a column of the rows{near}: {', '.join(names)}"
    )
