"""What a scene may say of its map: two numbers that move, and where it is looked for what happens.

What is drawn as a map are the loci of folds and branch points in the plane of both numbers, and how
many equilibria there are in each region between them.
"""

from __future__ import annotations

from typing import Annotated, Literal

from ribbonopt.classes import dataclass

from . import limits
from .schema.bounds import Bounds

Special = Literal["fold", "branch point"]


@dataclass(frozen=True)
class MapPlan:
    """A rectangle of two numbers of the scene, and how it is explored.

    Values are in the units of the scene.

    Attributes
    ----------
    parameters
        Dotted paths of two numbers of the scene, each with its range; the first is along x.
        Example: `{parameters.angle: [0, 60], parameters.distance: [0.05, 0.4]}`
    lines
        Values of the second number at which branches are followed in the first; by default three,
        evenly spaced inside the range. Example: `[0.1, 0.25]`
    across
        Values of the first number at which branches are followed in the second; none by default.
        Example: `[30]`
    of
        Which loci are drawn. Example: `[fold]`
    points
        Pairs of values at which shapes are counted and pictured besides: one is counted in each
        region anyway. Example: `[[20, 0.1]]`
    switch
        How deep branches that cross those on the lines are followed. Example: `2`
    largest
        Largest step along a locus and a line, as a share of the ranges. Example: `0.02`
    """

    parameters: dict[str, tuple[float, float]]
    lines: tuple[float, ...] | None = None
    across: tuple[float, ...] = ()
    of: tuple[Special, ...] = ("fold", "branch point")
    points: tuple[tuple[float, float], ...] = ()
    switch: bool | Annotated[int, Bounds(ge=0, most=limits.BRANCHES)] = True
    largest: Annotated[float, Bounds(gt=0, le=1)] = 0.05

    @property
    def x(self) -> str:
        """Path of the number along x."""
        return next(iter(self.parameters))

    @property
    def y(self) -> str:
        """Path of the number along y."""
        return next(reversed(self.parameters))

    @property
    def ranges(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ranges along x and y."""
        return self.parameters[self.x], self.parameters[self.y]

    @property
    def levels(self) -> tuple[float, ...]:
        """Values of the second number on whose lines branches are followed."""
        if self.lines is not None:
            return self.lines
        low, high = self.parameters[self.y]
        return tuple(low + share * (high - low) for share in (0.15, 0.5, 0.85))
