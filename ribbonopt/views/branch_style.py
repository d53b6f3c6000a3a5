"""How points and curves of a branch are drawn: by stability, and by what is special of a point."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from ribbonopt.plain import Row, Rows

from .branch_rows import FOLD, KINK, POINT, Plane
from .locus_style import MARKS, locus_of, styles_of_loci
from .style import BENDING, FAINT, INK, TWIST

#: one for each branch
COLOURS = (BENDING, TWIST, "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#7b3fa0", "#8a6d00")

STABLE, UNSTABLE, UNKNOWN = "stable", "unstable", "stability unknown"
BRANCH, BUCKLING, OTHER = "branch point", "buckling point", "other special point"
FIRST, LAST, NOTED = "first point", "last point", "note"
MARK: dict[str, Any] = {"ls": "", "zorder": 6}
OPEN: dict[str, Any] = MARK | {"mfc": "w", "mec": INK, "mew": 1.4}
STYLES: dict[str, dict[str, Any]] = {
    STABLE: {"ls": "-", "lw": 2.0},
    UNSTABLE: {"ls": (0, (3.5, 1.8)), "lw": 1.6},
    UNKNOWN: {"ls": (0, (1, 1.6)), "lw": 1.1},
    **styles_of_loci(),
    FIRST: {"ls": "", "marker": ".", "ms": 9, "color": FAINT, "zorder": 4},
    LAST: {"ls": "", "marker": "x", "ms": 5.5, "color": FAINT, "mew": 1.2, "zorder": 4},
    NOTED: OPEN | {"marker": "^", "ms": 5.5, "mec": TWIST, "mew": 1.2, "zorder": 5},
    FOLD: MARK | {"marker": "s", "ms": 6.5, "mfc": INK, "mec": "w", "mew": 0.8},
    BRANCH: OPEN | {"marker": "o", "ms": 7.5},
    BUCKLING: OPEN | {"marker": "D", "ms": 6.5},
    KINK: OPEN | {"marker": "v", "ms": 7.5},
    **MARKS,
    OTHER: OPEN | {"marker": "*", "ms": 9},
}
DOT: dict[str, Any] = {
    "marker": "o",
    "ms": 3.5,
    "zorder": 4.5,
}  # a point alone, or one that is pictured


def state_of(row: Row) -> str:
    """Return the style of curves at a point: of a branch by its stability, of a locus by its kind.

    What is stable beside a locus is not at the points of it, which have a neutral direction.
    """
    if found := locus_of(row):
        return found
    return UNKNOWN if row["negative"] is None else UNSTABLE if row["negative"] else STABLE


def marks_of(plane: Plane) -> dict[str, list[Row]]:
    """Return the rows that bear each mark."""
    drawn = [row for row in plane.figure.rows if np.isfinite(plane.points([row])).all()]
    last = {row["branch"]: row for row in drawn}.values()
    marked = {FIRST: drawn[:1], LAST: [row for row in last if row is not drawn[0]]}
    marked[NOTED] = [row for row in _changes_of_note(drawn) if row["kind"] == POINT]
    for row in drawn:
        if row["kind"] != POINT:
            marked.setdefault(mark_of(row), []).append(row)
    here = {row["number"] for row in plane.rows}
    return {name: [row for row in rows if row["number"] in here] for name, rows in marked.items()}


def mark_of(row: Row) -> str:
    """Return the mark of a special point."""
    return row["kind"] if row["kind"] in STYLES else OTHER


def _changes_of_note(rows: Rows) -> list[Row]:
    """Return the points that have a note, the first of those that follow one another with it."""
    found = [row for row in rows[:1] if row.get("note")]
    return found + [
        b
        for a, b in pairwise(rows)
        if b.get("note") and (b["note"] != a.get("note") or b["branch"] != a["branch"])
    ]
