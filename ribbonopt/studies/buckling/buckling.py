"""Buckling loads of straight ribbons whose law has no linearisation at m2 = m3 = 0.

    for found in buckling_loads(scene, "parameters.P", 1, 8):
        print(found.value, found.error)
        solve with guess=found.guess(0.05)

Lateral buckling of a strip by a force along its width, or by its own weight, is such a state: it
bears n and m1, but neither m2 nor m3, until it buckles. See `infinitesimal` for the equations.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.checks.zero_moment import SHORTEST, unbent_share
from ribbonopt.errors import ModelError
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.scene import Scene
from ribbonopt.scene.lens import with_value
from ribbonopt.solution.solution import Solution

from .found import Buckling
from .straight import BEYOND, StraightStates


def buckling_loads(scene: Scene, parameter: str, start: float, end: float) -> tuple[Buckling, ...]:
    """Return the buckling loads of a straight ribbon as a number of its scene moves.

    Those that are found: each load of a linear rod in the place of the ribbon is followed to the
    ribbon's law.

    Parameters
    ----------
    scene
        The scene; its law is homogeneous of degree one, and the ribbon straight without m2 and m3.
    parameter
        What moves, as in a `continuation`, such as `parameters.P`.
    start, end
        Its range, in the units of the scene.

    Returns
    -------
    tuple of Buckling
        By increasing distance from the start.

    Raises
    ------
    ModelError
        If the ribbon at the start is not such a state, or its law has states of its own.
    """
    # Another formulation has the same straight states; one that minimises may not find them.
    first = with_value(replace(scene, formulation="inverted", continuation=None), parameter, start)
    prepared = prepare(first)
    straight = prepared.solve()
    found = buckling_from(prepared, straight, parameter, start, end)
    bent = float(np.abs(straight.at_nodes["u1"]).max())
    if not found and prepared.ribbon.law.edgewise and bent > 0:
        raise ModelError(
            f"{parameter}: no buckling load was found, but the ribbon is bent in its own plane "
            "before it buckles (membrane.bending), where some may be missed; search a smaller "
            "range, or leave membrane.bending out",
            "membrane.bending",
        )
    return found


def buckling_from(
    prepared: Prepared, straight: Solution, parameter: str, start: float, end: float
) -> tuple[Buckling, ...]:
    """Return what `buckling_loads` does, from a straight solution at any load."""
    if unbent_share(straight, prepared.ribbon.law) < 1 - SHORTEST or not straight.verified:
        raise ModelError(
            f"{parameter}: buckling loads are sought where a ribbon is straight with m2 = m3 = 0 "
            f"all along and its law (found {straight.scene.law.type}) has no linearisation there; "
            "else `continue` finds them as branch points"
        )
    if prepared.ribbon.law.states:
        raise ModelError(
            f"law {straight.scene.law.type}: has states of its own, of which the equations of an "
            "infinitesimal deflection know nothing",
            "law",
        )
    states = StraightStates(
        prepared, straight, lambda value: with_value(straight.scene, parameter, value)
    )
    # A ribbon is softer than the rod that has its stiffnesses, at most by two: a rod may buckle
    # beyond the range, as far as there are straight ones.
    low, high = min(start, end), max(start, end)
    found = None
    for share in BEYOND:
        reach = low + min(0.0, share * low), high + max(0.0, share * high)
        found = states.between(*reach)
        if found is not None:
            break
    inside = [one for one in found or () if low <= one.value <= high]
    return tuple(sorted(inside, key=lambda one: abs(one.value - start)))
