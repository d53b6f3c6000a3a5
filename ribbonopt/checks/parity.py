"""Which modes of an open ribbon are symmetric: under what carries its shape to itself, reversed.

An equilibrium may be carried to itself by an orthogonal Q that reverses it, r(L - s) = Q r(s) about
its middle: a reflection of an arch, half a turn of a sheared one. A mode then is symmetric where Q
carries its displacement to that of the other end, antisymmetric where to the opposite. Of Q one is
taken that leaves alone what the shape does not fill: the plane of a planar ribbon, the two
directions across a straight one.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution

from .modes import Modes
from .topology import closure

SYMMETRIC, ANTISYMMETRIC = "symmetric", "antisymmetric"
SAME = 1e-4  # of the extent: farthest from its image that a shape may be
FLAT = 1e-9  # of the largest squared extent: the shape does not fill that direction
CLEAR = 0.02  # of the largest displacement: farthest from its image that a mode may be
STILL = 1e-6  # largest displacement over largest rotation, in lengths: nothing but turns
BEYOND = 1e-9  # of the length: modes that reach farther are of more than what was solved
SAMPLES = 201


def parities(solution: Solution, modes: Modes) -> tuple[str, ...]:
    """Return for each mode "symmetric", "antisymmetric", or "" where it is neither.

    Also "" for all of a shape that nothing carries to itself. A closed band is reversed about where
    it was begun.
    """
    r = _line(solution, modes)
    carried = None if r is None else _reversing(r)
    if r is None or carried is None:
        return ("",) * len(modes.squared)
    s = np.linspace(modes.s[0], modes.s[-1], len(r))
    length = float(modes.s[-1] - modes.s[0])
    return tuple(
        _parity(_at(s, modes.s, d), _at(s, modes.s, t), carried, length)
        for d, t in zip(modes.displacement, modes.rotation, strict=True)
    )


def _line(solution: Solution, modes: Modes) -> Array | None:
    """Return evenly spaced points (k, 3) of what modes are of; None where they are not known."""
    start, end = map(float, solution.scene.interval)
    if modes.s[-1] <= end + BEYOND * (end - start):
        return np.asarray(solution.outputs(np.linspace(start, end, SAMPLES))["r"])
    band = closure(solution)
    if band is None:
        return None
    r = band.line(SAMPLES - 1)
    return np.concatenate([r, r[:1]])


def _reversing(r: Array) -> Array | None:
    """Return Q (3, 3) with r(L - s) = Q r(s) about the middle; None where there is none.

    `r` (k, 3) are evenly spaced points of the centre line.
    """
    r = r - r.mean(axis=0)
    both = r[::-1].T @ r
    sizes, axes = np.linalg.eigh((both + both.T) / 2)
    signs = np.where(sizes < -FLAT * np.abs(sizes).max(), -1.0, 1.0)
    found = np.asarray(axes * signs @ axes.T)
    off = np.abs(r[::-1] - r @ found).max()
    return found if off <= SAME * float(np.ptp(r, axis=0).max()) else None


def _parity(displacement: Array, rotation: Array, carried: Array, length: float) -> str:
    """Compare a mode (k, 3) with its image; rotations are axial vectors."""
    size, turn = np.abs(displacement).max(), np.abs(rotation).max()
    vectors, turned = displacement, carried
    if size <= STILL * length * turn:
        vectors, turned = rotation, np.linalg.det(carried) * carried
    image = vectors @ turned
    allowed = CLEAR * np.abs(vectors).max()
    if np.abs(vectors[::-1] - image).max() <= allowed:
        return SYMMETRIC
    return ANTISYMMETRIC if np.abs(vectors[::-1] + image).max() <= allowed else ""


def _at(s: Array, known: Array, vectors: Array) -> Array:
    """Return vectors (k, 3) known at arclengths, at others."""
    return np.stack([np.interp(s, known, column) for column in vectors.T], axis=1)
