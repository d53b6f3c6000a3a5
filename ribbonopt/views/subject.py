"""What a figure shows: one ribbon, or the whole band of which it is a piece by symmetry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field
from functools import cached_property, partial

from ribbonopt.checks.flip import Flip
from ribbonopt.checks.topology import ClosedBand, closure
from ribbonopt.classes import dataclass
from ribbonopt.errors import ViewError
from ribbonopt.mechanics.laws.catalogue import capabilities, curvature_across
from ribbonopt.mechanics.widths import own_width
from ribbonopt.scene.units import Units
from ribbonopt.solution.solution import Solution

from .acting import Acting, acting_of
from .pieces import ROWS, Piece, in_plane, is_rods, sample_pieces
from .symmetry import continued, image, other_half

ROD_SHARE = 1 / 80  # half-width of the strip that a rod is drawn as, of the length
FEWEST_ROWS = 81  # of a piece among many


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
        What follows by symmetry, or empty.
    count : int
        How many times the interval makes all of it.
    acts : function returning Acting
        What acts and holds: at ends only where the ribbon does not go on by symmetry.
    units : Units
        Of all of it.
    half_width : float or None
        Of the ribbon, where the scene says it.
    across : float or None
        K22 of natural strains, on which the strains that a sheet allows depend; None if it varies.
    rod : bool
        Whether u1 is free, so that there are no generatrices.
    """

    name: str
    interval: tuple[float, float]
    solved: tuple[Piece, ...]
    mirrored: tuple[Piece, ...] = ()
    units: Units = field(default_factory=Units)
    half_width: float | None = None
    count: int = 1
    across: float | None = 0.0
    rod: bool = False
    acts: Callable[[], Acting] = Acting

    @cached_property
    def acting(self) -> Acting:
        """What acts and holds, found when it is asked for."""
        return self.acts()

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """All pieces in order of arclength."""
        return self.solved + self.mirrored

    @property
    def end(self) -> float:
        """Arclength at the end of what is shown."""
        start, end = self.interval
        return start + self.count * (end - start)

    @property
    def length(self) -> float:
        """Length of what is shown."""
        return self.end - self.interval[0]

    def demand_generatrices(self) -> None:
        """Raise a ViewError where there are none."""
        if self.rod:
            raise ViewError(
                f"{self.name} may bend in its own plane (u1 is up to {in_plane(self.solved):.2g} "
                "of the largest strain): it is no ribbon with generatrices; its strains and a "
                "strip along d2 can be drawn"
            )

    @property
    def drawn(self) -> float | None:
        """Half-width to draw it to: its own, or that of a thin strip for a rod, else None."""
        thin = ROD_SHARE * self.length if self.rod else None
        return thin if self.half_width is None else self.half_width

    @property
    def rest(self) -> str:
        """What follows by symmetry, in words."""
        if self.count == 2:
            return "second half by symmetry"
        return f"{self.count - 1} of {self.count} pieces by symmetry"

    def label(self, quantity: str, unit: str) -> str:
        """Label of an axis: the quantity, and its unit in SI."""
        return f"{quantity}  [{unit}]" if self.units.si else quantity


def subject_of(solution: Solution, complete: bool, rows: int = ROWS) -> Subject:
    """Sample a solution, once for all figures; with the rest of its band where it has one.

    `rows` are about how many there are of what was solved: fewer of a piece among many.
    """
    start, end = solution.scene.interval
    width, law = own_width(solution.scene), capabilities(solution.scene)
    band = closure(solution) if complete else None
    half = other_half(solution) if complete and band is None else None
    count = 2 if half is not None else 1 if band is None else band.pieces
    solved = sample_pieces(solution, law, min(rows, max(FEWEST_ROWS, 2 * rows // count)))
    return Subject(
        name=solution.scene.name,
        interval=(float(start), float(end)),
        solved=solved,
        mirrored=_rest(band, half, solved),
        units=solution.units,
        half_width=None if width is None else width / 2,
        count=count,
        across=curvature_across(solution.scene),
        rod=is_rods(law),
        acts=partial(acting_of, solution, ends=band is None),
    )


def _rest(
    band: ClosedBand | None, half: Flip | None, solved: tuple[Piece, ...]
) -> tuple[Piece, ...]:
    """Return what follows by symmetry: of a closed band, or of a strip whose half is solved."""
    if half is not None:
        return tuple(image(half, piece) for piece in reversed(solved))
    return () if band is None else continued(band, solved)
