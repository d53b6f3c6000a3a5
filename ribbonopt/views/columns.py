"""Columns of plain rows: which there are, and what numbers they hold."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any

Row = Mapping[str, Any]
Rows = Sequence[Row]

WIDE = 50.0  # largest over smallest value, from which axes are logarithmic


def columns(rows: Rows) -> list[str]:
    """Return the names of all columns, in the order in which they first appear."""
    return list(dict.fromkeys(name for row in rows for name in row))


def numbers(rows: Rows, name: str) -> list[float]:
    """Return the finite numbers of a column."""
    return [float(row[name]) for row in rows if is_number(row.get(name))]


def varied(rows: Rows, name: str) -> list[float]:
    """Return the numbers of a column, none if they are all the same but for rounding."""
    values = numbers(rows, name)
    if not values or max(values) - min(values) <= 1e-9 * max(abs(value) for value in values):
        return []
    return values


def is_numeric(rows: Rows, name: str) -> bool:
    """Whether a column holds numbers, and nothing else but gaps."""
    values = [row.get(name) for row in rows]
    return any(map(is_number, values)) and all(is_number(v) or is_missing(v) for v in values)


def is_number(value: Any) -> bool:
    """Whether a value is a finite number."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def is_missing(value: Any) -> bool:
    """Whether a value says nothing."""
    return value is None or (isinstance(value, float) and not math.isfinite(value))


def is_logarithmic(values: Sequence[float]) -> bool:
    """Whether numbers are better seen by their powers."""
    return bool(values) and min(values) > 0 and max(values) > WIDE * min(values)


def said(value: Any) -> str:
    """Return a value in words, nothing for a gap."""
    if is_missing(value):
        return ""
    if isinstance(value, float):
        return f"{value:.6g}"
    return value if isinstance(value, str) else json.dumps(value)
