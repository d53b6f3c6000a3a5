"""Unit quaternions and rotation matrices, as numbers and as CasADi expressions.

A quaternion q = (q0, q1, q2, q3), scalar first, stands for the rotation that takes the lab axes to
the directors; column i of its matrix is d_i in the lab frame.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array


def directors_of(q: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Directors d1, d2, d3 (lab frame) of the quaternion q (4,), quadratic in q."""
    a, b, c, d = q[0], q[1], q[2], q[3]
    d1 = ca.vertcat(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c))
    d2 = ca.vertcat(2 * (b * c - a * d), a * a - b * b + c * c - d * d, 2 * (c * d + a * b))
    d3 = ca.vertcat(2 * (b * d + a * c), 2 * (c * d - a * b), a * a - b * b - c * c + d * d)
    return d1, d2, d3


def matrix_of(q: Array) -> Array:
    """Frame (3, 3) of a quaternion (4,) of numbers, whose length is removed."""
    a, b, c, d = np.asarray(q) / np.linalg.norm(q)
    vector = np.array([b, c, d])
    cross = np.array([[0, -d, c], [d, 0, -b], [-c, b, 0]])
    turned: Array = (2 * a * a - 1) * np.eye(3) + 2 * np.outer(vector, vector) + 2 * a * cross
    return turned


def turns_about(vectors: Array) -> Array:
    """Matrices (k, 3, 3) of the rotations by |v| about each vector v of (k, 3): Rodrigues."""
    angle = np.linalg.norm(vectors, axis=1)
    x, y, z = (vectors / np.where(angle > 0, angle, 1.0)[:, None]).T
    zero = np.zeros_like(x)
    K = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)
    sin, versine = np.sin(angle)[:, None, None], (1 - np.cos(angle))[:, None, None]
    turned: Array = np.eye(3) + sin * K + versine * (K @ K)
    return turned


def turn_vector(turn: Array) -> Array:
    """Rotation vector (3,), of length at most pi, of a matrix (3, 3)."""
    q = quaternions_from(np.asarray(turn)[None])[0]
    sine = float(np.linalg.norm(q[1:]))
    if sine == 0:
        return np.zeros(3)
    return np.asarray(2 * np.arctan2(sine, q[0]) * q[1:] / sine)


def cross_matrix(v: Array) -> Array:
    """Matrix (3, 3) of v x."""
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def product(p: Any, q: Any) -> list[Any]:
    """Components of the Hamilton product p q."""
    return [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]


def quaternions_from(frames: Array) -> Array:
    """Return the unit quaternions (n, 4) of the frames (n, 3, 3), whose columns are the directors.

    The sign of each is the one nearer to its predecessor, so that a continuous frame gives a
    continuous quaternion; the first has a positive scalar part (or, at half a turn, whatever
    the largest component gives).
    """
    R = np.asarray(frames, dtype=float)
    # Of the four columns of the matrix 4 q q^T, the one of largest diagonal is safe to divide by.
    K = (R.reshape(-1, 9) @ _products() + np.eye(4).ravel()).reshape(-1, 4, 4)
    best = np.argmax(np.einsum("nii->ni", K), axis=1)
    q = K[np.arange(len(R)), best]
    q /= np.sqrt((q * q).sum(axis=1, keepdims=True))
    if q[0, 0] < 0:
        q[0] = -q[0]
    if len(q) == 1:
        return np.asarray(q)
    flips = np.where(np.einsum("ni,ni->n", q[1:], q[:-1]) < 0, -1.0, 1.0)
    q[1:] *= np.cumprod(flips)[:, None]
    return np.asarray(q)


@cache
def _products() -> Array:
    """Coefficients (9, 16) of the entries of R in those of 4 q q^T less the identity."""
    R = np.eye(9).reshape(9, 3, 3)
    trace = np.trace(R, axis1=1, axis2=2)
    K = np.empty((9, 4, 4))
    K[:, 0, 0] = trace
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        K[:, i + 1, i + 1] = 2 * R[:, i, i] - trace
        K[:, 0, i + 1] = K[:, i + 1, 0] = R[:, k, j] - R[:, j, k]
        K[:, i + 1, j + 1] = K[:, j + 1, i + 1] = R[:, i, j] + R[:, j, i]
    found = K.reshape(9, 16)
    found.setflags(write=False)
    return found
