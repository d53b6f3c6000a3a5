"""Modes of small vibrations as rows of plain values: what tables, files, figures and pages say."""

from __future__ import annotations

import math

from ribbonopt.checks.modes import Modes
from ribbonopt.checks.parity import parities
from ribbonopt.plain import Row
from ribbonopt.solution.solution import Solution

from .digits import digits, upwards

HERTZ = "Hz"
IN, ACROSS = "in plane", "out of plane"
WHOLLY = 1e-6  # share of the kinetic energy that is none
#: columns of `modes.csv`, each a key of `modes` in `modes.json`
COLUMNS = ("number", "frequency", "error", "squared", "in_plane", "symmetry", "grows")


def rows_of(solution: Solution, modes: Modes) -> list[Row]:
    """Return a row for each mode, by the names of `COLUMNS`; None for what is not known.

    `frequency` is in `Modes.unit`, negative where the mode grows: then it is the rate; `error` is a
    bound of its relative error, `in_plane` the share of the kinetic energy in a planar ribbon's
    plane, `symmetry` "symmetric", "antisymmetric" or "".
    """
    return [
        {
            "number": i,
            "frequency": float(modes.frequencies[i - 1]),
            "error": known(modes.errors[i - 1]),
            "squared": float(modes.squared[i - 1]),
            "in_plane": known(modes.in_plane[i - 1]),
            "symmetry": symmetry,
            "grows": bool(modes.squared[i - 1] < 0),
        }
        for i, symmetry in enumerate(parities(solution, modes), start=1)
    ]


def known(value: float) -> float | None:
    """Return a number; None where it is none."""
    return float(value) if math.isfinite(value) else None


def plane_of(row: Row) -> str:
    """Say where a mode moves a planar ribbon; "" where it is not planar."""
    share = row["in_plane"]
    if share is None:
        return ""
    if share >= 1 - WHOLLY:
        return IN
    return ACROSS if share <= WHOLLY else f"{100 * share:.0f} % {IN}"


def frequency_of(row: Row, least: float = 0.0) -> str:
    """Return the size of a frequency to the last digit that its error leaves.

    `least` is a relative error below which more digits are of no use.
    """
    value, error = abs(row["frequency"]), row["error"]
    if error is None:
        return f"{value:.6g}"
    error = max(error, least)
    text = digits(value, error * value, 0 < value < 1e-3)
    return text if float(text) else f"0 ± {upwards(error * value)}"


def short_unit(unit: str) -> str:
    """Return what stands behind a number: nothing in units of its own, which are said once."""
    return f" {HERTZ}" if unit == HERTZ else ""


def words_of(row: Row) -> str:
    """Say of a mode what is known besides its frequency, in one line; may be empty."""
    grows = "grows, the number is its rate" if row["grows"] else ""
    return ", ".join(filter(None, (plane_of(row), row["symmetry"], grows)))
