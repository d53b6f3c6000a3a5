"""The second variation of a ribbon in its plane, where loads have a potential that follow it.

Out of the plane they have none: what is said of such a ribbon is said of its plane alone. Of other
planar scenes the plane tells which of the negative directions in space are in it.
"""

from __future__ import annotations

from dataclasses import replace

from ribbonopt.problem import Posed, Ribbon
from ribbonopt.problem.wellposed.plane import in_plane
from ribbonopt.solution.solution import Solution


def planar_posed(solution: Solution) -> Posed | None:
    """Return a planar scene that has a potential in its plane only; None of any other."""
    follows = any(load.without_potential for load in solution.posed.loads)
    return posed_in_plane(solution) if follows else None


def posed_in_plane(solution: Solution) -> Posed | None:
    """Return a planar scene as one of least energy in its plane; None where there is no such."""
    posed = solution.posed
    if posed.scene.states != "planar" or posed.stations:
        return None
    loads = [known for load in posed.loads if (known := load.in_plane()) is not None]
    if len(loads) < len(posed.loads):
        return None
    return replace(posed.under(formulation="energy"), loads=tuple(loads))


def mechanics(posed: Posed) -> Ribbon:
    """Return the mechanics of a scene of least energy, in its plane if it is so."""
    ribbon = Ribbon.of(posed)
    return in_plane(ribbon, posed) if posed.scene.states == "planar" else ribbon
