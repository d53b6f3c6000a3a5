"""Modes of small vibrations as rows of plain values: what tables, files, figures and pages say."""

from __future__ import annotations

import math

from ribbonopt.checks.modes import Modes
from ribbonopt.checks.parity import parities
from ribbonopt.plain import Row
from ribbonopt.solution.solution import Solution

from .digits import SMALL, digits, upwards

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


def value_of(row: Row, unit: str, least: float = 0.0) -> str:
    """Return a frequency, or the rate at which a mode grows, with Hz or 1/s where it is in SI.

    It is written to the last digit that its error leaves; `least` is a relative error below which
    more digits are of no use.
    """
    cycles = 2 * math.pi if unit == HERTZ and row["grows"] else 1.0
    value, error = cycles * abs(row["frequency"]), row["error"]
    if error is None:
        number = f"{value:.6g}"
    else:
        error = max(error, least) * value
        number = digits(value, error, 0 < value < SMALL)
    if row["grows"]:
        return f"rate {number}{' /s' if unit == HERTZ else ''}"
    return f"{number}{' Hz' if unit == HERTZ else ''}"


def bar_of(row: Row) -> str:
    """Return the bound of the relative error."""
    return "not known" if row["error"] is None else upwards(row["error"])


def words_of(row: Row) -> str:
    """Say of a mode what is known besides its frequency, in one line; may be empty."""
    grows = "grows" if row["grows"] else ""
    return ", ".join(filter(None, (grows, plane_of(row), row["symmetry"])))
