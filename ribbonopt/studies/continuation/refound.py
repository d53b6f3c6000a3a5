"""A change of phases found again on finer meshes: how exactly its place is known."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.solution.solution import Solution

from .phases import Change
from .segment import Segment
from .walk.points import Point
from .walk.special import ROUNDING, SAFETY
from .walk.tangents import moved

if TYPE_CHECKING:
    from .ribbons import RibbonEquations

MESHES = 3  # at most
BEFORE, BEGIN = 1e-3, 5e-4  # arclength before the place known so far, and the first step from there


def on_finer_meshes(
    equations: RibbonEquations, event: Point[Solution], change: Change
) -> Point[Solution]:
    """Return the point where a margin vanishes, with the bound of the error of its position.

    It is found anew on halved elements until that moves it little enough. What it moves is the
    error of the coarser mesh, and so a bound of that of the finer. Where it is not found again, it
    stays as it is, and its error unknown.
    """
    for _ in range(MESHES):
        try:
            found = _finer(equations, event, change)
        except np.linalg.LinAlgError:
            found = None
        if found is None:
            return event
        error = SAFETY * abs(found.position - event.position)
        event = replace(found, error=max(error, ROUNDING * abs(found.position)))
        if equations.enough(error, event.position):
            break
    return event


def _finer(
    equations: RibbonEquations, event: Point[Solution], change: Change
) -> Point[Solution] | None:
    """Return the same on halved elements, from a little before; None where there are no finer."""
    before = event.unknowns - BEFORE * event.tangent
    places = [equations.finer(event.solution, w) for w in (before, event.unknowns)]
    if None in places:
        return None
    (solution, unknowns), (_, ahead) = (place for place in places if place is not None)
    tangent = ahead - unknowns
    tangent = tangent / equations.metric.length(equations.reduced(solution, tangent))
    begin = replace(event, solution=solution, unknowns=unknowns, tangent=tangent)
    trial = equations.correct_along(begin, tangent, 0.0, unknowns)
    if not trial.converged:
        return None
    begin = moved(equations, begin, trial)
    way = Segment(equations, begin, begin.unknowns + BEFORE * begin.tangent)
    return replace(way.point(way.extrapolated(change, BEGIN)), kind=event.kind)
