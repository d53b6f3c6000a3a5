"""How many intervals a guess needs: more than those of a scene if it winds a lot."""

from __future__ import annotations

import math

from ribbonopt.guess import Guess, turning_of
from ribbonopt.scene import Scene, Shooting

EACH, FEW_TURNS = 3.0, 20.0  # radians: to an interval; in all, for which any mesh is left alone


def intervals_for(guess: Guess, scene: Scene) -> int | None:
    """Return as many intervals as a guess winds; None where those of the scene are enough."""
    settings = scene.transcription
    steps = settings.steps if isinstance(settings, Shooting) else 1
    each = EACH * steps
    enough = max(FEW_TURNS, each * settings.intervals)
    turning = turning_of(guess, enough)
    if turning <= enough:
        return None
    # Finer than just enough: a coarse mesh has equilibria of its own near by.
    return math.ceil(2 * turning / each)
