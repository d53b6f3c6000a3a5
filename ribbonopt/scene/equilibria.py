"""What a scene may say of the search for all of its equilibria: which numbers move, and how far."""

from __future__ import annotations

from typing import Annotated

from ribbonopt.classes import dataclass

from . import limits
from .schema.bounds import Bounds


@dataclass(frozen=True)
class Equilibria:
    """The search for all equilibria of a scene, along branches on which its numbers move.

    Values are in the units of the scene.

    Attributes
    ----------
    along
        Dotted paths of the numbers that move on the way, each with the range that it may move in
        where that is known; by default those of `continuation`, or else all `parameters`, or else
        those of the end's position. Example: `[parameters.angle]` or `{parameters.angle: [-60, 60]}`
    below
        Strain energy up to which equilibria are looked for; by default five times that of the
        strip as it buckles first. Example: `20`
    modes
        Half waves up to which buckled shapes are tried as starts. Example: `6`
    points
        Most points on the way, on all branches. Example: `5000`
    """

    along: tuple[str, ...] | dict[str, tuple[float, float]] = ()
    below: Annotated[float, Bounds(gt=0)] | None = None
    modes: Annotated[int, Bounds(ge=0, most=20)] = 4
    points: Annotated[int, Bounds(ge=1, most=limits.POINTS)] = 2000

    @property
    def ranges(self) -> dict[str, tuple[float, float] | None]:
        """The numbers that move, each with its range, None where that is not given."""
        return dict(self.along) if isinstance(self.along, dict) else dict.fromkeys(self.along)
