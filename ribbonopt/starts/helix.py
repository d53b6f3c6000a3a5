"""The helix that joins two clamps, where one does: an equilibrium of every uniform law.

Strains that are the same all along turn the frame about one axis, by an angle that the clamps
leave open by whole turns; the advance along the axis does not depend on it. Where such a helix
meets the end of the ribbon without bending in its own plane, its energy is one that no start
should exceed. Where it nearly does, as an arc of more than half a turn that somewhat deviates from
a circle, it is a shape to start from, of about the energy that should be found.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.guess import Guess
from ribbonopt.guess.balanced import Balanced
from ribbonopt.guess.named import ShapeGuess, moments_of
from ribbonopt.guess.shapes import Helical
from ribbonopt.mechanics.ends.conditions import Component, Frame
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.mechanics.rotations import turn_vector
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.problem.posed import Place

CLOSE = 1e-7  # of the length, and of the strains
NEAR = 0.1  # the same of what is only a start
TURNS = 8  # whole turns tried to either side of the shortest rotation


@dataclass(frozen=True, eq=False)
class Helix:
    """A helix, as a guess with loads, and its energy (Dw = L = 1); whether it fits exactly."""

    shape: Helical
    guess: Guess
    energy: float
    exact: bool


def wound_evenly(posed: Posed, ribbon: Ribbon, winding: Array) -> Guess:
    """Return the ribbon wound evenly by a rotation vector (3,), along the directors of the start.

    Straight where the axis is d3; an equilibrium if its end is where the scene wants it.
    """
    shape = Helical(*posed.start, winding / posed.length, posed.length)
    return Balanced(ShapeGuess(shape, moments_of(posed, ribbon)))


def helix_between(posed: Posed, ribbon: Ribbon) -> Helix | None:
    """Return the helix of least energy that joins the clamps of a scene, or nearly, or None."""
    ends = clamps_of(posed)
    if ends is None or posed.loaded or not ribbon.uniform or capabilities(posed.scene).natural:
        return None
    (position, frame), (goal, last) = ends
    length = posed.length
    found: list[Helix] = []
    for u in _strains(frame, last, (goal - position) / length):
        shape = Helical(position, frame, u / length, length)
        gap = np.abs(shape.positions(np.ones(1))[0] - goal).max() / length
        across = [i for i in range(3) if i not in ribbon.law.components]
        off = max(gap, np.abs(u[across]).max(initial=0.0) / np.abs(u).max())
        if off < NEAR:
            moments = moments_of(posed, ribbon)
            energy = float(moments(shape.u[None])[0] @ shape.u) * length / 2
            guess = Balanced(ShapeGuess(shape, moments))
            found.append(Helix(shape, guess, energy, bool(off < CLOSE)))
    return min(found, key=lambda helix: (not helix.exact, helix.energy), default=None)


def clamps_of(posed: Posed) -> tuple[Place, Place] | None:
    """Return position and frame of both ends where nothing else is prescribed, else None."""
    frames, places = {}, {}
    for c in posed.conditions:
        if isinstance(c, Frame):
            frames[c.end] = c.frame
        elif isinstance(c, Component) and c.quantity == "position" and c.axis in "xyz":
            places[c.end, c.axis] = c.value
        else:
            return None
    if len(frames) < 2 or len(places) < 6:
        return None
    start, end = (np.array([places[name, axis] for axis in "xyz"]) for name in ("start", "end"))
    return (start, frames["start"]), (end, frames["end"])


def _strains(first: Array, last: Array, chord: Array) -> list[Array]:
    """Strains times length (3,) that turn one frame into another and advance about as far."""
    shortest, along = turn_vector(first.T @ last), first.T @ chord
    angle, advance = float(np.linalg.norm(shortest)), float(np.linalg.norm(along))
    if angle > CLOSE:
        axes = [shortest / angle]
    else:  # whole turns: the chord is along the axis
        axes = [along / advance] if advance > CLOSE else []
    axes = [axis for axis in axes if abs(axis[2] - axis @ along) < NEAR]
    turns = 2 * np.pi * np.arange(-TURNS, TURNS + 1)
    return [(angle + turn) * axis for axis in axes for turn in turns if angle + turn]
