"""A number as it was computed, and what is said of its error."""

from __future__ import annotations

from ribbonopt.classes import dataclass

BAR = "bar"  # what the package claims of the error of this answer
TOLERANCE = "tolerance"  # there is no bar: that of the scene, relative to the size of the number
COUNT = "count"  # a whole number, right or wrong


@dataclass(frozen=True)
class Measured:
    """A value and the bound of its absolute error, in the units of the scene; `basis` is of what.

    `basis` is one of BAR, TOLERANCE, COUNT.
    """

    value: float
    bar: float
    basis: str = BAR


class NoAnswerError(Exception):
    """There is no such number: the scene was not solved, or its branch has no such point."""
