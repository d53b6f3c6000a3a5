"""To which half-width the ribbons of a page are drawn, and that in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ribbonopt.errors import ModelError
from ribbonopt.views.generatrices import WIDTH_SHARE
from ribbonopt.views.shape import common_half_width
from ribbonopt.views.subject import Subject


def width_of(subjects: Sequence[Subject], half_width: float | None) -> tuple[float | None, str]:
    """Return one half-width for all of some ribbons, and what a page says of it.

    Parameters
    ----------
    subjects
        The ribbons.
    half_width
        What is wanted, in the units of the scene; by default the ribbons' own.

    Raises
    ------
    ModelError
        If half_width is not a positive number.
    """
    if half_width is not None and not 0 < half_width < float("inf"):
        raise ModelError(f"half_width is expected to be positive, found {half_width}")
    if not subjects:
        return None, ""
    own = half_width is None and all(subject.half_width is not None for subject in subjects)
    width = _found(subjects) if half_width is None else half_width
    unit = " m" if subjects[0].units.si else ""
    if own and len({subject.half_width for subject in subjects}) > 1:
        return None, "drawn to its own width"
    return width, f"drawn to the half-width {width:.3g}{unit}" + (", its own" if own else "")


def _found(subjects: Sequence[Subject]) -> float:
    """Return one half-width for all; of ribbons without numbers, as of a failed solve, any."""
    known = [s for s in subjects if all(np.isfinite(piece.r).all() for piece in s.pieces)]
    return common_half_width(known) if known else WIDTH_SHARE * subjects[0].length
