"""Several ribbons as pictures that compare: one camera, one scale, one half-width, one tint."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution

from .camera import camera_for
from .facets import Drawing, draw_surface
from .paper_style import Style
from .ribbon import paint
from .shape import common_half_width
from .subject import Subject, subject_of
from .surface import sweep
from .tint import Tint, tint_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BESIDE, BELOW = 0.04, 0.2  # of the size: room around pictures, and that of a bar below them


class Box(NamedTuple):
    """What of the plane of a picture is shown."""

    left: float
    right: float
    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Album:
    """Drawings of ribbons in one view.

    Attributes
    ----------
    subjects, drawings : tuple
        One each for every ribbon.
    corners : Box
        What all drawings fill.
    tint : Tint or None
        Colours of a field.
    """

    subjects: tuple[Subject, ...]
    drawings: tuple[Drawing, ...]
    corners: Box
    tint: Tint | None

    @property
    def size(self) -> float:
        """About the largest extent."""
        left, right, low, high = self.corners
        return max(right - left, (high - low) / 2)

    def box(self, below: float = BELOW) -> Box:
        """Return what to show of each: all of any, with some room; `below` is that for words."""
        left, right, low, high = self.corners
        room = BESIDE * self.size
        return Box(left - room, right + room, low - below * self.size, high + room)

    @property
    def mirrored(self) -> bool:
        """Whether something of them follows by symmetry."""
        return any(subject.mirrored for subject in self.subjects)


def album_of(ribbons: Sequence[Solution], style: Style) -> Album:
    """Draw ribbons, bands whole, as a style says.

    Raises
    ------
    ModelError
        If the style has a camera or a colour that there is not.
    ViewError
        If one of them has no such field.
    """
    subjects = tuple(subject_of(solution, complete=True) for solution in ribbons)
    lines = [np.concatenate([p.r for p in subject.pieces]) for subject in subjects]
    camera = camera_for(
        style.camera,
        np.concatenate([line - line.mean(axis=0) for line in lines]),
        np.concatenate([p.d1 for subject in subjects for p in subject.pieces]),
    )
    tint = tint_of(style.color, subjects)
    given = style.half_width
    usual = common_half_width(subjects) if given is None else given
    drawings = tuple(
        draw_surface(sweep(s.pieces, given or s.drawn or usual), camera, tint=tint)
        for s in subjects
    )
    corners = np.concatenate([drawing.corners.reshape(-1, 2) for drawing in drawings])
    (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
    return Album(subjects, drawings, Box(left, right, low, high), tint)


def place(axes: Axes, drawing: Drawing, box: Box, share: float = 1.0) -> None:
    """Draw one picture into axes without a frame, its lines of a share of their width."""
    paint(axes, drawing.thinned(share))
    axes.set(xlim=box[:2], ylim=box[2:], aspect="equal", xticks=[], yticks=[])
    axes.spines[:].set_visible(False)
