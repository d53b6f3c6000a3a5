"""Modes of small vibrations as rows of plain values: what tables, files, figures and pages say."""

from __future__ import annotations

import math

import numpy as np

from ribbonopt.checks.modes import Modes
from ribbonopt.checks.parity import parities
from ribbonopt.checks.topology import closure
from ribbonopt.checks.vibrations.stated import SYMMETRIC
from ribbonopt.plain import Row
from ribbonopt.solution.solution import Solution

from .digits import SMALL, digits, upwards

HERTZ = "Hz"
IN, ACROSS = "in plane", "out of plane"
TWIST = "twist"
WHOLLY = 1e-6  # share of the kinetic energy, or of a displacement over a turn, that is none
#: columns of `modes.csv`, each a key of `modes` in `modes.json`
COLUMNS = ("number", "frequency", "error", "squared", "in_plane", "symmetry", "twist", "grows")


def rows_of(solution: Solution, modes: Modes) -> list[Row]:
    """Return a row for each mode, by the names of `COLUMNS`; None for what is not known.

    `frequency` is in `Modes.unit`, negative where the mode grows: then it is the rate; `error` is a
    bound of its relative error, `in_plane` the share of the kinetic energy in a planar ribbon's
    plane, `symmetry` "symmetric", "antisymmetric" or "", `twist` whether the line stays at rest.
    """
    moved, turned = (
        np.linalg.norm(shapes, axis=2).max(axis=1)
        for shapes in (modes.displacement, modes.rotation)
    )
    still = moved <= WHOLLY * (modes.s[-1] - modes.s[0]) * turned
    return [
        {
            "number": i,
            "frequency": float(modes.frequencies[i - 1]),
            "error": known(modes.errors[i - 1]),
            "squared": float(modes.squared[i - 1]),
            "in_plane": known(modes.in_plane[i - 1]),
            "symmetry": symmetry,
            "twist": bool(still[i - 1]),
            "grows": bool(modes.squared[i - 1] < 0),
        }
        for i, symmetry in enumerate(parities(solution, modes), start=1)
    ]


def which_of(solution: Solution, modes: Modes) -> str:
    """Say which modes these are, where they are not all; "" where they are."""
    start, end = solution.scene.interval
    if modes.told or modes.s[-1] > end + WHOLLY * (end - start):
        return modes.told
    # A piece of a band may be told by its conditions alone, which say nothing of symmetry.
    band = closure(solution)
    return SYMMETRIC if band is not None and band.pieces > 1 else ""


def known(value: float) -> float | None:
    """Return a number; None where it is none."""
    return float(value) if math.isfinite(value) else None


def plane_of(row: Row) -> str:
    """Say where a mode moves a planar ribbon, or that it only twists one; else ""."""
    share = row["in_plane"]
    if row["twist"]:
        return TWIST
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
