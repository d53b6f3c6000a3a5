"""Why ribbons failed: groups of the same status and the same message but for its numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence

from ribbonopt.classes import dataclass
from ribbonopt.plain import Row, Rows
from ribbonopt.text import marked_up

from .columns import is_logarithmic, is_numeric, numbers, words

NUMERIC = re.compile(r"[-+]?\d+(\.\d*)?(e[-+]?\d+)?", re.IGNORECASE)
NUMBERED = 20  # ribbons of a group that are named
WORDS = 4  # values of a group that are named
KINDS = 50  # groups that are told


@dataclass(frozen=True)
class Failure:
    """Ribbons that failed alike; the message is that of the first."""

    status: str
    message: str
    rows: tuple[Row, ...]


def failures_of(rows: Rows) -> list[Failure]:
    """Group the rows that are not verified, the largest group first."""
    groups: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        if not row["verified"]:
            key = str(row["status"]), NUMERIC.sub("#", _message(row))
            groups.setdefault(key, []).append(row)
    found = [Failure(key[0], _message(group[0]), tuple(group)) for key, group in groups.items()]
    return sorted(found, key=lambda failure: -len(failure.rows))


def failures_html(rows: Rows, inputs: Sequence[str], colours: Mapping[str, str]) -> str:
    """Return a section of the report: a paragraph for each group, and where among the inputs.

    `colours` by status, as variables of the style sheet.
    """
    failures = failures_of(rows)
    if not failures:
        words = "Nothing: all verified." if rows else "No ribbon has been solved."
        return f"<h2>What failed</h2><p>{words}</p>"
    every = {key: numbers(rows, key) if is_numeric(rows, key) else [] for key in inputs}
    parts = []
    for failure in failures[:KINDS]:
        named = ", ".join(str(row["number"]) for row in failure.rows[:NUMBERED])
        more = len(failure.rows) - NUMBERED
        named += f" and {more} more" if more > 0 else ""
        ranges = "".join(
            _range(failure.rows, key, every[key]) if every[key] else _words(failure.rows, rows, key)
            for key in inputs
        )
        parts.append(
            f'<section class="why" style="border-color:var({colours[failure.status]})">'
            f"<h3>{len(failure.rows)} {marked_up(failure.status)}</h3>"
            f"<p>{marked_up(failure.message or 'no message')}</p>"
            f'<p class="faint">ribbon{"s" * (len(failure.rows) > 1)} {named}</p>'
            f"<dl>{ranges}</dl></section>"
        )
    if len(failures) > KINDS:
        rest = sum(len(failure.rows) for failure in failures[KINDS:])
        parts.append(f"<p>{rest} more failed in {len(failures) - KINDS} other ways.</p>")
    return f"<h2>What failed, and why</h2>{''.join(parts)}"


def _range(group: Rows, key: str, every: Sequence[float]) -> str:
    """Where the group lies among all numbers of an input; nothing for what does not vary."""
    values = numbers(group, key)
    if not values or min(every) == max(every):
        return ""
    low, high = min(values), max(values)
    left, right = (100 * _share(value, every) for value in (low, high))
    return (
        f'<dt>{marked_up(key)}</dt><dd><i class="track" title="of {min(every):.4g} to '
        f'{max(every):.4g}"><i style="left:{left:.1f}%;right:{100 - right:.1f}%"></i></i>'
        f"{low:.4g}{f' to {high:.4g}' if high > low else ''}</dd>"
    )


def _words(group: Rows, rows: Rows, key: str) -> str:
    """Which words of an input the group has; nothing for what does not vary."""
    some, total = words(group, key), len(words(rows, key))
    if not some or total < 2:
        return ""
    text = f"all {total} values" if len(some) == total else " | ".join(some[:WORDS])
    more = f" | {len(some) - WORDS} more" if WORDS < len(some) < total else ""
    return f"<dt>{marked_up(key)}</dt><dd>{marked_up(text + more)}</dd>"


def _share(value: float, every: Sequence[float]) -> float:
    """Place of a value between the least and the greatest."""
    low, high = min(every), max(every)
    if is_logarithmic(every):
        value, low, high = (math.log(number) for number in (value, low, high))
    return (value - low) / (high - low)


def _message(row: Row) -> str:
    """Message of a row, without the status that some begin with."""
    return str(row.get("message") or "").removeprefix(f"{row['status']}: ")
