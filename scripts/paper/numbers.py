"""The numbers beside a panel: each with its bar, and what the paper prints or what is known."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

DIGITS = 9  # significant, at most
ROUNDING = 1e-9  # what is smaller and has no bar is an error: one digit tells it


class Number(NamedTuple):
    """One number of a panel.

    Attributes
    ----------
    name
        As it is written under the panel; may hold mathematics between dollars.
    value
        What was computed.
    paper
        As the paper prints it, or empty.
    bar
        Bound of its absolute error; None where there is none.
    """

    name: str
    value: float
    paper: str = ""
    bar: float | None = None

    @property
    def written(self) -> str:
        """The value with the digits that its bar leaves."""
        if self.value == 0 or (self.bar is not None and abs(self.value) <= self.bar):
            return "0" if self.bar is None else f"0 ± {self.bar:.0e}"
        if self.bar is None:
            return f"{self.value:.5g}" if abs(self.value) > ROUNDING else f"{self.value:.0e}"
        first = math.floor(math.log10(abs(self.value)))
        decimals = max(min(-math.ceil(math.log10(2 * max(self.bar, 1e-16))), DIGITS - 1 - first), 0)
        return f"{self.value:.{decimals}f} ± {self.bar:.0e}"

    @property
    def as_printed(self) -> str:
        """The value rounded as the paper rounds it; empty where it prints none."""
        if not self.paper:
            return ""
        decimals = len(self.paper.partition(".")[2])
        return f"{round(self.value, decimals) + 0.0:.{decimals}f}"  # + 0.0: no -0


class Table(NamedTuple):
    """The numbers of one panel."""

    figure: str
    panel: str
    rows: Sequence[Number]


def write_numbers(tables: Sequence[Table], folder: Path) -> None:
    """Write `numbers.json` and `numbers.csv`, the same numbers, into a folder."""
    rows = [_row(table, number) for table in tables for number in table.rows]
    text = json.dumps(rows, indent=1, ensure_ascii=False)
    (folder / "numbers.json").write_text(text + "\n", encoding="utf-8")
    write_columns({name: [row[name] for row in rows] for name in rows[0]}, folder / "numbers.csv")


def write_columns(columns: Mapping[str, Sequence[Any]], path: Path) -> None:
    """Write columns of one length as CSV."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*columns.values(), strict=True))


def plain(name: str) -> str:
    """Return a name without the marks of mathematics."""
    for mark, word in (("$", ""), (r"\leq", "<="), ("\\", "")):
        name = name.replace(mark, word)
    return name


def _row(table: Table, number: Number) -> dict[str, Any]:
    return {
        "figure": table.figure,
        "panel": table.panel,
        "name": plain(number.name),
        "value": number.value,
        "bar": number.bar,
        "paper": number.paper,
        "rounded": number.as_printed,
    }
