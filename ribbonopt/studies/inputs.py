"""Inputs of the ribbons of a study: the kinds of sweep, each read from plain data."""

from __future__ import annotations

import csv
import io
import itertools
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ribbonopt.errors import SceneError
from ribbonopt.scene.yamlio import plain_yaml

from .draws import Draw, draws_of

Inputs = dict[str, Any]
KINDS = ("grid", "zip", "list", "random", "csv")


def inputs_of(file: Path, sweep: Any) -> Iterator[Inputs]:
    """Yield the inputs of all ribbons: the product of all kinds of sweep that are given."""
    if not isinstance(sweep, dict) or not sweep or any(kind not in KINDS for kind in sweep):
        raise SceneError(
            f"{file}: sweep: found {shown(sweep)}, expected one or more of {', '.join(KINDS)}"
        )
    readers = {"grid": _grid, "zip": _zip, "list": _list, "random": _random, "csv": _csv}
    kinds = [readers[kind](file, value) for kind, value in sweep.items()]
    for parts in itertools.product(*kinds):
        joined: Inputs = {}
        for part in parts:
            if twice := joined.keys() & part.keys():
                raise SceneError(f"{file}: sweep: {min(twice)} is swept twice; keep one of them")
            joined |= part
        yield joined


def _grid(file: Path, value: Any) -> list[Inputs]:
    axes = _axes(file, "grid", value)
    return [dict(zip(axes, row, strict=True)) for row in itertools.product(*axes.values())]


def _zip(file: Path, value: Any) -> list[Inputs]:
    axes = _axes(file, "zip", value)
    lengths = {key: len(values) for key, values in axes.items()}
    if len(set(lengths.values())) > 1:
        found = ", ".join(f"{key}: {length}" for key, length in lengths.items())
        raise SceneError(f"{file}: sweep.zip: lists of unequal length ({found}); make them equal")
    return [dict(zip(axes, row, strict=True)) for row in zip(*axes.values(), strict=True)]


def _list(file: Path, value: Any) -> list[Inputs]:
    if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
        raise SceneError(
            f"{file}: sweep.list: found {shown(value)}, expected a list of mappings such as "
            "- {law.epsilon: 0.1}"
        )
    return [{str(key): item for key, item in row.items()} for row in value]


def _random(file: Path, value: Any) -> list[Inputs]:
    try:
        return draws_of(Draw.read(value))
    except ValueError as error:
        raise SceneError(f"{file}: sweep.random: {error}") from None


def _csv(file: Path, value: Any) -> list[Inputs]:
    if not isinstance(value, str):
        raise SceneError(f"{file}: sweep.csv: found {value!r}, expected the name of a CSV file")
    path = file.parent / value
    rows = list(csv.reader(io.StringIO(text_of(path))))
    if not rows:
        raise SceneError(f"{path}: is empty; expected a line of keys and a line for each ribbon")
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(rows[0]):
            raise SceneError(
                f"{path}, line {line}: found {len(row)} values, expected {len(rows[0])}"
            )
    return [
        {key: plain_yaml(text, str(path)) for key, text in zip(rows[0], row, strict=True)}
        for row in rows[1:]
    ]


def _axes(file: Path, kind: str, value: Any) -> dict[str, list[Any]]:
    if not isinstance(value, dict) or not value:
        raise SceneError(
            f"{file}: sweep.{kind}: found {shown(value)}, expected keys and their values, such "
            "as {law.epsilon: [0.1, 0.01]}"
        )
    return {str(key): _values(file, f"sweep.{kind}.{key}", item) for key, item in value.items()}


def _values(file: Path, where: str, item: Any) -> list[Any]:
    """Values of one key: a list, or numbers evenly spaced between two, or between two powers."""
    if isinstance(item, list):
        return item
    wanted = {"from", "to", "count"}
    if isinstance(item, dict) and wanted <= set(item) <= wanted | {"scale"}:
        a, b, count, scale = item["from"], item["to"], item["count"], item.get("scale", "linear")
        sound = all(isinstance(n, int | float) for n in (a, b)) and isinstance(count, int)
        if sound and count >= 1 and (scale == "linear" or (scale == "log" and a > 0 and b > 0)):
            shares = [i / max(count - 1, 1) for i in range(count)]
            if scale == "log":
                return [float(a * (b / a) ** share) for share in shares]
            return [float(a + (b - a) * share) for share in shares]
    raise SceneError(
        f"{file}: {where}: found {shown(item)}, expected a list, or {{from: 0, to: 1, count: 11}} "
        "(scale: log for powers)"
    )


def text_of(path: Path) -> str:
    """Return the text of a file; SceneError if it cannot be read."""
    try:
        return path.read_text(encoding="utf-8-sig")
    except FileNotFoundError:
        raise SceneError(f"{path}: no such file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"{path}: cannot be read: {error}") from None


def shown(value: Any) -> str:
    """Return a value in few characters, for messages."""
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
