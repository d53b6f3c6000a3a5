"""What equations tell of a curve at one of its points: where it goes, and the null direction."""

from __future__ import annotations

from typing import Protocol

from ribbonopt.arrays import Array


class Heading(Protocol):
    """Where a curve goes at a solution: of the equations bordered by a row along the curve."""

    @property
    def direction(self) -> Array:
        """Tangent (n + k,), of any length: the bordered matrix makes (0 .. 0, 1) of it."""

    @property
    def sign(self) -> float:
        """Sign of the bordered determinant, which vanishes at branch points, not at folds.

        Comparable for rows that point the same way along the curve, in any layout; 0 where the
        equations have no derivative, so that it tells nothing.
        """


class Linearised(Heading, Protocol):
    """The equations linearised at a solution, bordered by a row along the curve."""

    @property
    def log(self) -> float:
        """Logarithm of the absolute value of the determinant."""

    def kernel(self) -> Array:
        """Solve (n + k,) for a right-hand side with a share of every equation, none of the row.

        Next to a branch point that is the null direction, times much.
        """
