"""How often the end of a ribbon was turned on its way to the frame that a scene prescribes.

A frame does not say it: half a turn and one and a half are the same. Where a scene writes a frame
by rotations (`turns`, `rotation_vector`) of more than half a turn, these are taken at their word:
whole turns count. The equations do not know of it; the automatic start winds the ribbon so.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.mechanics.rotations import turn_vector, turns_about
from ribbonopt.scene import Boundary, End, RotationVector, Turns

from .frames import DIRECTORS, Parameters, components, frame_of, number

HALF = np.pi * (1 + 1e-12)
CLOSE = 1e-9


def winding(boundary: Boundary, parameters: Parameters) -> Array | None:
    """Return the rotation vector (3,) from the start's frame to the end's, along its directors.

    None where no rotation is by more than half a turn, so that the shortest one is meant, and where
    one of the frames is not prescribed.
    """
    turned = [_rotations(end, parameters) for end in (boundary.start, boundary.end)]
    if not any(np.linalg.norm(v) > HALF for vectors in turned for v in vectors):
        return None
    first, last = (frame_of(end, parameters) for end in (boundary.start, boundary.end))
    if first is None or last is None:
        return None
    total = first.T @ (np.sum(turned[1], axis=0) - np.sum(turned[0], axis=0))
    shortest = turn_vector(first.T @ last)
    angle, size = float(np.linalg.norm(shortest)), float(np.linalg.norm(total))
    if angle > CLOSE:
        axis = shortest / angle
    else:
        axis = total / size if size > CLOSE else total
    whole = round((float(total @ axis) - angle) / (2 * np.pi))
    return np.asarray((angle + 2 * np.pi * whole) * axis)


def _rotations(end: End, parameters: Parameters) -> Array:
    """Rotation vectors (k, 3), lab frame, that a scene writes the frame of an end by."""
    rotation, vectors = end.directors, [np.zeros(3)]
    if isinstance(rotation, RotationVector):
        vectors.append(np.array([number(v, parameters) for v in rotation.rotation_vector]))
    elif isinstance(rotation, Turns):
        frame = np.eye(3)
        for turn in rotation.turns:
            ((name, angle),) = components(turn, parameters).items()
            axes = frame if name in DIRECTORS else np.eye(3)
            names = DIRECTORS if name in DIRECTORS else ("x", "y", "z")
            vector = angle * axes[:, names.index(name)]
            vectors.append(vector)
            frame = turns_about(vector[None])[0] @ frame
    return np.array(vectors)
