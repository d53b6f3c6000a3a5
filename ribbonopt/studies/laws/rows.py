"""Rows of a comparison of laws: plain values under names that stay."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ribbonopt.plain import Row, finite

from .choice import Choice
from .described import Described, differences
from .solved import Outcome, told_of

VALUES = ("energy", "n0", "m0", "u0")
#: differences to the reference, relative: shape over the length, energy, loads at the start
GAPS = ("shape", "energy", "n0", "m0")
LEFT_OUT = "left out"


def columns() -> tuple[str, ...]:
    """Return the columns of the table: every value and every difference with its bar."""
    values = [part for name in VALUES for part in (name, f"{name}_error")]
    gaps = [part for name in GAPS for part in (f"{name}_gap", f"{name}_gap_error")]
    words = ("start", "message", "note", "seconds", "other_start_seconds")
    return ("law", "numbers", "status", "verified", *values, *gaps, *words)


def row_of(choice: Choice, found: Outcome | None, reference: Described | None) -> Row:
    """Return the row of a law; `found` is None where it was left out.

    Sizes of n(0), m(0) and u(0) are in units of the scene, differences are relative.
    """
    row = begun(choice)
    if found is None:
        return row
    notes = [choice.note, found.lost if found.verified else "", told_of(found)]
    row |= {
        "status": found.status,
        "verified": found.verified,
        "start": found.start,
        "message": found.message if found.verified else _both(found),
        "note": "; ".join(filter(None, notes)),
        "seconds": found.seconds,
        "other_start_seconds": found.checked,
    }
    if found.verified and found.solution is not None:
        here = Described(found.solution)
        if reference is not None and reference.solution is found.solution:
            here = reference
        for name, (value, bar) in here.values.items():
            row |= {name: value, f"{name}_error": bar}
        if reference is not None and reference is not here:
            for name, (value, bar) in differences(here, reference).items():
                row |= {f"{name}_gap": value, f"{name}_gap_error": bar}
        row["curves"] = here.curves
    plain: Row = finite(row)
    return plain


def begun(choice: Choice) -> Row:
    """Return the row of a law of which nothing is known yet but its numbers."""
    return {
        "law": choice.name,
        "numbers": written(choice.numbers),
        "status": LEFT_OUT,
        "verified": False,
        "message": choice.reason,
        "note": choice.note,
    }


def written(numbers: Mapping[str, float]) -> str:
    """Return the numbers of a law as text."""
    return ", ".join(f"{name} = {value:.6g}" for name, value in numbers.items())


def table_row(row: Row) -> dict[str, Any]:
    """Return a row without its curves."""
    return {name: value for name, value in row.items() if name != "curves"}


def _both(found: Outcome) -> str:
    return "; ".join(filter(None, [found.lost, found.message]))
