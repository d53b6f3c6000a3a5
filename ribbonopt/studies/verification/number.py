"""A number of a solution, whatever it is: its value, its bar, and what a tolerance is of."""

from __future__ import annotations

from collections.abc import Callable

from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution

from .bars import known
from .measured import COUNT, TOLERANCE, Measured

Read = Callable[[Solution], float]
USUAL = 1e-8  # tolerance of scenes that have none


class UnknownNumberError(ValueError):
    """A name that stands for no number of a scene: says why."""


@dataclass(frozen=True, eq=False)
class Number:
    """A number of a solution.

    Attributes
    ----------
    value : callable
        Takes a solution, returns the number in the units of the scene.
    bar : callable or None
        Returns the bar of it, nan where there is none; None for counts, which are right or wrong.
    size : callable or None
        What a tolerance is relative to; None for the number itself.
    """

    value: Read
    bar: Read | None
    size: Read | None = None

    def measured(self, solution: Solution, barred: bool = True) -> Measured:
        """Return the number with its bar; where there is none, or `barred` is not, the tolerance.

        Raises
        ------
        NoAnswerError
            If there is no such number.
        """
        value = self.value(solution)
        if self.bar is None:
            return Measured(value, 0.0, COUNT)
        bar = known(self.bar, solution) if barred else None
        if bar is not None:
            return Measured(value, bar)
        size = abs(value) if self.size is None else max(self.size(solution), abs(value))
        tolerance = solution.scene.tolerance or USUAL
        return Measured(value, tolerance * size, TOLERANCE)
