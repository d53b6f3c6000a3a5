"""A ribbon moved along one of its modes of small vibrations, as pieces to draw."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.checks.modes import Modes
from ribbonopt.solution.solution import Solution

from .pieces import ROWS, Array, Piece
from .subject import Subject, subject_of

SHARE = 0.13  # largest displacement that is drawn, of the extent of the ribbon,
TURN = 0.7  # and largest rotation (radians): who turns more is moved less
WHOLE = 1e-6  # of the length: arclengths this near to the end reach it
NOTHING = 1e-300


def subject_with(solution: Solution, modes: Modes, rows: int = ROWS) -> Subject:
    """Sample the ribbon that modes are of: the whole band, or only the piece that was solved."""
    start, end = solution.scene.interval
    piece = bool(modes.s[-1] <= end + WHOLE * (end - start))
    return subject_of(solution, complete=not piece, rows=rows)


def carried(s: Array, modes: Modes, number: int) -> tuple[Array, Array]:
    """Return displacement and rotation (k, 3) of a mode, from 0 on, at arclengths s (k,)."""
    found = modes.displacement[number], modes.rotation[number]
    displacement, rotation = (
        np.stack([np.interp(s, modes.s, column) for column in vectors.T], axis=1)
        for vectors in found
    )
    return displacement, rotation


def amplitude_of(subject: Subject, modes: Modes, number: int) -> float:
    """Return what to multiply a mode by so that it is well seen, and small all the same.

    Of modes that move nothing it is a largest rotation, else a largest displacement over the unit
    of length.
    """
    line = np.concatenate([piece.r for piece in subject.pieces])
    size = float(np.linalg.norm(np.ptp(line, axis=0)))
    moved, turned = (
        float(np.linalg.norm(vectors[number], axis=1).max())
        for vectors in (modes.displacement, modes.rotation)
    )
    return min(SHARE * size / max(moved, NOTHING), TURN / max(turned, NOTHING))


def moved(subject: Subject, modes: Modes, number: int, amplitude: float) -> Subject:
    """Return a ribbon moved by a mode: r + a dr, directors turned by a times its rotation.

    Generatrices stay what they are at rest. Lab frame, units of the scene.
    """
    solved, mirrored = (
        tuple(_moved(piece, *carried(piece.s, modes, number), amplitude) for piece in pieces)
        for pieces in (subject.solved, subject.mirrored)
    )
    return replace(subject, solved=solved, mirrored=mirrored)


def _moved(piece: Piece, displacement: Array, rotation: Array, amplitude: float) -> Piece:
    def turned(directors: Array) -> Array:
        return turned_by(amplitude * rotation, directors)

    return replace(
        piece,
        r=piece.r + amplitude * displacement,
        d1=turned(piece.d1),
        d2=turned(piece.d2),
        d3=turned(piece.d3),
    )


def turned_by(rotation: Array, vectors: Array) -> Array:
    """Return vectors (k, 3) turned by rotation vectors (k, 3), radians (Rodrigues' formula)."""
    angle = np.linalg.norm(rotation, axis=1)[:, None]
    axis = rotation / np.maximum(angle, NOTHING)
    along = np.einsum("ki,ki->k", axis, vectors)[:, None]
    cos, sin = np.cos(angle), np.sin(angle)
    return np.asarray(cos * vectors + sin * np.cross(axis, vectors) + (1 - cos) * along * axis)
