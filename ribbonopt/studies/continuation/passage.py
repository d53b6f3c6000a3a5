"""Where phases change on a branch: the point itself, and what is behind it.

The branch is followed in its phases past the point where a margin (`phases`) vanishes, and that is
located there, where all is smooth. Behind it one of the branches that leave goes on (`leaving`).
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.checks.arcs import Arcs, leaps, sign_changes
from ribbonopt.solution.solution import Solution

from .leaving import admitted, leaving
from .phases import Change, What, margins, one_sign
from .refound import on_finer_meshes
from .relaid import in_other_phases
from .segment import Segment
from .walk.points import FOLD, KINK, POINT, Point
from .walk.protocol import Passage, Trial
from .walk.tangents import near

if TYPE_CHECKING:
    from .ribbons import RibbonEquations

ROUNDING = 1e-11  # a margin below minus that is negative
BEGIN = 0.01  # of a step, over which the slopes of margins are taken


def passage(
    equations: RibbonEquations, point: Point[Solution], trial: Trial[Solution], expected: Array
) -> Passage[Solution] | None:
    """Return the first change of phases between a point and a trial in its phases, None for none.

    Where the trial has not converged, what was expected of it tells. LinAlgError where a change
    cannot be passed.
    """
    if not point.solution.sheets:
        kind = one_sign(point.solution)
        if not kind:
            return _in_its_phases(equations, point, trial, expected)
        if trial.converged and one_sign(trial.solution) == kind:
            return None
        # A trial that did not converge may have stumbled over the leap of a law without phases.
        if not (trial.converged or equations.prepared.search(point.solution.posed).needs_phases):
            return None
        point, trial = _on_sheet(equations, point, trial, kind)
    if not trial.converged:
        inside = _lost(point.solution, expected)
        if inside:
            return _merged(equations, point, float(expected[-1]), inside)
        return _ahead(equations, point, expected)
    beyond = [c for c, value in margins(trial.solution).items() if value < -ROUNDING]
    if not beyond:
        return None
    try:
        return _passed(equations, point, trial, beyond)
    except np.linalg.LinAlgError:
        found = _ahead(equations, point, expected)
        if found is None:
            raise
        return found


def _passed(
    equations: RibbonEquations, a: Point[Solution], trial: Trial[Solution], beyond: list[Change]
) -> Passage[Solution]:
    """Return the first of the changes that a trial is beyond."""
    inside = [change for change in beyond if change.what is What.GONE_INSIDE]
    between = {change.phase for change in beyond if change.what is What.BORN_BETWEEN}
    way = Segment(equations, a, trial.unknowns, trial.solution)
    arcs = {
        change: way.root(change)
        for change in beyond
        # Where a slope has changed sign there are minima next to it.
        if change.what not in (What.GONE_INSIDE, What.BORN_INSIDE)
        or (change.what is What.BORN_INSIDE and not between & {change.phase - 1, change.phase})
    }
    if inside and not any(arc < way.whole / 2 for arc in arcs.values()):
        return _merged(equations, a, float(trial.unknowns[-1]), inside)
    first = min(arcs, key=lambda change: arcs[change])
    return _behind(equations, a, way.point(arcs[first]), first, beyond)


def _behind(
    equations: RibbonEquations,
    a: Point[Solution],
    event: Point[Solution],
    change: Change,
    beyond: list[Change],
) -> Passage[Solution]:
    """Return how a branch goes on behind an event, where one of the changes due has come."""
    ways = leaving(equations, event)
    if not ways:
        raise np.linalg.LinAlgError(_told(a.solution, beyond))
    first, stretch = ways[0].first, ways[0].stretch
    beside = stretch[0] if stretch else first
    kind = FOLD if event.tangent[-1] * beside.tangent[-1] < 0 else POINT
    crossed = len(ways) > 1 or beside.sign * event.sign < 0
    kind = KINK if crossed else kind
    event = replace(event, kind=kind)
    wanted = kind != POINT and equations.curve.special
    located = on_finer_meshes(equations, event, change) if wanted else None
    return Passage(a, event, stretch, first, located)


def _ahead(
    equations: RibbonEquations, a: Point[Solution], expected: Array
) -> Passage[Solution] | None:
    """Return the first change that margins at a point promise before what is expected, or None.

    Regularised laws have a pole behind the change, so that no trial may converge beyond it.
    """
    if not a.solution.sheets:
        return None
    way = Segment(equations, a, expected)
    near_by, here = way.margins(way.whole * BEGIN), margins(a.solution)
    slopes = {c: (near_by[c] - v) / (way.whole * BEGIN) for c, v in here.items() if c in near_by}
    arcs = {c: -here[c] / slope for c, slope in slopes.items() if slope < 0 < here[c]}
    change = min(arcs, key=lambda c: arcs[c], default=None)
    if change is None or not arcs[change] < way.whole:
        return None
    event = way.point(way.extrapolated(change, arcs[change]))
    return _behind(equations, a, event, change, [change])


def _on_sheet(
    equations: RibbonEquations, point: Point[Solution], trial: Trial[Solution], kind: int
) -> tuple[Point[Solution], Trial[Solution]]:
    """Return a point, and a trial, on one side of the law, of which a point without phases is."""
    search = equations.prepared.search(point.solution.posed)
    attempt = search.on_mesh((kind,), point.solution.mesh)
    point = replace(point, solution=attempt.restored(point.unknowns[:-1]))
    return point, equations.correct_at(point.solution, trial.unknowns)


def _in_its_phases(
    equations: RibbonEquations, point: Point[Solution], trial: Trial[Solution], expected: Array
) -> Passage[Solution] | None:
    """Return the same for a point whose law leaps somewhere, but not where its switch has zeros.

    It is smooth without phases, which only tell where one begins with a leap. None where the trial
    has none either.
    """
    search = equations.prepared.search(point.solution.posed)
    if not leaps(point.solution) or (trial.converged and not search.changes_sign(trial.solution)):
        return None
    begin = _posed_again(equations, point, sign_changes(point.solution, every=True))
    if begin is None:
        return None
    gap = equations.reduced(point.solution, expected - point.unknowns)
    arc = equations.metric.product(gap, equations.reduced(point.solution, point.tangent))
    ahead = begin.unknowns + arc * begin.tangent
    there = equations.correct_at(begin.solution, ahead)
    found = passage(equations, begin, there, ahead)
    if found is not None or not there.converged:
        return found
    way = admitted(equations, begin, there)
    return None if way is None else Passage(begin, begin, None, way)


def _posed_again(
    equations: RibbonEquations, point: Point[Solution], arcs: Arcs
) -> Point[Solution] | None:
    """Return a point in phases between its own sign changes, None where it is none."""
    search = equations.prepared.search(point.solution.posed)
    try:
        attempt, w = in_other_phases(search, point.solution, arcs.kinds, arcs.switches)
        found = equations.correct_at(attempt.restored(w), np.append(w, point.position))
        if not found.converged:
            return None
        ahead = equations.reduced(point.solution, point.tangent)
        local, tangent = near(equations, found.solution, found.unknowns, ahead)
    except np.linalg.LinAlgError:
        return None
    parts = replace(point, solution=found.solution, unknowns=found.unknowns)
    return replace(parts, tangent=tangent, sign=local.sign)


def _lost(solution: Solution, expected: Array) -> list[Change]:
    """Return what phases inside are expected to lose their length.

    Near where one does Newton's method fails, as the equations are singular there.
    """
    count = len(solution.sheets) - 1
    if count < 1:
        return []
    lengths = np.append(expected[-1 - count : -1], 0.0)
    lengths[-1] = solution.trajectory.length - lengths.sum()
    gone = (change for change in margins(solution) if change.what is What.GONE_INSIDE)
    return [change for change in gone if lengths[change.phase] < 0]


def _told(solution: Solution, changes: list[Change]) -> str:
    """Say that no equilibrium was found behind changes of phases, and what to do."""
    what = "; ".join(dict.fromkeys(change.told(solution) for change in changes))
    return (
        f"{what}, and no equilibrium was found in other phases: a smooth law needs none "
        "(law: {type: variational, delta: 0.01}, or regularized)"
    )


def _merged(
    equations: RibbonEquations,
    a: Point[Solution],
    position: float,
    inside: list[Change],
) -> Passage[Solution]:
    """Return what is behind a point where phases between others lose their length."""
    kinds, switches = list(a.solution.sheets), list(a.solution.trajectory.ends[1:-1])
    for change in sorted(inside, key=lambda change: -change.phase):
        i = change.phase
        # Its neighbours become one, unless it is a mixture between two sides of the law.
        gone = 2 if kinds[i - 1] == kinds[i + 1] else 1
        del kinds[i : i + gone], switches[i - 1 : i - 1 + gone]
    search = equations.prepared.search(equations.curve.posed_at(position))
    attempt, w = in_other_phases(search, a.solution, tuple(kinds), np.array(switches))
    there = attempt.restored(w)
    found = equations.correct_at(there, np.append(w, position))
    way = admitted(equations, a, found) if found.converged else None
    if way is None:
        raise np.linalg.LinAlgError(_told(a.solution, inside))
    return Passage(a, a, None, way)
