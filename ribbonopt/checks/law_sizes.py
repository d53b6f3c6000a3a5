"""Sizes that a law says itself: whether they are those of a ribbon, and of that of the scene."""

from __future__ import annotations

import math
from collections.abc import Iterator

from ribbonopt.scene import RibbonSizes
from ribbonopt.scene.sized import OfWidth, Sized
from ribbonopt.solution.solution import Solution

SLENDER = 10.0  # least ratio of length to width, and of width to thickness
WIDE = 2.0  # the same of laws that know the edges: generatrices reach from one to the other
SAME = 1e-9  # relative
SHARED = ("width", "thickness", "poisson_ratio")


def law_problems(solution: Solution) -> list[str]:
    """Return a sentence for each size of a law that is not as its model wants it."""
    law, ribbon = solution.scene.law, solution.scene.ribbon
    if not isinstance(law, Sized):
        return []
    sizes = {name: value for name in SHARED if (value := getattr(law, name, None)) is not None}
    if ribbon is not None:
        return list(_unlike(sizes, ribbon))
    return list(_slenderness(solution, sizes))


def _unlike(sizes: dict[str, float], ribbon: RibbonSizes) -> Iterator[str]:
    """Yield sizes of a law that are not those of the ribbon, which the units are made of."""
    for name, value in sizes.items():
        own = getattr(ribbon, name)
        if not math.isclose(value, own, rel_tol=SAME):
            yield (
                f"law.{name} = {value:g} is not ribbon.{name} = {own:g}, which stiffness and loads "
                "follow; leave it out, and the law takes that of the ribbon"
            )


def _slenderness(solution: Solution, sizes: dict[str, float]) -> Iterator[str]:
    scene, (start, end) = solution.scene, solution.scene.interval
    pieces = 1 if scene.boundary.loop is None else scene.boundary.loop.pieces
    slender = WIDE if isinstance(scene.law, OfWidth) else SLENDER
    known = {"length": pieces * (end - start), **sizes}
    for large, small, least in (("length", "width", slender), ("width", "thickness", SLENDER)):
        if large in known and small in known and known[large] < least * known[small]:
            yield (
                f"the {large} is only {known[large] / known[small]:.3g} times the {small} that "
                f"law {scene.law.type} has; the model is for L >> w >> h"
            )
