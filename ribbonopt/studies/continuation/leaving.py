"""The branches that leave a point where phases change.

At it the ribbon is an equilibrium in other phases too. Each of these has a tangent of its own, of
which one half at most has all margins positive (`phases`): these half lines are the branches that
meet there. Beside the one that leads there it is one more, or, where several phases change at once,
maybe more: then branches cross, and leave linearly.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution

from .phases import EMPTY, Change, What, margins
from .relaid import at_the_ends, in_other_phases, with_born
from .walk.points import POINT, Point
from .walk.protocol import Trial
from .walk.tangents import near

if TYPE_CHECKING:
    from .ribbons import RibbonEquations

AT_ONCE = EMPTY  # margins at a change of phases that vanish there too
MOST = 4  # phases that change at once
AWAY, LEAST_AWAY = 0.02, 2e-4  # arclength of the first point behind a change of phases
SHORT = 0.02  # of the length: phase born inside, to begin with
SPLITTING = (What.BORN_INSIDE, What.BORN_BETWEEN, What.LEFT)


Found = tuple[Trial[Solution], Point[Solution] | None]


@dataclass(frozen=True, eq=False)
class Way:
    """A branch that leaves: its first point, and the stretch up to that if it is regular.

    The stretch is the event itself in the new phases, and the point before it was finished.
    """

    first: Point[Solution]
    stretch: tuple[Point[Solution], Point[Solution]] | None


def leaving(equations: RibbonEquations, event: Point[Solution]) -> list[Way]:
    """Return the branches that leave a change of phases, the straightest first.

    `event` is in the phases of the branch that leads there, and its tangent that branch's.
    """
    known = margins(event.solution)
    at_once = [change for change, value in known.items() if abs(value) <= AT_ONCE][:MOST]
    found = []
    for count in range(len(at_once), 0, -1):
        for changes in combinations(at_once, count):
            found += list(_entered(equations, event, changes))
    return sorted(found, key=lambda way: -_cosine(equations, event, way.first))


def _entered(
    equations: RibbonEquations, event: Point[Solution], changes: tuple[Change, ...]
) -> Iterator[Way]:
    """Yield the branch behind an event where these phases change, if there is one."""
    enter = _split if any(change.what in SPLITTING for change in changes) else _along_tangent
    away, turned = AWAY, None
    while away > LEAST_AWAY:
        for trial, entry in enter(equations, event, changes, away):
            first = admitted(equations, event, trial)
            if first is None:
                continue
            way = Way(first, _stretch(equations, entry, trial))
            if (first.position - event.position) * first.tangent[-1] >= 0:
                yield way
                return
            turned = way  # a fold is between: nearer by, it is still ahead
        away /= 4
    if turned is not None:
        yield turned


def _along_tangent(
    equations: RibbonEquations, event: Point[Solution], changes: tuple[Change, ...], away: float
) -> Iterator[Found]:
    """Yield what is found both ways along the tangent in other phases at the ends."""
    search = equations.prepared.search(equations.curve.posed_at(event.position))
    try:
        attempt, w = at_the_ends(search, event.solution, changes)
        there, unknowns = attempt.restored(w), np.append(w, event.position)
        ahead = equations.reduced(event.solution, event.tangent)
        found, tangent = near(equations, there, unknowns, ahead)
    except np.linalg.LinAlgError:
        return
    origin = replace(event, solution=there, unknowns=unknowns, tangent=tangent, sign=found.sign)
    for sign in (1, -1):
        guess = unknowns + sign * away * tangent
        trial = equations.correct_along(origin, sign * tangent, away, guess)
        if trial.converged:
            yield trial, _facing(equations, origin, sign)


def _stretch(
    equations: RibbonEquations, entry: Point[Solution] | None, trial: Trial[Solution]
) -> tuple[Point[Solution], Point[Solution]] | None:
    """Return the way from an event to a trial in one layout."""
    if entry is None:
        return None
    ahead = equations.reduced(entry.solution, entry.tangent)
    solution, unknowns = trial.solution, trial.unknowns
    try:
        found, tangent = near(equations, solution, unknowns, ahead)
    except np.linalg.LinAlgError:
        return None
    parts = replace(entry, solution=solution, unknowns=unknowns)
    return entry, replace(parts, tangent=tangent, sign=found.sign)


def _facing(
    equations: RibbonEquations, point: Point[Solution], sign: int
) -> Point[Solution] | None:
    """Return a point that faces along its tangent or against it."""
    ahead = sign * equations.reduced(point.solution, point.tangent)
    try:
        found, tangent = near(equations, point.solution, point.unknowns, ahead)
    except np.linalg.LinAlgError:
        return None
    return replace(point, tangent=tangent, sign=found.sign)


def _split(
    equations: RibbonEquations, event: Point[Solution], changes: tuple[Change, ...], away: float
) -> Iterator[Found]:
    """Yield what is found with short phases where the switch touches zero inside others.

    These are mixtures where both sides of the law drive the switch back to zero, or else of the
    other side.
    """
    if any(change.what not in SPLITTING for change in changes):
        return  # as good as never at once
    solution, width = event.solution, SHORT * away / AWAY
    touched = any(change.what is What.BORN_INSIDE for change in changes)
    for mixed in (True, False) if touched else (True,):
        kinds, switches, born = with_born(solution, changes, width, mixed, AT_ONCE)
        search = equations.prepared.search(equations.curve.posed_at(event.position))
        try:
            attempt, w = in_other_phases(search, solution, kinds, switches)
        except np.linalg.LinAlgError:
            continue
        there = attempt.restored(w)
        layout = attempt.nlp.layout
        row = np.zeros(len(layout.point_elements) * layout.nx + layout.nc + 1)
        row[[len(row) - len(kinds) + i for i in born]] = 1.0
        value = len(born) * width * solution.trajectory.length
        trial = equations.correct_with(there, row, value, np.append(w, event.position))
        if trial.converged:
            yield trial, None


def admitted(
    equations: RibbonEquations, event: Point[Solution], trial: Trial[Solution]
) -> Point[Solution] | None:
    """Return the point that a trial behind an event is, None where it has no right to be one."""
    if not all(value > 0 for value in margins(trial.solution).values()):
        return None
    there = equations.reduced(trial.solution, trial.unknowns)
    ahead = there - equations.reduced(event.solution, event.unknowns)
    final = equations.finished(event, trial)
    if not final.converged:
        return None
    try:
        found, tangent = near(equations, final.solution, final.unknowns, ahead)
    except np.linalg.LinAlgError:
        return None
    return replace(
        event,
        solution=final.solution,
        unknowns=final.unknowns,
        tangent=tangent,
        sign=found.sign,
        kind=POINT,
        note=final.note,
    )


def _cosine(equations: RibbonEquations, a: Point[Solution], b: Point[Solution]) -> float:
    """Cosine of the angle between the tangents of two points."""
    first, second = (equations.reduced(p.solution, p.tangent) for p in (a, b))
    return equations.metric.product(first, second)
