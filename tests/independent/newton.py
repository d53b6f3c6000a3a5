"""Newton's method, which makes the steps of a path meet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from .path import Path, rotation, turned
from .rod import Array, along, cross, step

DIFFERENCE = 1e-8  # relative, of difference quotients: Newton's method needs no more
MOST = 25
STALLED = 1e-7  # size of a step that may be rounding

Conditions = Callable[[Array, Array, Array, Array], Array]


def converged(path: Path, conditions: Conditions) -> Path:
    """Return the path with all gaps closed; ArithmeticError if they cannot be."""
    least, stalls = np.inf, 0
    for _ in range(MOST):
        path, size = newton_step(path, conditions)
        stalls = stalls + 1 if size > least / 4 else 0
        least = min(least, size)
        # Where steps do not shrink any more they are rounding: how much of it, `coarse` tells.
        if size < 1e-14 or (size < STALLED and stalls > (size > 1e-10)):
            return path
    raise ArithmeticError(f"Newton's method did not converge: last step {size:.1e}")


def newton_step(path: Path, conditions: Conditions) -> tuple[Path, float]:
    """Take one step; its size is the largest change, loads relative to themselves."""
    K, J = len(path.kind), len(path.switches)
    residual, matrix = linearised(path, conditions)
    scale = np.ones(6 * K + 6 + J)
    scale[6 * K : 6 * K + 3] = 1 + np.abs(path.n).max()
    scale[6 * K + 3 : 6 * K + 6] = 1 + np.abs(path.m0).max()
    if not np.isfinite(residual).all() or not np.isfinite(matrix.data).all():
        raise ArithmeticError("Newton's method met numbers that are not finite")
    try:
        change = splu(csc_matrix(matrix.multiply(scale))).solve(-residual)
    except RuntimeError as error:
        raise ArithmeticError("the linearised equations are singular") from error
    size = float(np.abs(change).max())
    change = change * scale * min(1.0, 0.3 / size)
    joints = change[: 6 * K].reshape(K, 6).T
    r, frames = path.r.copy(), path.frames.copy()
    r[:, 1:] += joints[:3]
    frames[:, :, 1:] = turned(frames[:, :, 1:], joints[3:])
    switches = path.switches + change[6 * K + 6 :]
    if (np.diff(np.concatenate([[0], switches, [path.length]])) <= 0).any():
        raise ArithmeticError("a phase vanishes")
    n, m0 = path.n + change[6 * K : 6 * K + 3], path.m0 + change[6 * K + 3 : 6 * K + 6]
    return replace(path, n=n, m0=m0, r=r, frames=frames, switches=switches), size


def linearised(path: Path, conditions: Conditions) -> tuple[Array, csc_matrix]:
    """Residual of all equations and its Jacobian.

    Unknowns: changes (r, turn) of joints 1 ... K, of n, of m0, of the switches.
    """
    K, J = len(path.kind), len(path.switches)
    way, frame, R = propagated(path)  # R (6, K, 9): of turn, m, n at the step's start
    gaps = np.concatenate(
        [path.r[:, :-1] + way - path.r[:, 1:], rotation(frame, path.frames[:, :, 1:])]
    )
    rows, cols, values = [], [], []

    def put(row: Array, col: Array, value: Array) -> None:
        row, col, value = np.broadcast_arrays(row, col, value)
        rows.append(row.ravel())
        cols.append(col.ravel())
        values.append(value.ravel())

    n = skew(path.n)
    arms = skew(path.r - path.r[:, :1])  # m_k = m0 + n x arm
    k, i, j = np.ogrid[:K, :6, :3]
    own = np.moveaxis(R, 1, 0)  # (K, 6, 9)
    of_m = own[:, :, 3:6]
    of_r = of_m @ n + np.vstack([np.eye(3), np.zeros((3, 3))])
    of_n = own[:, :, 6:] - of_m @ np.moveaxis(arms, 2, 0)[:-1]
    put(6 * k[1:] + i, 6 * (k[1:] - 1) + j, of_r[1:])
    put(6 * k[1:] + i, 6 * (k[1:] - 1) + 3 + j, own[1:, :, :3])
    put(6 * k + i, 6 * K + j, of_n)
    put(6 * k + i, 6 * K + 3 + j, of_m)
    put(np.arange(6 * K), np.arange(6 * K), -np.ones(6 * K))
    ends = along(frame, path.moments[:, :-1] + cross(path.n[:, None], way))
    u2, u3 = path.law.strains(path.kind, ends, along(frame, path.n[:, None] + 0 * path.h))
    rate = np.concatenate([frame[2], u2 * frame[1] + u3 * frame[2]]) * path.fractions
    later, earlier = path.phases < J, path.phases > 0
    k, i = np.ogrid[:K, :6]
    put(6 * k[later] + i, 6 * K + 6 + path.phases[later][:, None], rate.T[later])
    put(6 * k[earlier] + i, 6 * K + 5 + path.phases[earlier][:, None], -rate.T[earlier])
    residual = [gaps.T.ravel()]
    row = 6 * K
    for g, slopes, at in switch_conditions(path, n, arms):
        put(row, 6 * (at - 1) + np.arange(6), slopes[:6])
        put(row, 6 * K + np.arange(6), slopes[6:])
        residual.append(np.array([g]))
        row += 1
    value, slopes = end_conditions(path, conditions)
    put(row + np.arange(6)[:, None], np.r_[6 * (K - 1) : 6 * K + 6][None], slopes)
    residual.append(value)
    size = 6 * K + 6 + J
    if row + 6 != size:
        raise ArithmeticError("the phases do not follow each other")
    triple = (np.concatenate(values), (np.concatenate(rows), np.concatenate(cols)))
    return np.concatenate(residual), csc_matrix(triple, shape=(size, size))


def propagated(path: Path) -> tuple[Array, Array, Array]:
    """Ways, frames, and derivatives (6, K, 9) of both with respect to turn, m, n at the start."""
    K = len(path.kind)
    m, d = path.moments[:, :-1], path.frames[:, :, :-1]
    eta = DIFFERENCE * np.repeat([1, 1 + np.abs(path.moments).max(), 1 + np.abs(path.n).max()], 3)
    ms, ds = np.repeat(m[:, None], 10, axis=1), np.repeat(d[:, :, None], 10, axis=2)
    ns = np.repeat(np.repeat(path.n[:, None, None], 10, axis=1), K, axis=2)
    for i in range(3):
        w = np.zeros((3, K))
        w[i] = eta[i]
        ds[:, :, 1 + i] = turned(d, w)
        ms[i, 4 + i] += eta[3 + i]
        ns[i, 7 + i] += eta[6 + i]
    way, frame, _ = step(path.law, path.kind, ns, ms, ds, path.h)
    base_way, base = way[:, 0], frame[:, :, 0]
    of_way = way[:, 1:] - way[:, :1]
    of_frame = rotation(frame[:, :, 1:], np.broadcast_to(base[:, :, None], frame[:, :, 1:].shape))
    slopes = np.concatenate([of_way, of_frame]) / eta[None, :, None]
    return base_way, base, np.moveaxis(slopes, 1, 2)


def switch_conditions(path: Path, n: Array, arms: Array) -> list[tuple[float, Array, int]]:
    """Values and slopes (12,) of what holds where phases meet, with the joint.

    Slopes are by place and turn at the joint, n and m0.
    """
    found = []
    joints = np.flatnonzero(np.diff(path.phases)) + 1
    for (before, after), at in zip(pairwise(path.kinds), joints.tolist(), strict=True):
        frame, m = path.frames[:, :, at], path.moments[:, at]
        of_moment = [np.concatenate([d @ n, np.cross(d, m), -d @ arms[:, :, at], d]) for d in frame]
        m1, m2, m3 = frame @ m
        if before != 0:
            found.append((m2, of_moment[1], at))
        if after == 0:
            d1 = frame[0]
            slopes = np.concatenate([0 * d1, np.cross(d1, path.n), d1, 0 * d1])
            slopes += (m1 * of_moment[2] + m3 * of_moment[0]) / 4
            found.append((d1 @ path.n + m1 * m3 / 4, slopes, at))
    return found


def end_conditions(path: Path, conditions: Conditions) -> tuple[Array, Array]:
    """Values (6,) and slopes (6, 12): of r, turn at the far end, of n, of m0."""
    r, d = path.r[:, -1], path.frames[:, :, -1]
    value = conditions(r, d, path.n, path.m0)
    slopes = np.empty((6, 12))
    eta = DIFFERENCE * np.repeat([1, 1, 1 + np.abs(path.n).max(), 1 + np.abs(path.m0).max()], 3)
    for i in range(12):
        e = np.zeros(12)
        e[i] = eta[i]
        moved = conditions(r + e[:3], turned(d, e[3:6]), path.n + e[6:9], path.m0 + e[9:])
        slopes[:, i] = (moved - value) / eta[i]
    return value, slopes


def skew(v: Array) -> Array:
    """Matrices (3, 3, ...) of v x."""
    zero = 0 * v[0]
    return np.array([[zero, -v[2], v[1]], [v[2], zero, -v[0]], [-v[1], v[0], zero]])
