"""The first mesh in phases: graded to the poles of the law just beyond the ends of each phase.

A phase's law is continued analytically, and singular where the smoothed one has its layer: for
eq. (6.1) at chi m2 = -epsilon |m3| / 2, at the distance epsilon |m3| / (2 |m2'|) beyond a switch.
Elements grow in proportion to the distance from there, so that all of them see the same ellipse.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.accuracy.layers import Layers, layers
from ribbonopt.accuracy.remesh import graded, redistributed
from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.transcription import Mesh

NEAREST = 1e-9  # of a phase: closer poles are as far as this
# Times the even width, for elements far from poles: what they leave to those next to them. Measured
# on (6.1) at epsilon = 0.01, Gauss 8: no other grading of 6 to 12 elements is much more exact.
WIDER = 2.0
MOST = 1.1  # times their number, elements that may be wanted
LESS = 2.0  # times as far, where too few reach a pole


def toward_poles(attempt: Attempt, w: Array) -> Mesh | None:
    """Return a mesh of as many elements, graded to what unknowns w (nw,) show of poles.

    None where there are none near enough to be seen from a mesh so coarse.
    """
    shown = attempt.restored(w).trajectory
    near = [layers(shown, i) for i in range(len(attempt.sheets))]
    if not any(map(len, near)):
        return None
    phases = (np.diff(shown.dense.nodes(i)) for i in range(len(near)))
    return Mesh(tuple(_graded(h, poles) for h, poles in zip(phases, near, strict=True)))


def _graded(widths: Array, poles: Layers) -> Array:
    """Return as many relative widths, smaller next to poles.

    Elements that are too few to come near a pole, and to be wide enough elsewhere, come less near:
    much wider ones would be on another answer, or on none.
    """
    if not len(poles):
        return widths
    near = NEAREST

    def limit(positions: Array) -> Array:
        distance = np.abs(positions[:, None] - poles.places)
        return np.asarray(np.maximum(distance, near).min(axis=1))

    while True:
        positions, share = graded(widths, WIDER * widths, poles.places.real, limit)
        if share[-1] <= MOST * len(widths) or near >= 1:
            return redistributed(positions, share, len(widths))
        near = LESS * max(near, float(np.abs(poles.places.imag).min()))
