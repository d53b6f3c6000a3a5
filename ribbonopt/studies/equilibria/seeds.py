"""Where a search for all equilibria begins: shapes buckled in half waves, further starts."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.errors import ConvergenceError
from ribbonopt.guess import ShapeGuess
from ribbonopt.guess.named import moments_of
from ribbonopt.guess.shapes import Chord
from ribbonopt.mechanics.rotations import turns_about
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.problem import Posed
from ribbonopt.solution.solution import Solution
from ribbonopt.starts.equilibria import more_starts
from ribbonopt.starts.first_shape import shapes_for

AUTOMATIC = "automatic start"
POINTS = 257  # that positions are summed at
SMALL = 0.3  # radians: amplitude of half waves of a ribbon that nothing shortens


@dataclass(frozen=True, eq=False)
class HalfWaves(Chord):
    """A chord that bows in a number of half waves, as a strip buckles between clamps.

    The angle of the tangent about d2 is that of the small deflections at the buckling load `count`,
    of largest size `bow`; it vanishes at both ends.
    """

    count: int = 1

    @property
    def rate(self) -> float:
        """Root of the buckling load, times the length: of cos or sin of the angle."""
        q = np.pi * (self.count + 1) / 2
        # Of even counts tan x = x at half of it.
        return 2 * q if self.count % 2 else 2 * (q - 1 / q - 2 / (3 * q**3))

    def angles(self, fraction: Array) -> Array:
        """Angles (k,) about d2 at fractions (k,) of the length."""
        t = self.rate * (fraction - 0.5)
        odd = bool(self.count % 2)
        wave = np.sin(t) if odd else np.cos(t) - np.cos(self.rate / 2)
        return np.asarray(self.bow * wave)

    def frames(self, fraction: Array) -> Array:
        """Frames (k, 3, 3) at fractions (k,) of the length."""
        bow = turns_about(self.angles(fraction)[:, None] * np.eye(3)[1])
        chord = Chord(self.start, self.end, self.length, winding=self.winding)
        return np.asarray(chord.frames(fraction) @ bow)

    def positions(self, fraction: Array) -> Array:
        """Positions (k, 3): along the tangents, and what is left over shared out evenly."""
        places = np.linspace(0.0, 1.0, POINTS)
        d3 = self.length * self.frames(places)[:, :, 2]
        steps = (d3[1:] + d3[:-1]) / 2 * np.diff(places)[:, None]
        way = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
        (start, _), (end, _) = self.start, self.end
        way += places[:, None] * (end - start - way[-1])
        return np.stack([np.interp(fraction, places, c) for c in (start + way).T], axis=1)


def chord_of(posed: Posed) -> Chord | None:
    """Return the chord between the ends of a scene, None of what is no strip between two."""
    shape = next(shapes_for(posed), None)
    return shape if isinstance(shape, Chord) else None


def shortening_of(chord: Chord) -> float:
    """Return what a chord is shorter than the ribbon, over its length; 0 where it is not."""
    (start, _), (end, _) = chord.start, chord.end
    return max(0.0, 1 - float(np.linalg.norm(end - start)) / chord.length)


def first_load_energy(posed: Posed) -> float:
    """Return the strain energy of a strip that buckles between clamps, units Dw = L = 1.

    That of small deflections, 4 pi^2 times the shortening over the length; 0 where nothing shortens
    the ribbon.
    """
    chord = chord_of(posed)
    return 0.0 if chord is None else 4 * np.pi**2 * shortening_of(chord) / chord.length


def seeds(prepared: Prepared, posed: Posed, modes: int) -> Iterator[tuple[str, Solution]]:
    """Yield what to begin with, each with its name: verified solutions, perhaps the same again.

    The automatic start, then half waves of both signs, then the scene's `starts`.
    """
    try:
        found = prepared.solve(posed)
        if found.verified:
            yield AUTOMATIC, found
    except ConvergenceError:  # of this start: others may lead somewhere
        found = None
    yield from waves(prepared, posed, modes)
    attempt = partial(prepared.polish, scene=posed)
    more = more_starts(posed, prepared.automatic, attempt, range(1, posed.scene.starts))
    yield from ((f"start {i}", found) for i, found in enumerate(more, start=2))


def waves(prepared: Prepared, posed: Posed, modes: int) -> Iterator[tuple[str, Solution]]:
    """Yield the verified solutions that shapes of one to so many half waves lead to."""
    chord = chord_of(posed)
    if chord is None:
        return
    amplitude = 2 * np.sqrt(shortening_of(chord)) or SMALL
    moments = moments_of(posed, prepared.ribbon)
    for count in range(1, modes + 1):
        for sign in (1, -1):
            parts = chord.start, chord.end, chord.length, sign * amplitude
            shape = HalfWaves(*parts, winding=chord.winding, count=count)
            guess = ShapeGuess(shape, moments).balanced()
            try:
                found = prepared.solve(posed, guess=guess, fallback=False, quick=True)
            except ConvergenceError:  # of this shape
                continue
            if found.verified:
                waves = "1 half wave" if count == 1 else f"{count} half waves"
                yield f"{waves}, {'to d1' if sign > 0 else 'from d1'}", found
