"""The first shape: what the conditions of a scene say of it before anything is solved."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import ConvergenceError
from ribbonopt.guess import FollowerLoads, IntegratedLoads
from ribbonopt.guess.named import loop_shape
from ribbonopt.guess.placing import place_ends
from ribbonopt.guess.shapes import Chord, Shape
from ribbonopt.mechanics.ends.conditions import Component, Frame
from ribbonopt.mechanics.ends.frames import DIRECTORS
from ribbonopt.mechanics.ends.winding import winding
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.scene import LoadGuess
from ribbonopt.solution.potential import dead_force_of

from .loops import loop_of

ACROSS = 1e-12  # cosine of a right angle
MIDDLE = np.array([0.5])
SMALL_BOW = 0.3  # radians, for a strip that nothing shortens but a load


def shapes_for(
    posed: Posed, ribbon: Ribbon | None = None, *, wound: bool = True
) -> Iterator[Shape]:
    """Yield shapes that fit the ends of a scene, the likeliest first.

    `ribbon` are mechanics in space of a scene of this structure, built anew if not given; `wound`
    as often as the ends say, where they say it; else as if they did not.
    """
    loop = loop_of(posed.scene)
    if loop is not None:
        yield loop_shape(posed, loop)
        return
    spatial = posed.under(states="reduced")
    start, end = place_ends(ribbon or Ribbon.of(spatial), spatial)
    length = posed.length
    chord = float(np.linalg.norm(end[0] - start[0]))
    # A strip that buckles: chord / length = 1 - bow^2 / 4.
    bow = 2 * np.sqrt(max(0.0, 1 - chord / length))
    turn = winding(posed.scene.boundary, posed.scene.parameters) if wound else None
    plain = Chord(start, end, length, winding=turn)
    if chord > length * (1 - 1e-9) and (posed.loaded or compresses(posed, plain)):
        bow = SMALL_BOW
    if posed.loads and bow:
        # To the side where it has the lesser potential: a strip that hangs, not an arch.
        pull = np.sum([load.mean_force() for load in posed.loads], axis=0)
        bow *= 1.0 if pull @ plain.frames(MIDDLE)[0][:, 0] >= 0 else -1.0
    yield replace(plain, bow=bow)
    if plain.straight and not bow:
        return
    if bow:
        yield replace(plain, bow=-0.5 * bow)
    if turn is not None:
        return  # other turns are not what the scene says
    for turns in (1.0, -1.0):
        yield replace(plain, bow=0.5 * bow, turns=turns)


def indeterminate(posed: Posed, chord: Chord) -> ConvergenceError:
    """Return what to say where a straight ribbon between clamps leaves loads undetermined."""
    law = capabilities(posed.scene)
    rigid = "it cannot bend in its own plane, so that the loads of its ends there are"
    if 0 in law.components and not law.stretches:
        rigid = "it cannot stretch, so that the force along it is"
    state = "held straight" if chord.taut else "straight and without stress"
    return ConvergenceError(
        f"the ribbon is {state}: {rigid} not determined; shorten or turn it, if only a little",
        "indeterminate",
    )


def loaded(posed: Posed) -> bool:
    """Whether there are loads, or a force or moment prescribed to be other than zero."""
    return posed.loaded or any(
        isinstance(c, Component) and not c.kinematic and c.value != 0 for c in posed.conditions
    )


def compresses(posed: Posed, chord: Chord) -> bool:
    """Whether a dead force pushes the ends together: a straight strip may buckle under it.

    A force across the strip, to rounding, does not.
    """
    force, along = dead_force_of(posed), chord.end[0] - chord.start[0]
    return bool(force @ along < -ACROSS * np.linalg.norm(force) * np.linalg.norm(along))


def follower_loads(
    posed: Posed, mechanics: Callable[[Posed], Ribbon] = Ribbon.of
) -> FollowerLoads | IntegratedLoads | None:
    """Return the ribbon that known loads along the end's directors bend, if the start is clamped.

    Loads that vanish are known in any frame, and so is a moment without a force. `mechanics` gives
    those in space of the scene in the inverted formulation.
    """
    conditions = posed.conditions
    if posed.loaded:
        return None  # what acts along the ribbon is known at its start only
    start = [c for c in conditions if getattr(c, "end", None) == "start"]
    clamped = any(isinstance(c, Frame) for c in start) and len(start) == 4
    found: dict[str, Array] = {}
    for quantity in ("force", "moment"):
        given = {
            c.axis: c.value
            for c in conditions
            if isinstance(c, Component) and (c.end, c.quantity) == ("end", quantity)
        }
        zero = set(given) == set("xyz") and not any(given.values())
        if quantity == "moment" and clamped and set(given) == set("xyz") and not zero:
            return _rolled(posed, given, mechanics) if not found["force"].any() else None
        if not zero and set(given) != set(DIRECTORS):
            return None
        found[quantity] = np.array(list(given.values()))
    if not clamped or not any(v.any() for v in found.values()):
        return None
    plain = posed.under(formulation="inverted", states="reduced")
    return FollowerLoads(mechanics(plain), plain, found["force"], found["moment"])


def _rolled(
    posed: Posed, moment: Mapping[str, float], mechanics: Callable[[Posed], Ribbon]
) -> IntegratedLoads:
    """Return the ribbon under a moment alone, lab frame, which is the same all along it."""
    plain = posed.under(formulation="inverted", states="reduced")
    x, y, z = (moment[axis] for axis in "xyz")
    return IntegratedLoads(mechanics(plain), plain, LoadGuess((0.0, 0.0, 0.0), (x, y, z)))
