"""Whether a piece of a loop stands for the whole of it: law and loads must be symmetric, too."""

from __future__ import annotations

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.laws.asymmetry import changed_by_flip
from ribbonopt.problem.posed import Posed
from ribbonopt.scene import Loop


def refuse_asymmetry(posed: Posed) -> None:
    """Raise a ModelError for a piece of a loop whose natural strains or loads differ in its images.

    A pressure that d1 keeps its side for is the same in all, and in a plane it keeps the forces
    in balance where pieces meet; out of it nothing says so.
    """
    loop = posed.scene.boundary.loop
    if loop is None or loop.piece == "whole":
        return
    _refuse_loads(posed, loop)
    axis = changed_by_flip(posed.scene, posed.theta)
    if not axis:
        return
    raise ModelError(
        f"boundary.loop.piece: {loop.piece} stands for all of the loop by flips about {axis}, "
        f"after which the natural strains of law {posed.scene.law.type} are others; solve piece: "
        "whole",
        "boundary.loop.piece",
    )


def _refuse_loads(posed: Posed, loop: Loop) -> None:
    acting = [load.name for load in posed.loads]
    acting += [action.path for station in posed.stations for action in station.actions]
    if posed.scene.states == "planar" and loop.half_twists == 0:
        acting = [name for name in acting if name != "loads.pressure"]
    if not acting:
        return
    plane = ", or in a plane states: planar" if acting == ["loads.pressure"] else ""
    raise ModelError(
        f"boundary.loop.piece: {loop.piece} stands for all of the loop by flips, after which "
        f"{acting[0]} is another; solve piece: whole{plane}, or the piece with ends of its own "
        "(boundary.start, boundary.end)",
        "boundary.loop.piece",
    )
