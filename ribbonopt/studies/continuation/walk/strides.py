"""A step along a curve, before and after it is taken."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic

from ribbonopt.arrays import Array

from .points import Point, S


@dataclass(frozen=True, eq=False)
class Stride(Generic[S]):
    """An accepted step: the next point, and the special points before it."""

    following: Point[S]
    special: list[Point[S]]


@dataclass(frozen=True, eq=False)
class Prediction:
    """Unknowns at an arclength ahead; `position` is to be met exactly, unless the arclength is."""

    unknowns: Array
    arc: float
    position: float | None
