"""What a scene may say of the inertia of sections that turn, for small vibrations."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from ribbonopt.classes import dataclass

from .schema.bounds import Bounds

if TYPE_CHECKING:
    from .model import RibbonSizes
    from .units import Units

STRIP = 12.0  # squared width over the squared radius of gyration about normal and tangent

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


def of_width(width: float) -> Inertia:
    """Return the inertia of a strip of a width, in the unit of that squared."""
    return Inertia(width**2 / STRIP, width**2 / STRIP)


def in_units(
    inertia: AnyInertia | None, units: Units, ribbon: RibbonSizes | None
) -> AnyInertia | None:
    """Return an inertia in units of what counts as 1 inside, with the width of its ribbon."""
    if not isinstance(inertia, Inertia):
        if inertia is None or ribbon is None:
            return inertia  # that of the width of the law
        inertia = of_width(ribbon.width)
    return Inertia(inertia.d1 / units.length**2, inertia.d3 / units.length**2)
