"""Ribbons with states of their own as steps that are to meet: multiple shooting, one Newton.

Unknown are all states where steps meet (places, turns of frames, forces, moments, eta, p) and the
inflections, at which A = 0: p is not zero there, u2 goes to zero like d / log d at a distance d.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from .joints import Joints, step
from .path import rotation, turned
from .rod import Array, cross
from .wide import ETA, D, M, N, P, R

OWN = 14  # unknowns of a joint: place, turn of the frame, and what follows
REST = [*range(12, 18), ETA, P]  # rows of n, m, eta and p
IMAGINARY = 1e-40
MOST = 60
STALLED = 1e-7
QUADRATIC = 1e-11  # the next step would be far below rounding

Conditions = Callable[[Array, Array], Array]


def closed(joints: Joints, conditions: Conditions) -> Joints:
    """Return it with all gaps closed; ArithmeticError if they cannot be.

    `conditions` takes the states (22, k) at both ends and gives residuals (14, k). Newton's method
    is damped so that what the same slopes make of the next residual shrinks.
    """
    least, stalls = np.inf, 0
    for _ in range(MOST):
        residual, solve, scale = linearised(joints, conditions)
        change = -solve(residual)
        size, share = float(np.abs(change).max()), 1.0
        share = min(1.0, 0.5 / size)
        while True:
            try:
                after = moved(joints, share * change * scale)
                again = solve(residual_of(after, conditions))
                if size < 1e-6 or np.linalg.norm(again) < (1 - share / 4) * np.linalg.norm(change):
                    break
            except (ArithmeticError, ValueError):
                pass
            share /= 2
            if share < 1e-4:
                raise ArithmeticError(f"Newton's method is stuck: step {size:.1e}")
        joints = after
        stalls = stalls + 1 if size > least / 4 and share == 1 else 0
        least = min(least, size)
        if (size < QUADRATIC and share == 1) or (size < STALLED and stalls > (size > 1e-10)):
            return joints
    raise ArithmeticError(f"Newton's method did not converge: last step {size:.1e}")


def moved(joints: Joints, change: Array) -> Joints:
    """Return it with unknowns changed."""
    count = OWN * len(joints.s)
    own = change[:count].reshape(-1, OWN).T
    y = joints.y.copy()
    y[R] += own[:3]
    y[D] = turned(y[D].reshape(3, 3, -1), own[3:6]).reshape(9, -1)
    y[REST] += own[6:]
    ends = joints.ends.copy()
    ends[1:-1] += change[count:]
    if (np.diff(ends) <= 0).any():
        raise ArithmeticError("a phase vanishes")
    if not np.isfinite(y).all():
        raise ArithmeticError("numbers that are not finite")
    return replace(joints, y=y, ends=ends)


def gaps(reached: Array, there: Array) -> Array:
    """Return differences (14, ...) of states (22, ...)."""
    turn = rotation(*(y[D].reshape(3, 3, *y.shape[1:]) for y in (reached, there)))
    return np.concatenate([reached[R] - there[R], turn, reached[REST] - there[REST]])


def residual_of(joints: Joints, conditions: Conditions) -> Array:
    """Return the residuals of all equations."""
    with np.errstate(all="ignore"):
        found = gaps(joints.steps(), joints.y[:, 1:]).T.ravel()
    inner = np.flatnonzero(np.diff(joints.phases)) + 1
    turn = joints.law.turn(joints.y[:, inner], joints.s[inner])
    ends = conditions(joints.y[:, :1], joints.y[:, -1:])[:, 0]
    found = np.concatenate([found, turn, ends])
    if not np.isfinite(found).all():
        raise ArithmeticError("numbers that are not finite")
    return found


def varied(y: Array) -> Array:
    """States (22, 15, ...): as they are, and with each unknown a little along the imaginary."""
    out = np.repeat(y[:, None].astype(complex), OWN + 1, axis=1)
    d = y[D].reshape(3, 3, *y.shape[1:])
    for i in range(3):
        out[i, 1 + i] += 1j * IMAGINARY
        axis = np.zeros_like(d[0])
        axis[i] = IMAGINARY
        out[D, 4 + i] += 1j * np.concatenate([cross(axis, e) for e in d])
    for i, row in enumerate(REST):
        out[row, 7 + i] += 1j * IMAGINARY
    return out


def linearised(
    joints: Joints, conditions: Conditions
) -> tuple[Array, Callable[[Array], Array], Array]:
    """Residuals, a solver of scaled linear equations, and the scale of the unknowns."""
    K, J = len(joints.h), len(joints.ends) - 2
    y, phases = joints.y, joints.phases
    vary = varied(y[:, :-1])
    # One column more: the length of the phase.
    vary = np.concatenate([vary, y[:, None, :-1] + 0j], axis=1)
    h = np.repeat(joints.h[None].astype(complex), OWN + 2, axis=0)
    h[-1] += 1j * IMAGINARY * joints.fractions
    with np.errstate(all="ignore"):
        reached = step(joints.law, joints.s[:-1], vary, h)
    there = np.broadcast_to(y[:, None, 1:], reached.shape)
    gap = gaps(reached, there)
    slopes = gap[:, 1:].imag / IMAGINARY  # (14, 15, K)
    rows, cols, values = [], [], []

    def put(row: Array, col: Array, number: Array) -> None:
        for all_, one in zip(
            (rows, cols, values), np.broadcast_arrays(row, col, number), strict=True
        ):
            all_.append(one.ravel())

    k, i, j = np.ogrid[:K, :OWN, :OWN]
    put(OWN * k + i, OWN * k + j, np.moveaxis(slopes[:, :OWN], 2, 0))
    put(np.arange(OWN * K), np.arange(OWN * K) + OWN, -np.ones(OWN * K))
    k, i = np.ogrid[:K, :OWN]
    base = OWN * (K + 1)
    for side in (0, -1):  # a phase is longer by its end, shorter by its start
        inner = (phases + side >= 0) & (phases + side < J)
        column = np.broadcast_to((base + phases + side)[inner, None], (inner.sum(), OWN))
        put(OWN * k[inner] + i, column, (1 + 2 * side) * slopes[:, OWN].T[inner])
    row = OWN * K
    for at in np.flatnonzero(np.diff(phases)) + 1:
        one = varied(y[:, at : at + 1])
        turn = joints.law.turn(one, np.broadcast_to(joints.s[at], one.shape[1:]))
        put(row, OWN * at + np.arange(OWN), turn[1:, 0].imag / IMAGINARY)
        row += 1
    for at, first in ((0, True), (K, False)):
        one = varied(y[:, at])
        other = np.repeat(y[:, -1 if first else 0, None], OWN + 1, axis=1)
        found = conditions(*((one, other) if first else (other, one)))
        slope = found[:, 1:].imag / IMAGINARY
        put(row + np.arange(len(slope))[:, None], OWN * at + np.arange(OWN)[None], slope)
    size = base + J
    scale = np.ones((K + 1, OWN))
    for part, unknowns in ((N, slice(6, 9)), (M, slice(9, 12)), (P, 13)):
        scale[:, unknowns] = 1 + np.abs(y[part]).max() if part != P else np.abs(y[P]).max() + 1e-3
    scale = np.concatenate([scale.ravel(), np.ones(J)])
    found = [np.concatenate(v) for v in (rows, cols, values)]
    matrix = coo_matrix((found[2] * scale[found[1]], (found[0], found[1])), shape=(size, size))
    weight = 1 / np.maximum(np.asarray(abs(matrix.tocsr()).max(axis=1).todense()).ravel(), 1e-300)
    matrix = matrix.tocsr().multiply(weight[:, None]).tocsc()
    try:
        factors = splu(matrix)
    except RuntimeError as error:
        raise ArithmeticError("the linearised equations are singular") from error
    return residual_of(joints, conditions), lambda r: factors.solve(r * weight), scale


def clamped(
    places: Sequence[Array], frames: Sequence[Array], straight: tuple[bool, bool]
) -> Conditions:
    """Return the conditions of two clamps: eta = 0 where the edge is straight, else p = 0."""

    def conditions(first: Array, last: Array) -> Array:
        found = []
        for y, r, d, edge in zip((first, last), places, frames, straight, strict=True):
            there = np.broadcast_to(np.reshape(d, (3, 3, 1)), (3, 3, y.shape[1]))
            found += [y[R] - np.reshape(r, (3, 1)), rotation(y[D].reshape(3, 3, -1), there)]
            found.append(y[ETA : ETA + 1] if edge else y[P : P + 1])
        return np.concatenate(found)

    return conditions
