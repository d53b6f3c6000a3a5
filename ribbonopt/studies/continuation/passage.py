"""Where phases change on a branch: the point itself, and the branches that leave there.

The branch is followed in its phases past the point where a margin (`phases`) vanishes, and that is
located there, where all is smooth. At it the ribbon is an equilibrium in other phases too. Each has
a tangent of its own, of which one half at most has all margins positive: these half lines are the
branches that meet at the point. Beside the one that led there it is one more, or, where several
phases change at once, maybe more: then branches cross, and leave linearly.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution

from .phases import Change, What, margins, minima, profile
from .relaid import at_the_ends, in_other_phases
from .walk.points import KINK, POINT, Point
from .walk.protocol import Passage, Trial
from .walk.tangents import near

if TYPE_CHECKING:
    from .ribbons import RibbonEquations

ROUNDING = 1e-11  # a margin below minus that is negative
AT_ONCE = 1e-6  # margins at a change of phases that vanish there too
MOST = 4  # phases that change at once
AWAY, LEAST_AWAY = 0.02, 2e-4  # arclength of the first point behind a change of phases
SHORT = 0.02  # of the length: phase born inside, to begin with
CLOSE, MOST_TRIALS = 1e-14, 60
SPLITTING = (What.BORN_INSIDE, What.BORN_BETWEEN)


def passage(
    equations: RibbonEquations, a: Point[Solution], trial: Trial[Solution]
) -> Passage[Solution] | None:
    """Return the first change of phases between a point and a trial in its phases, None for none.

    LinAlgError where it cannot be passed.
    """
    beyond = [c for c, value in margins(trial.solution).items() if value < -ROUNDING]
    if not beyond:
        return None
    inside = [change for change in beyond if change.what is What.GONE_INSIDE]
    between = {change.phase for change in beyond if change.what is What.BORN_BETWEEN}
    way = _Way(equations, a, trial)
    arcs = {
        change: way.root(change)
        for change in beyond
        # Where a slope has changed sign there are minima next to it.
        if change.what not in (What.GONE_INSIDE, What.BORN_INSIDE)
        or (change.what is What.BORN_INSIDE and not between & {change.phase - 1, change.phase})
    }
    if inside and not any(arc < way.whole / 2 for arc in arcs.values()):
        return _merged(equations, a, float(trial.unknowns[-1]), inside)
    event = way.point(min(arcs.values()))
    ways = leaving(equations, event)
    if not ways:
        told = "; ".join(change.told(a.solution.sheets) for change in beyond)
        raise np.linalg.LinAlgError(f"{told}: no equilibrium was found in other phases")
    crossed = len(ways) > 1 or ways[0].sign * event.sign < 0
    kind = KINK if crossed else POINT
    return Passage(a, replace(event, kind=kind), ways[0])


def lost(
    equations: RibbonEquations, a: Point[Solution], expected: Array
) -> Passage[Solution] | None:
    """Return what is behind a point where a phase is expected to lose its length, None for none.

    Newton's method fails near where one does, as the equations are singular there.
    """
    solution, count = a.solution, len(a.solution.sheets) - 1
    if count < 1:
        return None
    total = solution.trajectory.length
    lengths = np.append(expected[-1 - count : -1], 0.0)
    lengths[-1] = total - lengths.sum()
    inside = [
        change
        for change in margins(solution)
        if change.what is What.GONE_INSIDE and lengths[change.phase] < 0
    ]
    return _merged(equations, a, float(expected[-1]), inside) if inside else None


def leaving(equations: RibbonEquations, event: Point[Solution]) -> list[Point[Solution]]:
    """Return the first points on the branches that leave a change of phases, the straightest first.

    `event` is in the phases of the branch that leads there, and its tangent that branch's.
    """
    known = margins(event.solution)
    at_once = [change for change, value in known.items() if abs(value) <= AT_ONCE][:MOST]
    found = []
    for count in range(len(at_once), 0, -1):
        for changes in combinations(at_once, count):
            found += list(_entered(equations, event, changes))
    return sorted(found, key=lambda way: -_cosine(equations, event, way))


def _entered(
    equations: RibbonEquations, event: Point[Solution], changes: tuple[Change, ...]
) -> Iterator[Point[Solution]]:
    """Yield the point behind an event on the branch where these phases change, if there is one."""
    enter = _split if any(change.what in SPLITTING for change in changes) else _along_tangent
    away = AWAY
    while away > LEAST_AWAY:
        for trial in enter(equations, event, changes, away):
            way = _admitted(equations, event, trial)
            if way is not None:
                yield way
                return
        away /= 4


def _along_tangent(
    equations: RibbonEquations, event: Point[Solution], changes: tuple[Change, ...], away: float
) -> Iterator[Trial[Solution]]:
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
            yield trial


def _split(
    equations: RibbonEquations, event: Point[Solution], changes: tuple[Change, ...], away: float
) -> Iterator[Trial[Solution]]:
    """Yield what is found with short phases where the switch touches zero inside others.

    These are mixtures where both sides of the law drive the switch back to zero, or else of the
    other side.
    """
    if any(change.what not in SPLITTING for change in changes):
        return  # as good as never at once
    solution, width = event.solution, SHORT * away / AWAY
    touched = any(change.what is What.BORN_INSIDE for change in changes)
    for mixed in (True, False) if touched else (True,):
        kinds, switches, born = _with_born(solution, changes, width, mixed)
        search = equations.prepared.search(equations.curve.posed_at(event.position))
        attempt, w = in_other_phases(search, solution, kinds, switches)
        there = attempt.restored(w)
        layout = attempt.nlp.layout
        row = np.zeros(len(layout.point_elements) * layout.nx + layout.nc + 1)
        row[[len(row) - len(kinds) + i for i in born]] = 1.0
        value = len(born) * width * solution.trajectory.length
        trial = equations.correct_with(there, row, value, np.append(w, event.position))
        if trial.converged:
            yield trial


def _with_born(
    solution: Solution, changes: tuple[Change, ...], width: float, mixed: bool
) -> tuple[tuple[int, ...], Array, list[int]]:
    """Return kinds, switches and which phases are new, of phases born inside those touched."""
    kinds: list[int] = []
    switches: list[float] = []
    born: list[int] = []
    ends = solution.trajectory.ends
    touched = {change.phase for change in changes if change.what is What.BORN_INSIDE}
    spread = {change.phase for change in changes if change.what is What.BORN_BETWEEN}
    for i, kind in enumerate(solution.sheets):
        if i - 1 in spread:
            switches += [float(ends[i]) - width / 2, float(ends[i]) + width / 2]
            born.append(len(kinds))
            kinds.append(0)
        elif kinds:
            switches.append(float(ends[i]))
        kinds.append(kind)
        for sigma, value in minima(solution, i, *profile(solution, i)) if i in touched else ():
            if value <= AT_ONCE:
                at = float(ends[i] + sigma * (ends[i + 1] - ends[i]))
                switches += [at - width / 2, at + width / 2]
                born.append(len(kinds))
                kinds += [0 if mixed else -kind, kind]
    return tuple(kinds), np.array(switches), born


def _admitted(
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
    parts = {"solution": final.solution, "unknowns": final.unknowns, "tangent": tangent}
    return replace(event, **parts, sign=found.sign, kind=POINT, note=final.note)


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
    way = _admitted(equations, a, found) if found.converged else None
    if way is None:
        told = "; ".join(change.told(a.solution.sheets) for change in inside)
        raise np.linalg.LinAlgError(f"{told}: no equilibrium was found without")
    return Passage(a, a, way)


def _cosine(equations: RibbonEquations, a: Point[Solution], b: Point[Solution]) -> float:
    """Cosine of the angle between the tangents of two points."""
    first, second = (equations.reduced(p.solution, p.tangent) for p in (a, b))
    return equations.metric.product(first, second)


class _Way:
    """The branch between a point and a trial in its phases, by arclength along the tangent."""

    def __init__(
        self, equations: RibbonEquations, a: Point[Solution], trial: Trial[Solution]
    ) -> None:
        self.equations, self.a = equations, a
        gap = equations.reduced(a.solution, trial.unknowns - a.unknowns)
        along = equations.reduced(a.solution, a.tangent)
        self.whole = equations.metric.product(gap, along)
        self.known: dict[float, tuple[Solution, Array]] = {
            0.0: (a.solution, a.unknowns),
            self.whole: (trial.solution, trial.unknowns),
        }

    def at(self, arc: float) -> tuple[Solution, Array]:
        """Return the branch at an arclength, from what is known of it near there."""
        if arc not in self.known:
            nearest = sorted(self.known, key=lambda s: abs(s - arc))[:4]
            guess = np.zeros_like(self.a.unknowns)
            for s in nearest:
                others = [other for other in nearest if other != s]
                weight = float(np.prod([(arc - other) / (s - other) for other in others]))
                guess += weight * self.known[s][1]
            found = self.equations.correct_along(self.a, self.a.tangent, arc, guess)
            if not found.converged:
                raise np.linalg.LinAlgError(f"no point where phases change: {found.message}")
            self.known[arc] = found.solution, found.unknowns
        return self.known[arc]

    def root(self, change: Change) -> float:
        """Return the arclength where a margin vanishes that is negative at the trial."""

        def margin(arc: float) -> float:
            return margins(self.at(arc)[0]).get(change, 1.0)

        return _root(margin, 0.0, self.whole)

    def point(self, arc: float) -> Point[Solution]:
        """Return the point at an arclength."""
        solution, unknowns = self.at(arc)
        ahead = self.equations.reduced(solution, self.a.tangent)
        found, tangent = near(self.equations, solution, unknowns, ahead)
        parts = {"solution": solution, "unknowns": unknowns, "tangent": tangent}
        return replace(self.a, **parts, sign=found.sign, note="")


def _root(f: Callable[[float], float], a: float, b: float) -> float:
    """Return a root by false position with halved weights (Illinois)."""
    fa, fb, whole = f(a), f(b), abs(b - a)
    if fa <= 0:
        return a
    for _ in range(MOST_TRIALS):
        if abs(fb) <= CLOSE or abs(b - a) <= CLOSE * whole:
            break
        c = (a * fb - b * fa) / (fb - fa)
        fc = f(c)
        if fc * fb < 0:
            a, fa = b, fb
        else:
            fa /= 2
        b, fb = c, fc
    return b
