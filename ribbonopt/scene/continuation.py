"""What a scene may say of its continuation: a number that moves, and what is watched on the way.

How the stages of a scene follow each other is in `checks.continuation`.
"""

from __future__ import annotations

from typing import Annotated, Literal

from ribbonopt.classes import dataclass

from . import limits
from .schema.bounds import Bounds

Step = Annotated[float, Bounds(gt=0)]


@dataclass(frozen=True)
class ContinuationStage:
    """One stage of a continuation: a parameter of the scene from one value to another.

    Values are in the units of the scene, steps in those of the parameter, or in decades of it
    where the scale is `log`.

    Attributes
    ----------
    parameter
        Dotted path of the number of the scene that moves; of two, for a locus (`of`), branches
        move the first, and the locus is followed in the second. Example: `law.epsilon` or
        `[parameters.angle, parameters.distance]`
    to
        Last value. Two, on both sides of `from`, are gone to one after the other.
        Example: `1e-4` or `[35, 60]`
    from_
        First value (`from` in a file); by default where the scene or an earlier stage is.
        Example: `0.1`
    values
        In place of `to`: exactly these values, strictly monotonic. Example: `[0.1, 0.03, 0.01]`
    scale
        What steps are measured in. Example: `log`
    first
        Size of the first step; found by itself if not given. Example: `0.05`
    smallest
        Smallest step, at which the stage gives up. Example: `1e-6`
    largest
        Largest step. Example: `0.2`
    points
        Most points. Example: `200`
    stop
        What ends the stage: conditions, and special points, or which of them.
        Example: `["energy > 30"]` or `[fold]` or `[2 branch points]`
    special
        Whether folds and branch points are located.
    switch
        Whether the branches that cross are followed, in both directions; 2 for those as well that
        cross them, and so on. Example: `2`
    stability
        Whether negative directions are counted where the scene is conservative; `eigenvalue` if the
        smallest eigenvalue of the second variation is recorded besides, as `softest`.
        Example: `eigenvalue`
    of
        What is followed in two parameters: the locus of a special point of this kind.
        Example: `fold`
    number
        Which of those special points it begins with, along the branch, from 1. Example: `2`
    between
        Range of the first of two parameters: the branch on which the special point is found goes
        from the one to the other; the locus ends where it leaves them. Example: `[0, 60]`
    branch
        Folder of a saved branch whose special point is taken in place of following one.
        Example: `results/snap-continue`
    modes
        How many natural frequencies are recorded at every point that is not special, lowest first,
        as `frequency1` and so on, and their squares omega^2 as `squared1`, which go through zero at
        folds and branch points. Example: `3`
    """

    parameter: str | tuple[str, str]
    to: float | tuple[float, float] | None = None
    from_: float | None = None
    values: tuple[float, ...] | None = None
    scale: Literal["linear", "log"] = "linear"
    first: Step | None = None
    smallest: Step | None = None
    largest: Step | None = None
    points: Annotated[int, Bounds(ge=1, most=limits.POINTS)] = 500
    stop: tuple[str, ...] = ()
    special: bool = True
    switch: bool | Annotated[int, Bounds(ge=0, most=limits.BRANCHES)] = False
    stability: bool | Literal["eigenvalue"] = True
    of: Literal["fold", "branch point", "buckling point"] | None = None
    number: Annotated[int, Bounds(ge=1, most=limits.COUNTED)] = 1
    between: tuple[float, float] | None = None
    branch: str | None = None
    modes: Annotated[int, Bounds(ge=0, most=limits.MODES)] = 0

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of all numbers that move: one, or two of a locus."""
        return (self.parameter,) if isinstance(self.parameter, str) else self.parameter

    @property
    def moved(self) -> str:
        """Path of the number that is the position: of two, the second."""
        return self.paths[-1]

    @property
    def is_locus(self) -> bool:
        """Whether a locus is followed, in two parameters."""
        return len(self.paths) > 1

    @property
    def measured(self) -> bool:
        """Whether the smallest eigenvalue of the second variation is recorded."""
        return self.stability == "eigenvalue"
