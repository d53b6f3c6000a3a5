"""What a scene may say of the inertia of sections that turn, for small vibrations."""

from __future__ import annotations

from typing import Annotated, Literal

from ribbonopt.classes import dataclass

from .schema.bounds import Bounds

Squared = Annotated[float, Bounds(ge=0)]


@dataclass(frozen=True)
class Inertia:
    """Inertia of turns over mass, where the ribbon has its own width; it follows the width squared.

    Attributes
    ----------
    d1
        Squared radius of gyration about d1, the normal, in the scene's unit of length squared.
        Example: `0.01`
    d3
        The same about d3, the tangent: a strip of width w has w^2/12 about both. Example: `0.01`
    """

    d1: Squared = 0.0
    d3: Squared = 0.0


#: an inertia of a scene: numbers, or those of the width of its `ribbon`
AnyInertia = Literal["ribbon"] | Inertia
