"""How loci look in diagrams and maps: lines by what they are of, marks by what is special there."""

from __future__ import annotations

from typing import Any

from ribbonopt.plain import Row

from .style import FAINT, INK, TWIST

OF = "of"  # the column of a locus: what each of its points is; a branch has none
CUSP = "cusp"
LOCUS = "locus of {}s"
#: by what a locus is of
LINES: dict[str, dict[str, Any]] = {
    "fold": {"color": INK, "ls": "-", "lw": 1.8},
    "branch point": {"color": TWIST, "ls": (0, (4, 1.8)), "lw": 1.8},
    "buckling point": {"color": "#0b7a53", "ls": (0, (1, 1.4)), "lw": 2.0},
}
OTHER_LINE: dict[str, Any] = {"color": FAINT, "ls": "-.", "lw": 1.5}
POINTED: dict[str, Any] = {"ls": "", "zorder": 6, "mec": INK, "mew": 1.1, "ms": 7}
YELLOW = "#f2c14e"
#: by what is special of a point of a locus
MARKS: dict[str, dict[str, Any]] = {
    CUSP: POINTED | {"marker": "^", "mfc": YELLOW, "ms": 8},
    "isola centre": POINTED | {"marker": "o", "mfc": YELLOW},
    "crossing": POINTED | {"marker": "X", "mfc": "w", "ms": 7.5},
    "double point": POINTED | {"marker": "D", "mfc": "w", "ms": 6},
    "turn": POINTED | {"marker": "|", "ms": 9, "mew": 1.4},
}


def locus_of(row: Row) -> str:
    """Return the words for the locus that a row is a point of; "" where it is one of a branch."""
    return LOCUS.format(row[OF]) if row.get(OF) else ""


def styles_of_loci() -> dict[str, dict[str, Any]]:
    """Return how lines of loci look, by the words for them."""
    return {LOCUS.format(kind): look for kind, look in LINES.items()}
