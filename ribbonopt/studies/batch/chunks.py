"""Work for the workers: ribbons that differ little, in an order in which neighbours follow.

What a ribbon is solved from depends on its chunk alone, never on workers or their number: rows are
the same however many there are.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import RibbonoptError
from ribbonopt.plain import is_number
from ribbonopt.scene.yamlio import loads_scene

from .study import Study, StudyRibbon

Group = tuple[object, ...]
Numbers = tuple[float, ...]

LARGEST = 100  # ribbons of a chunk, the first of which starts from nothing
MANY = 20_000  # above, neighbours are found by sorting instead of one after another


@dataclass(frozen=True)
class Chunk:
    """Ribbons of one structure, each a neighbour of the one before."""

    ribbons: tuple[StudyRibbon, ...]


def chunks_of(study: Study) -> list[Chunk]:
    """Divide the ribbons of a study."""
    groups: dict[Group, list[StudyRibbon]] = {}
    points: dict[Group, list[Numbers]] = {}
    for ribbon in study.ribbons:
        group, point = _swept(ribbon) if ribbon.inputs else _plain(ribbon)
        groups.setdefault(group, []).append(ribbon)
        points.setdefault(group, []).append(point)
    return [
        Chunk(tuple(part))
        for group, ribbons in groups.items()
        for part in _parts([ribbons[i] for i in _order(np.array(points[group]))])
    ]


def _swept(ribbon: StudyRibbon) -> tuple[Group, Numbers]:
    """Group by the scene and all inputs but numbers; these are the place in it."""
    numbers = {k: v for k, v in ribbon.inputs.items() if is_number(v)}
    other = ribbon.common | {k: v for k, v in ribbon.inputs.items() if k not in numbers}
    group = ribbon.source, tuple(ribbon.inputs), repr(sorted(other.items()))
    return group, tuple(float(number) for number in numbers.values())


def _plain(ribbon: StudyRibbon) -> tuple[Group, Numbers]:
    """Group a scene by its structure; its numbers are the place in it."""
    from ribbonopt.problem import Posed  # only where scenes come as files

    try:
        scene = loads_scene(ribbon.source.text, ribbon.source.name, ribbon.overrides)
        posed = Posed.of(scene)
        return posed.structure, tuple(posed.values.tolist())
    except RibbonoptError:  # its row will say so
        return ("no scene", ribbon.number), ()


def _order(points: Array) -> list[int]:
    """Order points (k, d) so that each is the nearest of those left to the one before.

    In whatever order they are given, the result is the same.
    """
    count = len(points)
    if not points.size:
        return list(range(count))
    spans = np.ptp(points, axis=0)
    points = (points - points.min(axis=0)) / np.where(spans > 0, spans, 1.0)
    sorted_ = np.lexsort(points.T[::-1])
    if count > MANY:
        return [int(i) for i in sorted_]
    points, left = points[sorted_], np.ones(count, dtype=bool)
    order, at = [], 0
    for _ in range(count):
        left[at] = False
        order.append(int(sorted_[at]))
        at = int(np.where(left, np.abs(points - points[at]).sum(axis=1), np.inf).argmin())
    return order


def _parts(ribbons: list[StudyRibbon]) -> Iterator[list[StudyRibbon]]:
    """Yield chunks, about as many as there are ribbons in each, so that all cores end together."""
    size = min(math.isqrt(len(ribbons) - 1) + 1, LARGEST)
    for start in range(0, len(ribbons), size):
        yield ribbons[start : start + size]
