"""Frames that a scene prescribes, however it writes them, as matrices with columns d1, d2, d3."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from ribbonopt.mechanics.rotations import matrix_of, turns_about
from ribbonopt.scene import Directors, End, Quaternion, Turn, Turns, Value

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
    if vector is None:
        return {}
    if is_dataclass(vector):
        pairs = [(f.name, getattr(vector, f.name)) for f in fields(vector)]
    else:
        pairs = list(zip("xyz", vector, strict=True))
    return {axis: number(v, parameters) for axis, v in pairs if v is not None}


def unit(vector: Any, parameters: Parameters) -> np.ndarray:
    """Return a prescribed lab direction (3,) as a unit vector."""
    values = np.array([number(v, parameters) for v in vector])
    return np.asarray(values / np.linalg.norm(values))


def frame_of(end: End, parameters: Parameters) -> np.ndarray | None:
    """Frame (3, 3) of an end whose directors are prescribed as a whole, or None."""
    rotation = end.directors
    if rotation == "identity":
        return np.eye(3)
    if rotation is None or isinstance(rotation, Directors):
        return _of_directors(end if rotation is None else rotation, parameters)
    if isinstance(rotation, Quaternion):
        return matrix_of(np.array([number(v, parameters) for v in rotation.quaternion]))
    if isinstance(rotation, Turns):
        frame = np.eye(3)
        for turn in rotation.turns:
            frame = _turned(frame, turn, parameters)
        return frame
    assert not isinstance(rotation, str)
    return np.asarray(
        turns_about(np.array([[number(v, parameters) for v in rotation.rotation_vector]]))[0]
    )


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


def _turned(frame: np.ndarray, turn: Turn, parameters: Parameters) -> np.ndarray:
    ((axis, angle),) = components(turn, parameters).items()
    names = DIRECTORS if axis in DIRECTORS else ("x", "y", "z")
    matrix = turns_about(angle * np.eye(3)[[names.index(axis)]])[0]
    return np.asarray(frame @ matrix if names is DIRECTORS else matrix @ frame)
