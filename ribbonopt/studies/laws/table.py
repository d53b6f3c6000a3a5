"""A comparison of laws as aligned plain text; only the command line prints it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ribbonopt.output.digits import digits, upwards
from ribbonopt.plain import Row
from ribbonopt.studies.comparison.table import aligned

from .compare import LawComparison

HEAD = ("law", "numbers", "energy", "|n(0)|", "|m(0)|", "|u(0)|", "seconds", "status")
GAPS = ("difference to {0}", "shape / L", "energy", "n(0)", "m(0)")
PERCENT = 100.0


def table(study: LawComparison) -> str:
    """Return two tables, of values and of differences, with bars; then reasons and notes."""
    solved = [row for row in study.rows if row["verified"]]
    lines = [f"{study.name} under {len(solved)} laws; units {study.units}", ""]
    lines += aligned([HEAD, *(_values(row) for row in study.rows if "energy" in row)])
    others = [row for row in solved if "shape_gap" in row]
    if others:
        head = tuple(text.format(study.reference) for text in GAPS)
        lines += ["", *aligned([head, *(_gaps(row) for row in others)], left=1)]
    return "\n".join([*lines, *told(study.rows)])


def _values(row: Row) -> tuple[str, ...]:
    cells = (_barred(row, name) for name in ("energy", "n0", "m0", "u0"))
    return row["law"], row["numbers"], *cells, seconds(row), status(row)


def _gaps(row: Row) -> tuple[str, ...]:
    percent = (_barred(row, f"{name}_gap", PERCENT) for name in ("energy", "n0", "m0"))
    return row["law"], _barred(row, "shape_gap"), *(f"{text} %" for text in percent)


def _barred(row: Row, name: str, factor: float = 1.0) -> str:
    """Write a number with its bar, and no digit that stands in doubt."""
    value, bar = row[name], row[f"{name}_error"]
    return barred(value, bar, factor)


def barred(value: float | None, bar: float | None, factor: float = 1.0) -> str:
    """Write a number and its bar, both times a factor."""
    if value is None:
        return "-"
    error = None if bar is None else factor * bar
    text = digits(factor * value, error, small=0 < abs(factor * value) < 1e-3)
    return f"{text} +- {'?' if error is None else upwards(error)}"


def seconds(row: Row) -> str:
    """Write the time of a row."""
    return f"{row['seconds']:.2f}" if row.get("seconds") is not None else "-"


def status(row: Row) -> str:
    """Write how a row ended."""
    return str(row["status"]).replace("_", " ")


def told(rows: Sequence[Row]) -> list[str]:
    """Return lines on laws that carry nothing, with the reason, and on what is to be known."""
    failed = [row for row in rows if not row["verified"]]
    lines = _listed("no solution:", ((row["law"], _reason(row)) for row in failed))
    notes = ((row["law"], row["note"]) for row in rows if row["note"])
    lines += _listed("notes:", notes)
    starts: dict[str, list[str]] = {}
    for row in rows:
        if row["verified"] and row.get("start"):
            starts.setdefault(row["start"], []).append(row["law"])
    lines += _listed("found by:", ((", ".join(laws), start) for start, laws in starts.items()))
    return lines


def _reason(row: Row) -> str:
    return str(row["message"]) or status(row)


def _listed(head: str, found: Iterable[tuple[Any, str]]) -> list[str]:
    lines = [f"  {name}: {text}" for name, text in found]
    return ["", head, *lines] if lines else []
