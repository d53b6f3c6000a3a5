"""How a branch leaves a point of another where the equations have no linearisation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic

from ribbonopt.arrays import Array

from .points import Point, S


@dataclass(frozen=True, eq=False)
class Departure(Generic[S]):
    """How a branch leaves a point where no null direction can tell it.

    Attributes
    ----------
    direction : (n + k,) array
        Along the branch.
    along, against : Points
        The point in the layouts in which the branch goes along the direction, and against it.
    """

    direction: Array
    along: Point[S]
    against: Point[S]
