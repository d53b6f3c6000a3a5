"""What a scene says of single places between the ends: point loads, and supports."""

from __future__ import annotations

from ribbonopt.classes import dataclass

from .frames import AnyVector, LabVector, Triple, Value


@dataclass(frozen=True)
class PointLoad:
    """A force and a moment on the ribbon at one place.

    In lab components (x, y, z) they are dead; along directors (d1, d2, d3) they follow the ribbon.

    Attributes
    ----------
    at
        Arclength of the place. Example: `0.5`
    force
        Force on the ribbon. Example: `[-2, 0, 0]` or `{d1: 3}`
    moment
        Moment on the ribbon. Example: `{y: 0.5}`
    """

    at: Value
    force: Triple | AnyVector | None = None
    moment: Triple | AnyVector | None = None


@dataclass(frozen=True)
class InteriorSupport:
    """A support between the ends; the force that it takes is an unknown of the equilibrium.

    Attributes
    ----------
    at
        Arclength of the place. Example: `0.3`
    position
        Lab components of the position that are held there, all or some. Example: `{x: 0}`
    """

    at: Value
    position: Triple | LabVector
