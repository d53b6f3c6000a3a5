"""Differences of rows of two batches, from their numbers and the one bound of each error."""

from __future__ import annotations

from typing import Any

import numpy as np

from ribbonopt.plain import Row
from ribbonopt.scene.quantities import START_VECTORS

GAPS = ("energy", "n0", "m0")
SPECIAL_GAPS = ("special1", "special2")  # those that are told of all ribbons together
SPECIALS, LISTED = "specials", 6  # of rows of branches: their special points; in columns
SMALL = 1e-9  # of the loads: a vector that small vanishes


def gaps_of(row: Row, other: Row | None, length: float | None) -> Row:
    """Return the relative differences of a row to that under the own law, with bars.

    `length` is the unit of length, by which forces and moments are compared; nothing where there is
    nothing to compare.
    """
    if other is None or row["law"] == other["law"] or length is None:
        return {}
    result = _special_gaps(row, other)
    if not (row["verified"] and other["verified"] and "energy" in row and "energy" in other):
        return result
    here, there = (_vectors(some, length) for some in (row, other))
    loads = max(float(np.linalg.norm(there[name])) for name in ("n0", "m0"))
    for name in GAPS:
        gap = here[name] - there[name]
        own = float(np.linalg.norm(there[name]))
        size = own if own > SMALL * loads else loads
        value = float(gap[0]) if name == "energy" else float(np.linalg.norm(gap))
        result[f"{name}_gap"] = value / size if size else None
        bars = [_bar(some, vectors, name) for some, vectors in ((row, here), (other, there))]
        known = [bar for bar in bars if bar is not None]
        bar = sum(known) + abs(value) / size * known[1] if len(known) == 2 and size else None
        result[f"{name}_gap_error"] = None if bar is None else bar / size
    return result


def with_special(row: Row) -> Row:
    """Return the row of a ribbon that was continued with its special points in columns.

    `special1`, `special1_kind` and `special1_error`, the bar of its value, and so on.
    """
    kept = {name: value for name, value in row.items() if name != SPECIALS}
    for i, point in enumerate(row.get(SPECIALS, [])[:LISTED], start=1):
        value, error = point[point["parameter"]], point["error"]
        kept |= {f"special{i}": value, f"special{i}_kind": point["kind"]}
        kept[f"special{i}_error"] = None if error is None else error * abs(value)
    return kept


def _special_gaps(row: Row, other: Row) -> Row:
    """Return by how much special points are elsewhere, each with the bars of both."""
    result: Row = {}
    for name in (f"special{i}" for i in range(1, LISTED + 1)):
        if name in row and name in other:
            bars = [some[f"{name}_error"] for some in (row, other)]
            result[f"{name}_gap"] = row[name] - other[name]
            result[f"{name}_gap_error"] = None if None in bars else sum(bars)
    return result


def _vectors(row: Row, length: float) -> dict[str, Any]:
    """Energy and loads of a row as vectors, all times such powers of the length as make moments."""
    n, m = (np.array([row[name] for name in names]) for names in START_VECTORS[:2])
    return {"energy": np.array([row["energy"]]), "n0": n * length, "m0": m}


def _bar(row: Row, vectors: dict[str, Any], name: str) -> float | None:
    """Return a bar from the relative bound of all of a row; loads are measured by the larger."""
    if row["error"] is None:
        return None
    parts = ("energy",) if name == "energy" else ("n0", "m0")
    largest = max(float(np.abs(vectors[part]).max()) for part in parts)
    return float(row["error"]) * largest * (1.0 if name == "energy" else 3**0.5)
