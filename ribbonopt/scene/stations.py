"""What a scene says of single places between the ends: point loads, and supports."""

from __future__ import annotations

from ribbonopt.classes import dataclass

from .ends import AnyVector, LabVector, Triple, Value


@dataclass(frozen=True)
class PointLoad:
    """A force and a moment on the ribbon at the arclength `at`.

    Dead in lab components (x, y, z); along directors (d1, d2, d3) they follow the ribbon there.
    """

    at: Value
    force: Triple | AnyVector | None = None
    moment: Triple | AnyVector | None = None


@dataclass(frozen=True)
class InteriorSupport:
    """A support between the ends: the components of the position held at the arclength `at`.

    The force that it takes is an unknown of the equilibrium.
    """

    at: Value
    position: Triple | LabVector
