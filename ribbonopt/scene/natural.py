"""What a scene may say of the strains that its ribbon has when it is free."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from ribbonopt.classes import dataclass

from .along import Along, scaled
from .schema.bounds import Bounds

if TYPE_CHECKING:
    from .model import RibbonSizes
    from .units import Units


@dataclass(frozen=True)
class Natural:
    """Curvatures of the free ribbon, 1 / length; numbers along it.

    Attributes
    ----------
    curvature
        Natural bending along the ribbon, about d2. Example: `2.5` or `1 + s`
    twist
        Natural twist. Example: `0.5`
    across
        Natural curvature across the width, as of a tape spring. Example: `10`
    poisson_ratio
        Couples curvature along and across; by default that of `ribbon`, or 0 without one.
        Example: `0.3`
    """

    curvature: Along = 0.0
    twist: Along = 0.0
    across: Along = 0.0
    poisson_ratio: Annotated[float, Bounds(gt=-1, le=0.5)] | None = None


def strains_in_units(
    natural: Natural | None, units: Units, ribbon: RibbonSizes | None
) -> Natural | None:
    """Return natural strains in units inside; a Poisson's ratio that is not said is the ribbon's.

    A curvature is one over a length, and varies along one.
    """
    if natural is None:
        return None
    curvatures = natural.curvature, natural.twist, natural.across
    along, twist, across = (scaled(some, units.strain, units.length) for some in curvatures)
    said = natural.poisson_ratio
    ratio = ribbon.poisson_ratio if said is None and ribbon is not None else said
    return Natural(along, twist, across, ratio)
