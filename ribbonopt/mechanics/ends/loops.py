"""Closed bands: the conditions of a whole loop, of a half, and of the fundamental piece.

Whole loop: position and frame return, with d1 and d2 reversed for an odd number k of half twists.
A loop can slide along itself; n1(0) = 0 in place of one component of the gap removes that (6.2),
and by symmetry the gap then closes. (Where the energy is minimised sliding does no harm, and where
a loop is not the same all along, or loaded, nothing slides: all of the gap is prescribed.)

Half: flip symmetry about d1 at the start and, half way, about the same line, along which there is
d2 (k odd) or d1 (k even); the half loop of section 5 for k = 1.

Fundamental piece, length L / (2 |k|): the band is carried to itself by turns of 2 pi / k about
e_y, and by flips about the x axis and its images. The start is on the x axis, d1 along it, the end
on the line at the angle pi / k, d2 along it; all loads that vanish there are natural.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.scene import End, Loop

from .conditions import Component, Condition, Direction, Frame
from .frames import Parameters, components, frame_of
from .placement import Closed, OnLine

Vector = tuple[float, float, float]


def loop_conditions(
    loop: Loop, start: End, parameters: Parameters, *, closed: bool
) -> list[Condition]:
    """Return the conditions of a loop; `closed` prescribes all of the gap and not n1(0) = 0."""
    if loop.piece == "fundamental":
        return _fundamental(loop)
    place = components(start.position, parameters) or dict.fromkeys("xyz", 0.0)
    frame = frame_of(start, parameters)
    frame = np.eye(3) if frame is None else frame
    conditions: list[Condition] = [
        *(Component("start", "position", axis, value) for axis, value in place.items()),
        Frame.of("start", frame),
    ]
    if loop.piece == "half":
        return [*conditions, *_half(loop.half_twists, tuple(place.values()), frame)]
    across = (0, 1, 2) if closed else (1, 2)
    conditions += [Closed(f"d{i + 1}", _vector(frame[:, i])) for i in across]
    if not closed:
        conditions.append(Component("start", "force", "d1", 0.0))
    return [*conditions, Frame.of("end", frame @ end_turn(loop.half_twists))]


def end_turn(half_twists: int) -> np.ndarray:
    """Turn (3, 3), in directors, from the start of a loop to its end."""
    sign = -1.0 if half_twists % 2 else 1.0
    return np.diag([sign, sign, 1.0])


def axis_at_end(half_twists: int, angle: float) -> tuple[str, Vector]:
    """Director along the flip axis at the end of a piece, and its direction in the start's frame.

    `angle` is that of the axes, in the plane of d1 and d3 of the start: pi for a half, pi / |k| for
    the fundamental piece. The sign is that of the twisted circle.
    """
    pieces = np.pi / angle
    turn = half_twists * np.pi / (2 * pieces)
    radial = (-np.cos(angle), 0.0, np.sin(angle))
    if round(half_twists / pieces) % 2:
        return "d2", _vector(np.sin(turn) * np.array(radial))
    return "d1", _vector(-np.cos(turn) * np.array(radial))


def _half(half_twists: int, place: tuple[float, ...], frame: np.ndarray) -> list[Condition]:
    director, direction = axis_at_end(half_twists, np.pi)
    x, y, z = place
    return [
        Component("start", "force", "d1", 0.0),
        Component("start", "moment", "d1", 0.0),
        OnLine("end", (x, y, z), _vector(frame[:, 0])),
        Direction("end", director, _vector(frame @ direction)),
    ]


def _fundamental(loop: Loop) -> list[Condition]:
    director, direction = axis_at_end(loop.half_twists, 2 * np.pi / loop.pieces)
    return [
        OnLine("start", (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
        Direction("start", "d1", (1.0, 0.0, 0.0)),
        Component("start", "force", "d1", 0.0),
        Component("start", "moment", "d1", 0.0),
        OnLine("end", (0.0, 0.0, 0.0), direction),
        Direction("end", director, direction),
        Component("end", "force", director, 0.0),
        Component("end", "moment", director, 0.0),
    ]


def _vector(values: np.ndarray) -> Vector:
    x, y, z = (float(v) + 0.0 for v in values)
    return (x, y, z)
