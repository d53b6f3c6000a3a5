"""Work for the workers: ribbons that differ little, in an order in which neighbours follow.

What a ribbon is solved from depends on its chunk alone, never on workers or their number: rows are
the same however many there are.
"""

from __future__ import annotations

import math

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.errors import RibbonoptError
from ribbonopt.plain import is_number
from ribbonopt.scene.yamlio import loads_scene

from .chain import chain
from .study import Study, StudyRibbon

Group = tuple[object, ...]
Numbers = tuple[float, ...]

LARGEST = 100  # ribbons of a chunk, the first of which starts from nothing


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
    chunks = []
    for group, ribbons in groups.items():
        # About as many chunks as there are ribbons in each, so that all cores end together.
        size = min(math.isqrt(len(ribbons) - 1) + 1, LARGEST)
        order = chain(np.array(points[group]), size)
        walked = [ribbons[i] for i in order]
        chunks += [Chunk(tuple(walked[k : k + size])) for k in range(0, len(walked), size)]
    return chunks


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
