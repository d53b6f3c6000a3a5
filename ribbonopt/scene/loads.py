"""What a scene may say of loads along the ribbon; forces at its ends belong to the boundary."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Protocol, runtime_checkable

from ribbonopt.classes import dataclass

from .along import Along
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
class AlongAxes:
    """Components in the lab frame, each a number along the ribbon; those not given are zero.

    Attributes
    ----------
    x, y, z
        Component along this axis: a number, a formula of s, or a table.
        Example: `-5` or `-20*(1 - 0.7*s)`
    """

    x: Along | None = None
    y: Along | None = None
    z: Along | None = None


AlongVector = tuple[Along, Along, Along] | AlongAxes


@dataclass(frozen=True)
class Loads:
    """Loads along the ribbon, and at single places.

    Attributes
    ----------
    force
        Dead force per length, lab frame: it keeps its direction while the ribbon moves.
        Example: `{z: -5}`
    couple
        Dead couple per length, lab frame. Example: `{y: 0.5}`
    pressure
        Force per length along the normal d1, which follows the ribbon; in SI a pressure in pascals
        times the width. Example: `8`
    points
        What acts at single arclengths. Example: `[{at: 0.5, force: [-2, 0, 0]}]`
    own
        Loads declared in Python; no file can say them.
    """

    force: AlongVector | None = None
    couple: AlongVector | None = None
    pressure: Along | None = None
    points: tuple[PointLoad, ...] = ()
    own: tuple[Annotated[OwnLoad, InPython()], ...] = ()
