"""Work for the workers: ribbons that differ little, in an order in which neighbours follow.

What a ribbon is solved from depends on its chunk alone, never on workers or their number: rows are
the same however many there are.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from .sweep import Ribbon, Study

# Ribbons of a chunk, the first of which starts from nothing, and chunks of a group if they may be
# larger: enough for all cores to end together.
SMALLEST, LARGEST, CHUNKS = 25, 100, 40
MANY = 20_000  # above, neighbours are found by sorting instead of one after another


@dataclass(frozen=True)
class Chunk:
    """Ribbons of one structure, each a neighbour of the one before."""

    ribbons: tuple[Ribbon, ...]


def chunks_of(study: Study) -> list[Chunk]:
    """Divide the ribbons of a study."""
    groups: dict[tuple[object, ...], list[Ribbon]] = {}
    for ribbon in study.ribbons:
        groups.setdefault(_structure(ribbon), []).append(ribbon)
    return [Chunk(tuple(part)) for group in groups.values() for part in _parts(_in_order(group))]


def _structure(ribbon: Ribbon) -> tuple[object, ...]:
    """Return what ribbons that can follow each other share: the scene and all but its numbers."""
    other = {k: v for k, v in ribbon.inputs.items() if not _is_number(v)}
    return ribbon.source.name, tuple(ribbon.inputs), repr(sorted(other.items()))


def _in_order(group: Sequence[Ribbon]) -> list[Ribbon]:
    """Return ribbons so that each is the nearest of those left to the one before."""
    keys = [key for key, value in group[0].inputs.items() if _is_number(value)]
    if not keys or len(group) < 3:
        return list(group)
    points = np.array([[float(ribbon.inputs[key]) for key in keys] for ribbon in group])
    spans = np.ptp(points, axis=0)
    points = (points - points.min(axis=0)) / np.where(spans > 0, spans, 1.0)
    if len(group) > MANY:
        return [group[int(i)] for i in np.lexsort(points.T[::-1])]
    left = np.ones(len(group), dtype=bool)
    at = int(np.lexsort(points.T[::-1])[0])
    order = [at]
    left[at] = False
    for _ in range(len(group) - 1):
        gaps = np.where(left, np.abs(points - points[at]).sum(axis=1), np.inf)
        at = int(gaps.argmin())
        order.append(at)
        left[at] = False
    return [group[i] for i in order]


def _parts(ribbons: list[Ribbon]) -> Iterator[list[Ribbon]]:
    size = min(max(len(ribbons) // CHUNKS, SMALLEST), LARGEST)
    for start in range(0, len(ribbons), size):
        yield ribbons[start : start + size]


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
