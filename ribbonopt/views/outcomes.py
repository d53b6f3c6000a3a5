"""What the rows of a batch hold, column by column, and why ribbons failed: for pictures of it.

Rows are plain mappings, one for each ribbon: `number`, the inputs that were swept, `status`,
`verified`, `message`, and numbers that came out, which failed ribbons may lack.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

Row = Mapping[str, Any]
Rows = Sequence[Row]

VERIFIED = "verified"
LOADS, MOMENTS, STRAINS = ("n0x", "n0y", "n0z"), ("m0x", "m0y", "m0z"), ("u2", "u3")
FIRST = ("energy", "H0", *LOADS, *MOMENTS, *STRAINS, "error")
LAST = ("iterations", "seconds")
WORDS = ("number", "scene", "status", "verified", "message", "start", "path")
DECADES = 50  # largest by smallest value, beyond which a column is better seen by its logarithm
NOISE = 1e-9  # relative differences below this are rounding
BINS = (6, 24)  # of a histogram, least and most
MOST_BARS = 60  # of a histogram with a bar for each value


@dataclass(frozen=True)
class Column:
    """One quantity of all rows.

    Attributes
    ----------
    name : str
        Key of the rows.
    values : tuple of float or None
        A number for each row, None where there is none; of words, which of the categories.
    categories : tuple of str
        The words, in order of appearance; none for numbers.
    log : bool
        Whether it is better seen on a logarithmic axis.
    """

    name: str
    values: tuple[float | None, ...]
    categories: tuple[str, ...] = ()
    log: bool = False

    @property
    def known(self) -> list[float]:
        """The values that are there."""
        return [value for value in self.values if value is not None]

    def varies(self, scale: float = 0.0) -> bool:
        """Whether the values differ by more than rounding, of themselves or of a scale."""
        if self.categories:
            return len(self.categories) > 1
        known = self.known
        largest = max([scale, *map(abs, known)])
        return bool(known) and max(known) - min(known) > NOISE * largest


@dataclass(frozen=True)
class Bar:
    """A bar of a histogram, from left to right (of logarithms if the column is)."""

    left: float
    right: float
    verified: int
    failed: int


@dataclass(frozen=True)
class Failure:
    """Ribbons that failed alike: the same status, the same message but for its numbers."""

    status: str
    message: str
    rows: tuple[Row, ...]


def numbered(rows: Iterable[Row]) -> list[Row]:
    """Return rows in the order of their numbers."""
    return sorted(rows, key=lambda row: int(row["number"]))


def outcome(row: Row) -> str:
    """Return how a ribbon ended, in words."""
    if row.get("verified"):
        return VERIFIED
    status = str(row.get("status") or "unknown").replace("_", " ")
    return f"{status}, not verified" if status == "converged" else status


def columns_of(rows: Rows, inputs: Sequence[str]) -> dict[str, Column]:
    """Return all columns with values: number, inputs, scene, status, what came out, cost."""
    found = dict.fromkeys(key for row in rows for key in row)
    others = [key for key in found if key not in (*WORDS, *FIRST, *LAST, *inputs)]
    scenes = ["scene"] if len({str(row.get("scene")) for row in rows}) > 1 else []
    names = ["number", *inputs, *scenes, "status", *FIRST, *others, *LAST]
    columns = [column_of(rows, name) for name in dict.fromkeys(names)]
    return {column.name: column for column in columns if column.known}


def column_of(rows: Rows, name: str) -> Column:
    """Return a column: of numbers if all values there are, otherwise of words."""
    if name == "status":
        return _words(name, [outcome(row) for row in rows])
    given = [row.get(name) for row in rows]
    if any(value is not None and not _is_number(value) for value in given):
        return _words(name, [None if value is None else said(value) for value in given])
    values = tuple(map(_finite, given))
    known = [value for value in values if value is not None]
    wide = bool(known) and min(known) > 0 and max(known) > DECADES * min(known)
    return Column(name, values, log=wide and name != "number")


def varying(columns: Mapping[str, Column], names: Iterable[str]) -> list[Column]:
    """Columns that vary; a component of a vector by more than rounding of the whole vector."""
    scales: dict[str, float] = {}
    for vector in (LOADS, MOMENTS, STRAINS):
        parts = [columns[name].known for name in vector if name in columns]
        largest = max((abs(value) for part in parts for value in part), default=0.0)
        scales |= dict.fromkeys(vector, largest)
    wanted = [columns[name] for name in names if name in columns]
    return [column for column in wanted if column.varies(scales.get(column.name, 0.0))]


def bars_of(column: Column, verified: Sequence[bool]) -> list[Bar]:
    """Return a histogram: a bar for each value if they recur, else bins of equal width."""
    if not column.known:
        return []
    places = [
        (math.log10(value) if column.log else float(value), good)
        for value, good in zip(column.values, verified, strict=True)
        if value is not None
    ]
    low, high = min(places)[0], max(places)[0]
    width = high - low or abs(low) / 10 or 1.0
    # Values that differ by rounding belong to one bar.
    shares = [(round((place - low) / width, 9), good) for place, good in places]
    distinct = sorted({share for share, _ in shares})
    if column.categories or len(distinct) == 1 or 2 * len(distinct) <= len(shares) <= 1e9:
        if len(distinct) <= MOST_BARS or column.categories:
            gap = min((b - a for a, b in pairwise(distinct)), default=1.0)
            half = max(0.4 * gap, 0.004)
            edges = [(share - half, share + half) for share in distinct]
            slots = {share: i for i, share in enumerate(distinct)}
            return _counted(edges, [(slots[share], good) for share, good in shares], low, width)
    count = min(max(round(math.sqrt(len(shares))), BINS[0]), BINS[1])
    edges = [(i / count, (i + 1) / count) for i in range(count)]
    binned = [(min(int(share * count), count - 1), good) for share, good in shares]
    return _counted(edges, binned, low, width)


def failures_of(rows: Rows) -> list[Failure]:
    """Group the rows that failed by status and message, the largest group first."""
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        if not row.get("verified"):
            key = outcome(row), re.sub(r"[-+]?\d+(\.\d+)?([eE][-+]?\d+)?", "#", message_of(row))
            groups.setdefault(key, []).append(row)
    found = [Failure(key[0], message_of(group[0]), tuple(group)) for key, group in groups.items()]
    return sorted(found, key=lambda failure: -len(failure.rows))


def message_of(row: Row) -> str:
    """Return the message of a row, without the status that some begin with."""
    return str(row.get("message") or "").removeprefix(f"{row.get('status')}: ")


def said(value: object) -> str:
    """Return a value as a scene would say it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        return ", ".join(f"{key}: {said(item)}" for key, item in value.items())
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(said, value))}]"
    return "null" if value is None else str(value)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _finite(value: Any) -> float | None:
    try:
        return value if value is not None and math.isfinite(value) else None
    except OverflowError:  # an integer beyond all floats
        return None


def _words(name: str, words: Sequence[str | None]) -> Column:
    places: dict[str, int] = {}
    for word in words:
        if word is not None:
            places.setdefault(word, len(places))
    values = tuple(None if word is None else places[word] for word in words)
    return Column(name, values, tuple(places))


def _counted(
    edges: Sequence[tuple[float, float]],
    placed: Iterable[tuple[int, bool]],
    low: float,
    width: float,
) -> list[Bar]:
    counts = [[0, 0] for _ in edges]
    for slot, good in placed:
        counts[slot][not good] += 1
    return [
        Bar(low + left * width, low + right * width, *count)
        for (left, right), count in zip(edges, counts, strict=True)
    ]
