"""Frames that a scene prescribes, however it writes them, as matrices with columns d1, d2, d3."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ribbonopt.mechanics.rotations import matrix_of, product, quaternions_from
from ribbonopt.scene import Directors, End, Quaternion, Turns, Value

DIRECTORS = ("d1", "d2", "d3")
Parameters = dict[str, float]


def number(value: Value, parameters: Parameters) -> float:
    """Return a value of a scene, evaluating it if it is a formula."""
    if not isinstance(value, str):
        return float(value)
    from ribbonopt.scene.formulas.parsing import evaluate_value

    return evaluate_value(value, parameters)


def components(vector: Any, parameters: Parameters) -> dict[str, float]:
    """Return the prescribed components of a vector by axis; a triple stands for x, y, z."""
    return {axis: number(value, parameters) for axis, value in by_axis(vector)}


def by_axis(vector: Any) -> list[tuple[str, Any]]:
    """Return the prescribed components of a vector as they were written, by axis."""
    if vector is None:
        return []
    if is_dataclass(vector):
        pairs = [(f.name, getattr(vector, f.name)) for f in fields(vector)]
    else:
        pairs = list(zip("xyz", vector, strict=True))
    return [(axis, value) for axis, value in pairs if value is not None]


def unit(vector: Any, parameters: Parameters) -> np.ndarray:
    """Return a prescribed lab direction (3,) as a unit vector."""
    values = np.array([number(v, parameters) for v in vector])
    return np.asarray(values / np.linalg.norm(values))


def frame_of(end: End, parameters: Parameters) -> np.ndarray | None:
    """Frame (3, 3) of an end whose directors are prescribed as a whole, or None."""
    rotation = end.directors
    if rotation is None or isinstance(rotation, Directors):
        return _of_directors(end if rotation is None else rotation, parameters)
    q = quaternion_of(end, parameters)
    return None if q is None else matrix_of(q)


def quaternion_of(end: End, parameters: Parameters) -> np.ndarray | None:
    """Return the unit quaternion (4,) of an end whose directors are prescribed whole, or None.

    Rotations follow their angles without a jump of sign: after a whole turn it is the negative.
    """
    rotation = end.directors
    if rotation is None or isinstance(rotation, Directors):
        frame = frame_of(end, parameters)
        return None if frame is None else quaternions_from(frame[None])[0]
    if isinstance(rotation, Quaternion):
        given = np.array([number(v, parameters) for v in rotation.quaternion])
        return np.asarray(given / np.linalg.norm(given))
    q = np.array([1.0, 0.0, 0.0, 0.0])
    if isinstance(rotation, Turns):
        for turn in rotation.turns:
            ((axis, angle),) = components(turn, parameters).items()
            names = DIRECTORS if axis in DIRECTORS else ("x", "y", "z")
            by = _by(angle * np.eye(3)[names.index(axis)])
            q = np.array(product(q, by) if names is DIRECTORS else product(by, q))
    elif not isinstance(rotation, str):  # which is the identity
        q = _by(np.array([number(v, parameters) for v in rotation.rotation_vector]))
    return q


def _of_directors(source: End | Directors, parameters: Parameters) -> np.ndarray | None:
    given = {d: components(getattr(source, d), parameters) for d in DIRECTORS}
    whole = {d: np.array(list(v.values())) for d, v in given.items() if len(v) == 3}
    if len(whole) < 2:
        return None
    for i, j, k in (("d1", "d2", "d3"), ("d2", "d3", "d1"), ("d3", "d1", "d2")):
        if k not in whole:
            whole[k] = np.cross(whole[i], whole[j])
    matrix = np.stack([whole[d] for d in DIRECTORS], axis=1)
    # The scene was checked to be orthonormal to 1e-6; the nearest rotation removes the rest.
    left, _, right = np.linalg.svd(matrix)
    return np.asarray(left @ right)


def _by(vector: np.ndarray) -> np.ndarray:
    """Quaternion (4,) of the rotation by |v| about v (3,)."""
    half = float(np.linalg.norm(vector)) / 2
    return np.append(np.cos(half), np.sinc(half / np.pi) * vector / 2)
