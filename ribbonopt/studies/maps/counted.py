"""All equilibria at a point of a map, as `studies.equilibria` finds them."""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.classes import dataclass
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.plain import Row
from ribbonopt.scene import Scene
from ribbonopt.solution.solution import Solution


@dataclass(frozen=True, eq=False)
class Counted:
    """The equilibria at a point.

    Attributes
    ----------
    solutions : tuple of Solution
        The stable ones first, then by increasing energy.
    rows : tuple of Row
        What is told of each.
    count, stable : int
        How many there are, and of these stable, mirror images counted.
    told : str
        What was searched.
    """

    solutions: tuple[Solution, ...]
    rows: tuple[Row, ...]
    count: int
    stable: int
    told: str


def counted(scene: Scene, prepared: Prepared) -> Counted:
    """Return all equilibria of a scene; ConvergenceError where there is none."""
    from ribbonopt.checks.stability import negative_directions
    from ribbonopt.studies.continuation.recorded import error_of

    posed = prepared.posed(replace(scene, starts=12))
    first = prepared.solve(posed)
    found = [first, *first.others]
    negative = [negative_directions(one) for one in found]
    rows = tuple(
        {"energy": one.energy, "negative": n, "stable": n == 0, "error": error_of(one), "images": 1}
        for one, n in zip(found, negative, strict=True)
    )
    return Counted(tuple(found), rows, len(found), sum(n == 0 for n in negative), "twelve starts")


def all_of(scene: Scene, prepared: Prepared) -> tuple[Solution, ...]:
    """Return the equilibria that branches begin at."""
    return counted(scene, prepared).solutions
