"""What a scene may say of loads along the ribbon; forces at its ends belong to the boundary."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Protocol, runtime_checkable

from .ends import LabVector, Triple
from .schema.bounds import InPython
from .stations import PointLoad


@runtime_checkable
class OwnLoad(Protocol):
    """A load declared in Python: a `Load` of `ribbonopt.mechanics.loads.load`.

    Its numbers are in units Dw = L = 1, in scenes in SI too.
    """

    def numbers(self) -> Mapping[str, float]:
        """Numbers of this load by parameter name."""

    def force(self, section: Any, theta: Any) -> Any:
        """Force (3,) per length on the ribbon at a section, lab frame."""


@dataclass(frozen=True)
class Loads:
    """Loads along the ribbon, and at single places.

    `force` is dead: a force per length (lab frame) that keeps its direction, as own weight does.
    `points` act at single arclengths; `own` are declared in Python.
    """

    force: Triple | LabVector | None = None
    points: tuple[PointLoad, ...] = ()
    own: tuple[Annotated[OwnLoad, InPython()], ...] = ()
