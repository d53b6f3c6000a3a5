"""Columns of plain rows: which there are, and what numbers they hold."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ribbonopt.plain import SPECIALS, Rows, is_number
from ribbonopt.scene.quantities import ANSWERS, START_VECTORS

ColumnPair = tuple[str, str]
"""Names of two columns, of what is drawn along x and y."""

WIDE = 50.0  # largest over smallest value, from which axes are logarithmic
NOISE = 1e-9  # relative differences below this are rounding
LEAST = 1e-4  # size that numbers of any column may be expected to have
COSTS = ("start", "iterations", "path", "seconds", "note", "message")


def columns(rows: Rows, inputs: Sequence[str] = ()) -> list[str]:
    """Return the names of all columns: inputs, how it ended, what came out, what it cost."""
    found = list(dict.fromkeys(name for row in rows for name in row if name != SPECIALS))
    first = ("number", "scene", *inputs, "status", "verified", *ANSWERS, "error")
    others = [name for name in found if name not in (*first, *COSTS)]
    return [name for name in dict.fromkeys((*first, *others, *COSTS)) if name in found]


def numbers(rows: Rows, name: str) -> list[float]:
    """Return the finite numbers of a column."""
    return [float(row[name]) for row in rows if is_number(row.get(name))]


def varied(rows: Rows, name: str) -> list[float]:
    """Return the numbers of a column, none if they are all the same but for rounding.

    A component of a vector is measured by the vector: what symmetry makes zero is no column.
    """
    values = numbers(rows, name)
    vector = next((vector for vector in START_VECTORS if name in vector), (name,))
    largest = max((abs(value) for part in vector for value in numbers(rows, part)), default=0.0)
    largest = max(largest, LEAST)
    return values if values and max(values) - min(values) > NOISE * largest else []


def words(rows: Rows, name: str) -> list[str]:
    """Return the words of a column, each once, in the order in which they come."""
    found = (as_text(row.get(name)) for row in rows if not is_missing(row.get(name)))
    return list(dict.fromkeys(found))


def is_numeric(rows: Rows, name: str) -> bool:
    """Whether a column holds numbers, and nothing else but gaps."""
    values = [row.get(name) for row in rows]
    return any(map(is_number, values)) and all(is_number(v) or is_missing(v) for v in values)


def is_missing(value: Any) -> bool:
    """Whether a value says nothing."""
    return value is None or (isinstance(value, float) and not math.isfinite(value))


def is_logarithmic(values: Sequence[float]) -> bool:
    """Whether numbers are better seen by their powers."""
    return bool(values) and min(values) > 0 and max(values) > WIDE * min(values)


def as_text(value: Any) -> str:
    """Return a value in words, as a scene would say it; nothing for a gap."""
    if is_missing(value):
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, Mapping):
        return ", ".join(f"{key}: {as_text(item)}" for key, item in value.items())
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(as_text, value))}]"
    return str(value)
