"""All equilibria at a point of a map, as `studies.equilibria` looks for them, in plain words."""

from __future__ import annotations

from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.plain import Row
from ribbonopt.scene import Scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.equilibria.all import all_equilibria
from ribbonopt.studies.equilibria.found import Found


def counted(scene: Scene, prepared: Prepared) -> tuple[list[Solution], Row]:
    """Return all equilibria of a scene, those of one kind in a row, and what is told of them.

    Raises
    ------
    ConvergenceError
        If none is found.
    """
    found: Found = all_equilibria(scene, prepared)
    shapes = []
    for kind in found.kinds:
        row = kind.row
        # Images have all in common but the place in the list.
        shapes += [{**row, "image": image} for image in range(len(kind.images))]
    row = {"count": found.count, "stable": found.stable, "below": found.below}
    return list(found.solutions), {**row, "shapes": shapes, "told": found.told}
