"""What is wrong with point loads, and with supports between the ends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

from ribbonopt.scene.faults import KeyPath, Problem
from ribbonopt.scene.model import Scene
from ribbonopt.scene.stations import PointLoad
from ribbonopt.scene.wording import given, listed, written

from .frames import number_at

_LAB, _DIRECTORS = {"x", "y", "z"}, {"d1", "d2", "d3"}
NEAREST = 1e-6  # of the length: places that are one, or an end


def check_stations(scene: Scene, values: Mapping[KeyPath, float]) -> Iterator[Problem]:
    """Yield what is wrong with what acts and holds at single places of a scene."""
    start, end = scene.interval
    near = NEAREST * (end - start)
    places: dict[KeyPath, float] = {}
    for path, item in _items(scene):
        at = number_at(item.at, (*path, "at"), values)
        if at is None:
            continue
        if not start <= at <= end:
            message = f"is outside the ribbon, whose interval is [{start:g}, {end:g}]"
            yield Problem((*path, "at"), f"{message}; expected an arclength inside", f"{at:g}")
        elif min(at - start, end - at) < near:
            side = "start" if at - start < near else "end"
            message = f"is the {side} of the ribbon: write it under boundary.{side}"
            yield Problem((*path, "at"), message, f"{at:.12g}")
        else:
            places[path] = at
    for (first, a), (second, b) in _neighbours(places):
        if 0 < b - a < near:
            message = f"is all but the place of {'.'.join(map(str, first))}, {a:.12g}"
            yield Problem(
                (*second, "at"), f"{message}; write the same, or {near:g} off", f"{b:.12g}"
            )
    for path, item in _items(scene):
        yield from _of_load(path, item) if isinstance(item, PointLoad) else _of_support(path, item)


def _items(scene: Scene) -> Iterator[tuple[KeyPath, Any]]:
    for index, point in enumerate(scene.loads.points):
        yield ("loads", "points", index), point
    for index, support in enumerate(scene.supports):
        yield ("supports", index), support


def _neighbours(places: dict[KeyPath, float]) -> Iterator[Any]:
    ordered = sorted(places.items(), key=lambda item: item[1])
    yield from pairwise(ordered)


def _of_load(path: KeyPath, load: PointLoad) -> Iterator[Problem]:
    named: set[str] = set()
    for key in ("force", "moment"):
        vector = getattr(load, key)
        if vector is not None:
            named |= set(given(vector))
    if not named:
        message = 'expected a force or a moment; write for example "force: {z: -1}"'
        yield Problem(path, message, written(load))
    elif named & _LAB and named & _DIRECTORS:
        message = (
            f"is given along {listed(sorted(named))}: a load keeps its direction (x, y, z) or "
        )
        yield Problem(path, message + "follows the ribbon (d1, d2, d3); write two loads")


def _of_support(path: KeyPath, support: Any) -> Iterator[Problem]:
    if not given(support.position):
        message = 'expected what is held; write for example "position: {x: 0}"'
        yield Problem((*path, "position"), message, written(support.position))
