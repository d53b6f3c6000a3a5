"""Supports between the ends that no ribbon reaches: further apart than it is long between them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ribbonopt.errors import ConvergenceError
from ribbonopt.mechanics.ends.boundary import held_position
from ribbonopt.mechanics.ends.frames import components, number
from ribbonopt.scene import Scene

ROUNDING = 1e-12  # of the length


def refuse_taut(scene: Scene, share: float = 0.0) -> None:
    """Raise ConvergenceError for supports too far from each other, or from the ends.

    `share` is that of its length by which the ribbon may stretch.
    """
    (start, end), parameters, loop = scene.interval, scene.parameters, scene.boundary.loop
    ends = {"start": (start, scene.boundary.start), "end": (end, scene.boundary.end)}
    places = [
        (at, f"boundary.{name}.position", held_position(given, parameters))
        for name, (at, given) in ends.items()
        if loop is None or name == "start"
    ]
    places += [
        (
            number(support.at, parameters),
            f"supports.{index}.position",
            dict(components(support.position, parameters)),
        )
        for index, support in enumerate(scene.supports)
    ]
    for axes in ("x", "y", "z", "xy", "yz", "xz", "xyz"):
        held = sorted((p for p in places if p[2].keys() >= set(axes)), key=lambda p: p[0])
        for (a, first, here), (b, second, there) in pairwise(held):
            gap = float(np.linalg.norm([there[axis] - here[axis] for axis in axes]))
            if gap > (b - a) * (1 + share) + ROUNDING * (end - start) and b > a:
                raise ConvergenceError(
                    f"unreachable: {first} and {second} are {gap:.6g} apart, the ribbon is "
                    f"{b - a:.6g} long between them; bring them together, or move one along it",
                    status="unreachable",
                )
