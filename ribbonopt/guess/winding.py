"""How far a guess winds, which decides how many intervals its mesh needs."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from .unknowns import Guess

A_TURN = 2  # samples for each radian that a guess may wind at most
MOST = 4096


class Winding(Guess, Protocol):
    """A guess that knows a bound of its turning; a solution has a mesh that fits it."""

    @property
    def most_turning(self) -> float:
        """Bound of the angle (radians) by which the frames turn in all."""


def turning_of(guess: Guess, enough: float) -> float:
    """Return the angle (radians) by which the frames of a guess turn in all; 0 below `enough`."""
    most = getattr(guess, "most_turning", 0.0)  # of a `Winding`: its check would take longer
    if not most > enough:
        return 0.0
    count = int(np.clip(A_TURN * most, 2, MOST))
    frames = guess.fields(np.linspace(0, 1, count)).frames
    cosines = (np.einsum("kij,kij->k", frames[1:], frames[:-1]) - 1) / 2
    angles = np.arccos(np.clip(cosines, -1, 1))
    return float(angles[np.isfinite(angles)].sum())
