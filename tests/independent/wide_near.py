"""The equilibrium of a wide ribbon near a solution of the package, to rounding, by other means."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from .described import edge_of, prescribed, strip_of
from .joining import OWN, Conditions
from .joints import Joints
from .path import rotation
from .rod import Array
from .samples import Samples
from .wide import ETA, D, M, N, P, R, Wide
from .wide_starts import meshed, polished

SIGNS = 40  # samples of A in each phase
SAMPLES = 1201  # of a solution without phases
PLANAR = 1e-9  # eta and p of a ribbon that stays in a plane, where all is smooth


def near(solution: Any, doubled: bool = True) -> tuple[Joints, Joints]:
    """Return the equilibrium near a solution, and that on steps twice as long (or the same).

    ArithmeticError where there is none; ValueError for what is not known here.
    """
    scene = solution.posed.scene
    strip = strip_of(scene)
    if not isinstance(strip, Wide):
        raise ValueError("the ribbon has no width")
    if strip.points or getattr(scene, "supports", ()):
        raise ValueError("loads and supports at places are not known here")
    a, b = scene.interval
    given = Samples(solution, a, b, strip.width)
    ends = a + (b - a) * np.asarray(solution.trajectory.ends)
    if len(ends) == 2:
        ends = np.array([a, *inflections(strip, given, a, b), b])
    size = given.sizes[1]
    reached = tuple(abs(strip.turn(given(s), np.array([s]))[0]) < 1e-6 * size for s in (a, b))
    start, conditions = meshed(strip, given.along, ends, reached), conditions_of(scene)
    found = polished(start, conditions, doubled=doubled)
    wrong = wrong_sign(found[0])
    if wrong:
        raise ArithmeticError(wrong)
    return found


def inflections(strip: Wide, given: Samples, a: float, b: float) -> list[float]:
    """About where A changes its sign, of a solution that is not in phases."""
    s = np.linspace(a, b, SAMPLES)[1:-1]
    y = given.along(s)
    A = strip.turn(y, s)
    at = np.flatnonzero((A[1:] > 0) != (A[:-1] > 0))
    planar = np.abs(y[[ETA, P]]).max() < PLANAR
    return [] if planar else list(s[at] + (s[at + 1] - s[at]) * A[at] / (A[at] - A[at + 1]))


def wrong_sign(joints: Joints) -> str:
    """What is wrong with A, if anything: in each phase it is to have one sign."""
    for first, last in pairwise(joints.ends):
        s = first + (last - first) * (np.arange(SIGNS) + 0.5) / SIGNS
        A = joints.law.turn(joints.at(s), s)
        if A.min() < 0 < A.max():
            return f"A changes its sign between {first:.6g} and {last:.6g}"
    return ""


def conditions_of(scene: Any) -> Conditions:
    """Return what a scene asks of both ends, of which there must be fourteen numbers."""
    asked = []
    for end, sign in ((scene.boundary.start, -1), (scene.boundary.end, 1)):
        if end is None:
            raise ValueError("an end of which nothing is said is not known here")
        edge = edge_of(end)
        if edge is None:
            raise ValueError("whether an edge is held is not known here")
        asked.append((prescribed(end, scene.parameters), sign, edge))

    def conditions(first: Array, last: Array) -> Array:
        found = []
        for y, (held, sign, edge) in zip((first, last), asked, strict=True):
            columns = y.shape[1]
            found += _given(y[R], held["r"])
            frame = y[D].reshape(3, 3, columns)
            if np.isfinite(held["directors"]).all():
                there = np.broadcast_to(held["directors"][:, :, None], frame.shape)
                found += list(rotation(frame, there))
            else:
                found += _given(y[D], held["directors"].ravel())
            found += _given(y[N], sign * held["n"]) + _given(y[M], sign * held["m"])
            found.append(y[ETA] if edge == "straight" else y[P])
        if len(found) != OWN:
            raise ValueError(f"{len(found)} conditions at both ends, expected {OWN}")
        return np.stack(found)

    return conditions


def _given(values: Array, asked: Array) -> list[Array]:
    return [v - x for v, x in zip(values, asked, strict=True) if np.isfinite(x)]
