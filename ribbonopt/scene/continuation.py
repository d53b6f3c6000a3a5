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
        Dotted path of a number of the scene, such as law.epsilon or boundary.end.position.x.
    to, from_
        Last and first value; `from` in a file, by default where the scene or an earlier stage is.
        Two values of `to`, on both sides of `from`, are gone to one after the other.
    values
        In place of `to`: exactly these values, strictly monotonic.
    scale
        What steps are measured in.
    first, smallest, largest
        Sizes of steps.
    points
        Most points.
    stop
        What ends the stage: conditions such as "energy > 30", and special points such as "fold",
        "branch point", or "2 folds" for the second.
    special
        Whether folds and branch points are located.
    switch
        Whether the branches that cross are followed, in both directions; 2 for those as well that
        cross them, and so on.
    stability
        Whether negative directions are counted where the scene is conservative; `eigenvalue` if the
        smallest eigenvalue of the second variation is recorded besides, as `softest`.
    """

    parameter: str
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

    @property
    def measured(self) -> bool:
        """Whether the smallest eigenvalue of the second variation is recorded."""
        return self.stability == "eigenvalue"
