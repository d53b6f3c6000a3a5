"""Regions: the rectangle of two parameters as loci cut it, each with a point inside and neighbours.

No two equilibria meet or part inside a region: how many there are is the same all over it, and one
point tells.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from .crossings import net_of
from .faces import Face, faces_of
from .inner import innermost
from .lines import joined

NARROW = 1e-3  # of the square: regions whose innermost point is nearer to a locus are not counted
NOTHING = 1e-9  # area of what rounding leaves between lines


@dataclass(frozen=True, eq=False)
class Region:
    """One region, in the unit square.

    Attributes
    ----------
    face : Face
        Its border.
    point : Array
        Its innermost point (2,).
    clear : float
        How far that is from the border.
    beside : dict
        Its neighbours by number, each with the lines between, and how long these are there.
    """

    face: Face
    point: Array
    clear: float
    beside: dict[int, dict[int, float]]

    @property
    def narrow(self) -> bool:
        """Whether it is too narrow for a point that is surely inside."""
        return bool(self.clear < NARROW)


def regions_of(lines: Sequence[Array]) -> list[Region]:
    """Return the regions that lines (k, 2) of the unit square make of it, the largest first.

    What lies outside of the square is left out; so are lines that end somewhere inside.
    """
    net = net_of(joined(lines)).pruned
    found = faces_of(net)
    points = [innermost(face) for face in found.faces]
    inside = [
        i
        for i, (face, (point, _)) in enumerate(zip(found.faces, points, strict=True))
        if ((point >= 0) & (point <= 1)).all() and face.area > NOTHING
    ]
    inside.sort(key=lambda i: -found.faces[i].area)
    number = {face: i for i, face in enumerate(inside)}
    beside: list[dict[int, dict[int, float]]] = [{} for _ in inside]
    ends = net.vertices[net.edges]
    lengths = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    for (left, right), owner, length in zip(found.sides, net.owners, lengths, strict=True):
        a, b = number.get(int(left)), number.get(int(right))
        if owner == 0 or a is None or b is None or a == b:
            continue
        for one, other in ((a, b), (b, a)):
            shared = beside[one].setdefault(other, {})
            shared[int(owner) - 1] = shared.get(int(owner) - 1, 0.0) + float(length)
    return [Region(found.faces[face], *points[face], beside[i]) for i, face in enumerate(inside)]
