"""Words for free motions of a ribbon as a whole: along what, about what."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

SMALL = 1e-6  # of directions, and of positions relative to the length
AXES_BY_NAME = dict(zip("xyz", np.eye(3), strict=True))


@dataclass(frozen=True, eq=False)
class Ends:
    """Both ends at the unknowns z: positions relative to the reference and the length, frames."""

    r: Array  # (2, 3)
    frames: Array  # (2, 3, 3), columns d1, d2, d3
    origin: Array  # (3,), of the lab frame

    @property
    def chord(self) -> Array:
        """From the start to the end."""
        return np.asarray(self.r[1] - self.r[0])


def separated(free: Array) -> tuple[Array, Array]:
    """Pure translations and others (rows of 6) that span the motions (6, k), along the lab axes."""
    _, sizes, right = np.linalg.svd(free[3:])
    rank = int((sizes > SMALL * np.abs(free).max()).sum())
    shifts = _reduced((free @ right[rank:].T).T[:, :3])
    turns = (free @ right[:rank].T).T
    turns = _reduced(turns[:, [3, 4, 5, 0, 1, 2]])[:, [3, 4, 5, 0, 1, 2]]
    across = np.linalg.qr(shifts.T)[0]
    turns[:, :3] -= turns[:, :3] @ across @ across.T
    return np.hstack([shifts, np.zeros_like(shifts)]), turns


def _reduced(rows: Array) -> Array:
    """Rows (k, n) of the same span, each with a one where the others have a zero."""
    rows = rows.copy()
    for i in range(len(rows)):
        below = np.abs(rows[i:])
        columns = np.flatnonzero(below.max(axis=0) > SMALL * below.max())
        column = columns[0]
        best = i + int(below[:, column].argmax())
        rows[[i, best]] = rows[[best, i]]
        rows[i] /= rows[i, column]
        others = np.arange(len(rows)) != i
        rows[others] -= np.outer(rows[others, column], rows[i])
    return rows


def words(shifts: Array, turns: Array, ends: Ends) -> str:
    """Say what is free, after "free"; motions as `separated` gives them."""
    if len(shifts) == len(turns) == 3:
        return "to move and to turn as a whole"
    parts = [f"to move along {_direction(shift[:3], ends)}" for shift in shifts]
    if len(shifts) == 3:
        parts = ["to move in every direction"]
    if len(turns) == 3:
        return " and ".join([*parts, "to turn in every direction"])
    return " and ".join([*parts, *(_turning(turn, shifts, ends) for turn in turns)])


def _turning(turn: Array, shifts: Array, ends: Ends) -> str:
    """Say which turn; where its axis is, unless free translations may shift it."""
    shift, w = turn[:3], turn[3:] / np.linalg.norm(turn[3:])
    shift = shift / np.linalg.norm(turn[3:])
    direction = _direction(w, ends)
    if (np.abs(np.cross(shifts[:, :3], w)) > SMALL).any():
        return f"to turn about {direction}"
    if abs(shift @ w) > SMALL:
        return f"to move on a screw along {direction}"
    distances = [np.linalg.norm(shift + np.cross(w, p)) for p in (*ends.r, ends.origin)]
    if max(distances[:2]) < SMALL:
        return "to turn about the line through its ends"
    if distances[2] < SMALL and direction in AXES_BY_NAME:
        return f"to turn about the {direction} axis"
    for name, distance in zip(("start", "end"), distances, strict=False):
        if distance < SMALL:
            return f"to turn about the line through its {name} along {direction}"
    return f"to turn about a line along {direction}"


def _direction(vector: Array, ends: Ends) -> str:
    """Name a direction: a lab axis, the chord, a director, or numbers."""
    vector = vector / np.linalg.norm(vector)
    named = dict(AXES_BY_NAME)
    size = float(np.linalg.norm(ends.chord))
    if size > SMALL:
        named["the line through its ends"] = ends.chord / size
    for end, frame in zip(("start", "end"), ends.frames, strict=True):
        named |= {f"d{i + 1} of the {end}": frame[:, i] for i in range(3)}
    for name, direction in named.items():
        if np.linalg.norm(np.cross(vector, direction)) < SMALL:
            return name
    return f"({', '.join(f'{v:.3g}' for v in np.round(vector, 6) + 0.0)})"
