"""Rows of a comparison as figures take them: which are shown, where they stand, what they say."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ribbonopt.plain import Row, Rows
from ribbonopt.text import drawn

FLOOR = 1e-16  # errors that happen to vanish are drawn here
# Frontiers that a row may be on: whoever is on one is on those before.
PAIR, OWN, OVERALL = ("pair", "formulation", "overall"), ("formulation", "overall"), ("overall",)
TIMES = "\u00d7"  # the sign
LEAST_X, LEAST_Y = 4.0, 2.0  # decades that a panel shows
ROOM = 0.16  # of the height of a panel below its points, for names
SHORT = {"shooting-gauss": "shooting"}

Point = tuple[float, float]


def shown(rows: Rows, floor: float = 0.0) -> list[Row]:
    """Return verified rows with time and error; below the floor errors mean nothing."""
    return answered([row for row in rows if row["verified"]], floor)


def answered(rows: Rows, floor: float = 0.0) -> list[Row]:
    """Return rows with time and error, of solvers or of peers."""
    told = [row for row in rows if row["error"] is not None and row["solve"]]
    return [row | {"error": max(row["error"], floor, FLOOR)} for row in told]


def best(rows: Rows, kinds: Sequence[str]) -> list[Row]:
    """Return the rows on frontiers of these kinds, the most accurate first."""
    return sorted((row for row in rows if row["frontier"] in kinds), key=lambda row: row["error"])


def at(row: Row) -> Point:
    """Return where a row stands: error, and time in ms."""
    return row["error"], 1e3 * row["solve"]


def xy(rows: Rows) -> tuple[list[float], list[float]]:
    """Return errors and times in ms."""
    return [at(row)[0] for row in rows], [at(row)[1] for row in rows]


def by_decade(rows: Rows) -> list[Row]:
    """Return the rows of a frontier that are the quickest to some power of ten."""
    found: dict[int, Row] = {}
    for row in sorted(rows, key=lambda row: -row["error"]):
        found.setdefault(math.floor(1e-9 - math.log10(at(row)[0])), row)
    return list(found.values())


def scheme_of(row: Row) -> str:
    """Return transcription and mesh: degree x intervals, or intervals x steps."""
    own = str(row["transcription"])
    name = SHORT.get(own, own)
    sizes = [row["degree"], row["intervals"]] if row["degree"] else [row["intervals"]]
    if row["steps"] > 1 or not row["degree"]:
        sizes.append(row["steps"])
    full = "" if row["states"] == "reduced" else f" {row['states']}"
    return f"{drawn(name)} {TIMES.join(map(str, sizes))}{full}"


def limits(rows: Rows) -> tuple[Point, Point]:
    """Return the limits of errors (large ones left) and of times in ms, with room for names."""
    errors = [math.log10(row["error"]) for row in rows] or [-1.0, -9.0]
    spans = [row[key] for row in rows for key in ("solve", "low", "high") if row[key]]
    times = [math.log10(1e3 * seconds) for seconds in spans] or [0.0, 2.0]
    left, right = _wide(max(errors) + 0.5, min(errors) - 0.8, LEAST_X)
    height = max(times) - min(times)
    bottom, top = _wide(min(times) - ROOM * height - 0.1, max(times) + 0.08 * height, LEAST_Y)
    return (10**left, 10**right), (10**bottom, 10**top)


def _wide(start: float, end: float, least: float) -> Point:
    """Return limits at least so far apart that some power of ten lies between them."""
    lacking = max(0.0, least - abs(end - start)) / 2
    sign = 1 if end > start else -1
    return start - sign * lacking, end + sign * lacking


def grouped(rows: Rows, key: str) -> dict[Any, list[Row]]:
    """Return rows by what they say under a key, in the order of the rows."""
    groups: dict[Any, list[Row]] = {}
    for row in rows:
        groups.setdefault(row[key], []).append(row)
    return groups
