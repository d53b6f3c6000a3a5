"""The equilibrium of a wide ribbon near a solution of the package, to rounding, by other means."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from .described import edge_of, prescribed, strip_of
from .joining import OWN, Conditions
from .joints import Joints
from .path import rotation
from .rod import Array, along, dot
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
    start = meshed(strip, given.along, ends, reached)
    loop = getattr(scene.boundary, "loop", None)
    conditions = conditions_of(scene) if loop is None else half_loop(loop, start)
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
            for rows, name in ((N, "n"), (M, "m")):
                found += _given(y[rows], sign * held[name])
                found += _given(along(frame, y[rows]), sign * held[f"own {name}"])
            found.append(y[ETA] if edge == "straight" else y[P])
        if len(found) != OWN:
            raise ValueError(f"{len(found)} conditions at both ends, expected {OWN}")
        return np.stack(found)

    return conditions


def half_loop(loop: Any, start: Joints) -> Conditions:
    """Return what holds at both ends of half a loop, which begins where it does.

    It is its own image after half a turn about the line of d1 at the start, on which it ends, along
    d2 there if half twists are odd, else along d1.
    """
    if loop.piece != "half":
        raise ValueError("pieces of loops other than halves are not known here")
    odd = loop.half_twists % 2
    place, frame = start.y[R, :1], start.y[D, 0].reshape(3, 3)
    axis, across = frame[0], frame[1:]

    def conditions(first: Array, last: Array) -> Array:
        here, there = (y[D].reshape(3, 3, y.shape[1]) for y in (first, last))
        held = rotation(here, np.broadcast_to(frame[:, :, None], here.shape))
        start = [first[R] - place, held, *(dot(axis, first[v])[None] for v in (N, M))]
        way = [dot(d, last[R] - place)[None] for d in across]
        turn = [dot(axis, d)[None] for d in (there[1 - odd], there[2])]
        end = last[ETA] if odd else last[P]
        return np.concatenate([*start, first[P : P + 1], *way, *turn, end[None]])

    return conditions


def _given(values: Array, asked: Array) -> list[Array]:
    return [v - x for v, x in zip(values, asked, strict=True) if np.isfinite(x)]
