"""What a figure shows: one ribbon, or the whole of which it is one half by symmetry."""

from __future__ import annotations

from dataclasses import dataclass, field

from ribbonopt.scene.units import Units
from ribbonopt.solution import Solution
from ribbonopt.symmetry import find_flip

from .pieces import Piece, sample_pieces
from .symmetry import image


@dataclass(frozen=True)
class Subject:
    """A sampled ribbon with its name.

    Attributes
    ----------
    name : str
        The scene's.
    solved : tuple of Piece
        What was solved, on the arclengths `interval`.
    mirrored : tuple of Piece
        What follows by symmetry; continues the interval to twice its length, or empty.
    units : Units
        Of all of it.
    half_width : float or None
        Of the ribbon, where the scene says it.
    """

    name: str
    interval: tuple[float, float]
    solved: tuple[Piece, ...]
    mirrored: tuple[Piece, ...] = ()
    units: Units = field(default_factory=Units)
    half_width: float | None = None

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """All pieces in order of arclength."""
        return self.solved + self.mirrored

    @property
    def end(self) -> float:
        """Arclength at the end of what is shown."""
        start, end = self.interval
        return 2 * end - start if self.mirrored else end

    @property
    def length(self) -> float:
        """Length of what is shown."""
        return self.end - self.interval[0]

    def label(self, quantity: str, unit: str) -> str:
        """Label of an axis: the quantity, and its unit in SI."""
        return f"{quantity}  [{unit}]" if self.units.si else quantity


def subject_of(solution: Solution, complete: bool) -> Subject:
    """Sample a solution, once for all figures; with its other half where it has one."""
    start, end = solution.scene.interval
    name, interval = solution.scene.name, (float(start), float(end))
    solved = sample_pieces(solution)
    flip = find_flip(solution) if complete else None
    mirrored = tuple(image(flip, piece) for piece in reversed(solved)) if flip else ()
    ribbon = solution.scene.ribbon
    half_width = None if ribbon is None else ribbon.width / 2
    return Subject(name, interval, solved, mirrored, solution.units, half_width)
