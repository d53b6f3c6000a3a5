"""The faces of a net in the plane: what its edges enclose, with the holes that others make."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from .crossings import Ints, Net

TINY = 1e-13  # area of a cycle that encloses nothing: edges that were gone along both ways


@dataclass(frozen=True, eq=False)
class Face:
    """A part of the plane that no edge divides.

    Attributes
    ----------
    outer : Array
        Corners (k, 2) around it, it to the left.
    holes : tuple of Array
        Corners (k, 2) around each part of the plane that it encloses, it to the left.
    """

    outer: Array
    holes: tuple[Array, ...] = ()

    @property
    def rings(self) -> tuple[Array, ...]:
        """All corners, a ring at a time."""
        return (self.outer, *self.holes)

    @property
    def area(self) -> float:
        """Its area."""
        return sum(_area(ring) for ring in self.rings)

    @property
    def sides(self) -> Array:
        """Its edges (m, 2, 2)."""
        return np.concatenate(
            [np.stack([ring, np.roll(ring, -1, axis=0)], axis=1) for ring in self.rings]
        )

    def contains(self, points: Array) -> NDArrayBool:
        """Return whether points (n, 2) lie in it, (n,)."""
        return _inside(points, self.sides)


NDArrayBool = np.ndarray


@dataclass(frozen=True, eq=False)
class Faces:
    """All bounded faces of a net, and what lies on both sides of each of its edges.

    Attributes
    ----------
    faces : tuple of Face
        The faces.
    sides : Ints
        The faces (e, 2) to the left and to the right of each edge of the net; -1 outside of all.
    """

    faces: tuple[Face, ...]
    sides: Ints


def faces_of(net: Net) -> Faces:
    """Return the faces of a net without loose ends."""
    cycle, cycles = _cycles(net)
    rings = [net.vertices[_from(net, some)] for some in cycles]
    areas = np.array([_area(ring) for ring in rings])
    inner = [k for k in range(len(rings)) if areas[k] > TINY]
    holes: dict[int, list[int]] = {k: [] for k in inner}
    face_of = {k: i for i, k in enumerate(inner)}
    parts = _parts(net)
    for k in range(len(rings)):
        if k in face_of:
            continue
        part = parts[net.edges[cycles[k][0] // 2, 0]]
        around = [
            o
            for o in inner
            if parts[net.edges[cycles[o][0] // 2, 0]] != part
            and _inside(rings[k][:1], Face(rings[o]).sides)[0]
        ]
        if around:
            least = min(around, key=lambda o: areas[o])
            holes[least].append(k)
            face_of[k] = face_of[least]
    faces = tuple(Face(rings[k], tuple(rings[h] for h in holes[k])) for k in inner)
    found = np.array([face_of.get(int(k), -1) for k in cycle], np.int64)
    return Faces(faces, found.reshape(-1, 2))


def _cycles(net: Net) -> tuple[Ints, list[list[int]]]:
    """Return which cycle each half-edge belongs to, and the half-edges of each cycle in order.

    Half-edge 2 e goes along edge e, 2 e + 1 against it; what it goes round lies to its left.
    """
    count = len(net.edges)
    from_, to = np.empty(2 * count, np.int64), np.empty(2 * count, np.int64)
    from_[::2], to[::2] = net.edges.T
    from_[1::2], to[1::2] = net.edges.T[::-1]
    ways = net.vertices[to] - net.vertices[from_]
    angles = np.arctan2(ways[:, 1], ways[:, 0])
    order = np.lexsort((angles, from_))
    place = np.empty(2 * count, np.int64)
    place[order] = np.arange(2 * count)
    first = np.searchsorted(from_[order], np.arange(len(net.vertices) + 1))
    # Where a half-edge ends, the next is that before its own return, as angles grow.
    back = np.arange(2 * count) ^ 1
    begin, end = first[to], first[to + 1]
    before = np.where(place[back] > begin, place[back] - 1, end - 1)
    following = order[before]
    cycle, cycles = np.full(2 * count, -1, np.int64), list[list[int]]()
    for half in range(2 * count):
        if cycle[half] >= 0:
            continue
        walked, at = [], half
        while cycle[at] < 0:
            cycle[at] = len(cycles)
            walked.append(at)
            at = int(following[at])
        cycles.append(walked)
    return cycle, cycles


def _from(net: Net, halves: Sequence[int]) -> Ints:
    """Return the vertices that half-edges begin at."""
    return np.array([net.edges[half // 2, half % 2] for half in halves])


def _parts(net: Net) -> Ints:
    """Return which connected part of the net each vertex belongs to."""
    part = np.arange(len(net.vertices))
    while True:
        least = part.copy()
        for a, b in ((0, 1), (1, 0)):
            np.minimum.at(least, net.edges[:, a], part[net.edges[:, b]])
        least = least[least]
        if (least == part).all():
            return np.asarray(part)
        part = least


def _area(ring: Array) -> float:
    x, y = (ring - ring[0]).T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def _inside(points: Array, sides: Array) -> NDArrayBool:
    """Return whether points (n, 2) lie inside rings of sides (m, 2, 2), an odd number of them."""
    x, y = points[:, :1], points[:, 1:]
    (ax, ay), (bx, by) = sides[:, 0].T, sides[:, 1].T
    spans = (ay > y) != (by > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = ax + (y - ay) * (bx - ax) / (by - ay)
    return np.asarray((spans & (x < at)).sum(axis=1) % 2 == 1)
