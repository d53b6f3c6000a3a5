"""Inputs of the ribbons of a study: the kinds of sweep, each read from plain data.

Rows are made when they are asked for: how many there are is known before any exists.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, overload

from ribbonopt.classes import dataclass
from ribbonopt.errors import SceneError
from ribbonopt.reading import Kind, read_text
from ribbonopt.scene.faults import InvalidSceneError, KeyPath, Problem, shown, suggestion
from ribbonopt.scene.yamlio import SCENE

from .draws import Draws
from .spaced import Spaced
from .tables import CSV, table_of

Inputs = dict[str, Any]


@dataclass(frozen=True)
class InputRows(Sequence[Inputs]):
    """Inputs of ribbons: how many, which keys they set, and each by its index."""

    size: int
    keys: tuple[str, ...]
    at: Callable[[int], Inputs]

    def __len__(self) -> int:
        """Return the number of ribbons."""
        return self.size

    @overload
    def __getitem__(self, index: int) -> Inputs: ...
    @overload
    def __getitem__(self, index: slice) -> list[Inputs]: ...
    def __getitem__(self, index: int | slice) -> Inputs | list[Inputs]:
        """Return the inputs of a ribbon."""
        if isinstance(index, slice):
            return [self.at(i) for i in range(*index.indices(self.size))]
        if not 0 <= index < self.size:
            raise IndexError(index)
        return self.at(index)

    def __iter__(self) -> Iterator[Inputs]:
        """Yield the inputs of all ribbons."""
        return map(self.at, range(self.size))


NOTHING = InputRows(1, (), lambda index: {})


def rows_of(folder: Path, sweep: Any) -> InputRows:
    """Return the inputs of a `sweep`: the product of all kinds that are given.

    Files are looked for in a folder. InvalidSceneError says what is wrong.
    """
    if not isinstance(sweep, dict) or not sweep:
        raise fault((), f"expected one or more of {', '.join(KINDS)}", sweep)
    parts: dict[str, InputRows] = {}
    for kind, value in sweep.items():
        if kind not in KINDS:
            known = f"unknown kind of sweep; expected {', '.join(KINDS)}"
            raise fault((kind,), known + suggestion(str(kind), KINDS))
        parts[kind] = KINDS[kind](folder, value)
        if not parts[kind].size:
            empty = [key for key, values in value.items() if values == []] if kind == "grid" else []
            raise fault((kind, *empty[:1]), "the sweep is empty; give it values")
        for other in list(parts)[:-1]:
            if twice := set(parts[kind].keys) & set(parts[other].keys):
                raise fault((kind, min(twice)), f"is swept by {other} already; keep one of them")
    return _product(list(parts.values()))


def fault(path: KeyPath, message: str, *found: Any) -> InvalidSceneError:
    """Return the error of a key of the study."""
    return InvalidSceneError([Problem(path, message, *(shown(value) for value in found))])


def text_of(path: Path, key: KeyPath = (), kind: Kind = SCENE) -> str:
    """Return the text of a file, that a key of the study names; SceneError if it cannot be read."""
    try:
        return read_text(path, kind)
    except SceneError as error:
        raise (fault(key, str(error)) if key else error) from None


def _product(parts: Sequence[InputRows]) -> InputRows:
    """All combinations, the last part changing fastest."""
    counts = [part.size for part in parts]

    def at(index: int) -> Inputs:
        chosen: Inputs = {}
        for part, i in zip(parts, _digits(index, counts), strict=True):
            chosen |= part.at(i)
        return chosen

    keys = tuple(key for part in parts for key in part.keys)
    return InputRows(math.prod(counts), keys, at)


def _digits(index: int, counts: Sequence[int]) -> list[int]:
    digits = []
    for count in reversed(counts):
        index, digit = divmod(index, count)
        digits.append(digit)
    return digits[::-1]


def _grid(_: Path, value: Any) -> InputRows:
    axes = _axes("grid", value)
    return _product([_column(key, values) for key, values in axes.items()])


def _zip(_: Path, value: Any) -> InputRows:
    axes = _axes("zip", value)
    lengths = {key: len(values) for key, values in axes.items()}
    if len(set(lengths.values())) > 1:
        found = ", ".join(f"{key}: {length}" for key, length in lengths.items())
        raise fault(("zip",), f"lists of unequal length ({found}); make them equal")
    count = next(iter(lengths.values()))
    return InputRows(count, tuple(axes), lambda i: {key: values[i] for key, values in axes.items()})


def _list(_: Path, value: Any) -> InputRows:
    if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
        example = "expected a list of mappings such as - {law.epsilon: 0.1}"
        raise fault(("list",), example, value)
    return _table([{str(key): item for key, item in row.items()} for row in value])


def _random(_: Path, value: Any) -> InputRows:
    draws = Draws.read(value)
    return InputRows(draws.count, tuple(draws.over), draws.row)


def _csv(folder: Path, value: Any) -> InputRows:
    if not isinstance(value, str):
        raise fault(("csv",), "expected the name of a CSV file", value)
    path = folder / value
    return _table(table_of(text_of(path, ("csv",), CSV), str(path)))


def _table(rows: list[Inputs]) -> InputRows:
    keys = tuple(dict.fromkeys(key for row in rows for key in row))
    return InputRows(len(rows), keys, rows.__getitem__)


def _column(key: str, values: Sequence[Any]) -> InputRows:
    return InputRows(len(values), (key,), lambda i: {key: values[i]})


def _axes(kind: str, value: Any) -> dict[str, Sequence[Any]]:
    if not isinstance(value, dict) or not value:
        example = "expected keys and their values, such as {law.epsilon: [0.1, 0.01]}"
        raise fault((kind,), example, value)
    return {str(key): _values((kind, key), item) for key, item in value.items()}


def _values(path: KeyPath, item: Any) -> Sequence[Any]:
    """Values of one key: a list, or numbers evenly spaced between two, or between two powers."""
    if isinstance(item, list):
        return item
    wanted = {"from", "to", "count"}
    if isinstance(item, dict) and wanted <= set(item) <= wanted | {"scale"}:
        spaced = Spaced(item["from"], item["to"], item["count"], item.get("scale", "linear"))
        if spaced.sound:
            return spaced
    example = "expected a list, or {from: 0, to: 1, count: 11} (scale: log for powers)"
    raise fault(path, example, item)


KINDS: Mapping[str, Callable[[Path, Any], InputRows]] = {
    "grid": _grid,
    "zip": _zip,
    "list": _list,
    "random": _random,
    "csv": _csv,
}
