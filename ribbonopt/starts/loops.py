"""Loops that scenes declare, and those that their ends make without saying so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.guess.shapes import Shape, TwistedCircle
from ribbonopt.mechanics.ends.conditions import Component
from ribbonopt.mechanics.ends.frames import DIRECTORS, components, frame_of
from ribbonopt.mechanics.ends.loops import end_turn
from ribbonopt.mechanics.laws.asymmetry import changed_by_flip
from ribbonopt.mechanics.laws.catalogue import always_the_same
from ribbonopt.problem import Posed
from ribbonopt.scene import Boundary, Law, Loads, Loop, Scene, Variational

CLOSE = 1e-9
MOST_TWISTS = 9  # up to which Newton's method was compared with the least energy


def loop_of(scene: Scene) -> Loop | None:
    """Return the loop that a scene declares, or that its ends make without saying so.

    Undeclared loops have the fewest half twists: 0 or 1 for a whole loop, eq. (6.2); 1 for a half
    as that of section 5.
    """
    boundary, parameters = scene.boundary, scene.parameters
    if boundary.loop is not None:
        return boundary.loop
    if {boundary.start.support, boundary.end.support} - {None, "clamped"}:
        return None
    places = [components(end.position, parameters) for end in (boundary.start, boundary.end)]
    shared = {axis for axis in places[0] if places[0][axis] == places[1].get(axis)}
    if components(boundary.end.force, parameters):
        return None  # a load moves this end
    first = frame_of(boundary.start, parameters)
    if len(shared) < 2 or not places[1].keys() <= shared or first is None:
        return None
    last = frame_of(boundary.end, parameters)
    if last is None:
        half = len(shared) == 2 and _ends_across(boundary, parameters, first, shared)
        return Loop(1, "half") if half else None
    for half_twists in (0, 1):
        if np.abs(first @ end_turn(half_twists) - last).max() < CLOSE:
            return Loop(half_twists)
    return None


def closed_posed(posed: Posed) -> Posed:
    """Return a scene whose whole loop is closed in space too, as the least energy needs it.

    Equations of equilibrium may leave a component of the gap to symmetry, eq. (6.2).
    """
    scene, loop = posed.scene, loop_of(posed.scene)
    if scene.boundary.loop is not None or loop is None or loop.piece != "whole":
        return posed
    x, y, z = posed.start[0]
    end = replace(scene.boundary.end, position=(float(x), float(y), float(z)))
    return Posed.of(replace(scene, boundary=replace(scene.boundary, end=end)))


def fundamental_scene(scene: Scene) -> Scene | None:
    """Return the fundamental piece of the declared band that a scene is more of, or None.

    It is uniform and nothing acts on it, for symmetry's sake: a band that is not so starts from it.
    """
    loop = scene.boundary.loop
    if loop is None or loop.piece == "fundamental" or abs(loop.half_twists) < 2:
        return None
    pieces = loop.fundamental.pieces // loop.pieces
    length = (scene.interval[1] - scene.interval[0]) / pieces
    boundary = Boundary(loop=loop.fundamental)
    piece = replace(scene, boundary=boundary, interval=(0.0, length), guess="auto")
    piece = replace(piece, loads=Loads(), gravity=None, supports=(), natural=None, width=None)
    own = always_the_same(scene.law) or not changed_by_flip(piece, Posed.of(piece).theta)
    return piece if own else None


def newton_suffices(posed: Posed, shape: Shape, law: Law) -> bool:
    """Whether Newton's method leads from a twisted circle to what least energy leads to.

    A uniform band under the smooth law, which nothing acts on, has no numbers but delta and its
    half twists: both were compared. Not with two, where less energy is out of the plane, nor from
    more of a band than its smallest piece, which least energy untwists.
    """
    if not (isinstance(shape, TwistedCircle) and isinstance(law, Variational)):
        return False
    scene, loop = posed.scene, loop_of(posed.scene)
    uneven = (scene.natural, scene.width, scene.membrane) != (None, None, None)
    if loop is None or posed.loaded or uneven:
        return False
    if abs(loop.half_twists) > 1:
        return loop.piece == "fundamental" and 2 < abs(loop.half_twists) <= MOST_TWISTS
    if scene.boundary.loop is not None:
        return not scene.boundary.also
    # Undeclared it must not slide along itself either: eq. (6.2), section 5.
    zero = [c for c in posed.conditions if isinstance(c, Component) and not c.value]
    free = {c.quantity for c in zero if (c.end, c.axis) == ("start", "d1")}
    return free >= ({"force"} if loop.piece == "whole" else {"force", "moment"})


def _ends_across(
    boundary: Boundary, parameters: dict[str, float], first: np.ndarray, shared: set[str]
) -> bool:
    """Whether the end has d2 along the axis that is d1 at the start, on which its position is."""
    (axis,) = set("xyz") - shared
    given = {d: components(getattr(boundary.end, d), parameters) for d in DIRECTORS}
    across = all(given[d].get(axis) == 0 for d in ("d1", "d3")) and not given["d2"]
    return bool(across and abs(abs(first["xyz".index(axis), 0]) - 1) < CLOSE)
