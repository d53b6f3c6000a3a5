"""Modes of small vibrations as a page shows them: words, and how every row of a ribbon moves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.checks.modes import Modes
from ribbonopt.classes import dataclass
from ribbonopt.output.modes_rows import HERTZ, bar_of, value_of, words_of
from ribbonopt.plain import Row
from ribbonopt.views.moved import amplitude_of, carried
from ribbonopt.views.shape import Shape
from ribbonopt.views.subject import Subject

from .packing import packed_tables

ROUGH = 1e-4  # relative error of a number in a list
NATURAL = "√(Dw/\N{GREEK SMALL LETTER RHO}L⁴)"


@dataclass(frozen=True, eq=False)
class Motion:
    """Modes of the ribbon of a number, what is said of each, and which these are, if not all."""

    modes: Modes
    rows: Sequence[Row]
    which: str = ""
    ribbon: int = 0

    def reach(self, subject: Subject, axes: Array) -> Array:
        """Return the largest displacements (3,) along unit vectors (3, 3), at usual amplitudes."""
        found = np.zeros(3)
        for i, displacement in enumerate(self.modes.displacement):
            moved = np.abs(displacement @ axes.T).max(axis=0)
            found = np.maximum(found, amplitude_of(subject, self.modes, i) * moved)
        return found


def plain_motion(motion: Motion, subject: Subject, shape: Shape) -> dict[str, Any]:
    """Return what the page reads: see `page/motion.js`.

    `packed` are, for each mode, displacement and rotation of all rows of the shape, lab frame.
    """
    tables = [columns_of(motion.modes, i, shape.s) for i in range(len(motion.rows))]
    return {
        "shape": motion.ribbon,
        "count": len(shape.s),
        "packed": packed_tables(tables) if tables else "",
        "list": [
            {
                "name": named(row, motion.modes.unit),
                "told": told_of(row, motion.modes.unit, motion.which),
                "grows": row["grows"],
                "amplitude": amplitude_of(subject, motion.modes, i),
            }
            for i, row in enumerate(motion.rows)
        ],
    }


def columns_of(modes: Modes, number: int, s: Array) -> Array:
    """Return displacement and rotation at arclengths s (k,) as columns (6, k)."""
    return np.concatenate([vectors.T for vectors in carried(s, modes, number)])


def named(row: Row, unit: str) -> str:
    """Return a mode as it is chosen from a list."""
    return f"{row['number']}: {value_of(row, unit, ROUGH)}"


def told_of(row: Row, unit: str, which: str) -> str:
    """Return what is said of a mode while it is seen."""
    value = value_of(row, unit)
    if not row["grows"]:
        value = f"f = {value}" if unit == HERTZ else f"ω = {value} {NATURAL}"
    error = f"relative error {'not known' if row['error'] is None else f'≤ {bar_of(row)}'}"
    return "; ".join(filter(None, (value, words_of(row), error, which)))
