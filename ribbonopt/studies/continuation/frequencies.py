"""Columns of natural frequencies along a branch: `frequency1`, `squared1` and so on."""

from __future__ import annotations

from collections.abc import Iterable

from ribbonopt.plain import finite
from ribbonopt.scene import ContinuationStage
from ribbonopt.solution.solution import Solution

FREQUENCY, SQUARED = "frequency", "squared"


def names_of(stages: Iterable[ContinuationStage]) -> tuple[str, ...]:
    """Return the names of the columns that stages ask for: frequencies, then their squares."""
    most = max((stage.modes for stage in stages), default=0)
    return tuple(f"{kind}{i + 1}" for kind in (FREQUENCY, SQUARED) for i in range(most))


def frequencies(solution: Solution, count: int) -> dict[str, float | None]:
    """Return the lowest frequencies and their squares, by column; none where there are none."""
    from ribbonopt.checks.modes import modes_of  # builds second derivatives

    found = modes_of(solution, count)
    if isinstance(found, str):
        return {}
    pairs = zip(found.frequencies, found.squared, strict=True)
    row: dict[str, float] = {}
    for i, (frequency, squared) in enumerate(pairs, 1):
        row |= {f"{FREQUENCY}{i}": float(frequency), f"{SQUARED}{i}": float(squared)}
    numbers: dict[str, float | None] = finite(row)
    return numbers
