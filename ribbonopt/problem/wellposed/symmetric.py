"""Whether a piece of a loop stands for the whole of it: the law must have the symmetry, too."""

from __future__ import annotations

from ribbonopt.errors import ModelError
from ribbonopt.mechanics.laws.asymmetry import changed_by_flip
from ribbonopt.problem.posed import Posed


def refuse_asymmetry(posed: Posed) -> None:
    """Raise a ModelError for a piece of a loop whose natural strains differ in its images."""
    loop, axis = posed.scene.boundary.loop, changed_by_flip(posed.scene, posed.theta)
    if loop is None or not axis:
        return
    raise ModelError(
        f"boundary.loop.piece: {loop.piece} stands for all of the loop by flips about {axis}, "
        f"after which the natural strains of law {posed.scene.law.type} are others; solve piece: "
        "whole",
        "boundary.loop.piece",
    )
