"""What lies between two points of a branch: the scene's own value, and branches that cross."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.ribbons import RibbonEquations
from ribbonopt.studies.continuation.walk.beside import Beside
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, FOLD, Point
from ribbonopt.studies.continuation.walk.special import TESTS

SAMPLES = 33  # of the position between two points
NEAR = 0.5  # of the way from a point to a turn: an own value that is so near may be passed there
OFF = 0.3  # most distance of an answer from its guess, of the way between the two points
ROUNDS = 30
EXACT = 1e-10  # of the way: how exactly the own value is met where Newton's method fails at it

Crossing = tuple[Solution, int]  # a solution at the own value, and which way the branch goes there


def crossings(
    equations: RibbonEquations, a: Point[Solution], b: Point[Solution], own: float
) -> Iterator[Crossing | None]:
    """Yield the solutions at the own value between two points; None where one is not found."""
    turns, passes = a.tangent[-1] * b.tangent[-1] < 0, (a.position - own) * (b.position - own) < 0
    if not (turns or passes):
        return
    if not _one_layout(a, b):
        if passes:
            trial = equations.correct_at(b.solution, np.append(b.unknowns[:-1], own))
            way = 1 if b.position > a.position else -1
            yield (trial.solution, way) if trial.converged else None
        return
    try:
        stretch = _Stretch(equations, a, b)
        arcs = stretch.arcs(own, turns)
    except np.linalg.LinAlgError:
        yield None
        return
    for arc, way in arcs:
        solution = stretch.at(arc, own)
        yield None if solution is None else (solution, way)


def crossing_beside(
    equations: RibbonEquations, a: Point[Solution], b: Point[Solution], own: float
) -> Iterator[Crossing | None]:
    """Yield the same between a point where branches cross and the first one on another of them.

    There the position goes along the branch, or with its square: the nearer guess counts.
    """
    if not (a.position - own) * (b.position - own) < 0:
        return
    part, gap = (own - a.position) / (b.position - a.position), b.unknowns - a.unknowns
    found = []
    for share in (part, np.sqrt(part)):
        guess = np.append((a.unknowns + share * gap)[:-1], own)
        trial = equations.correct_at(b.solution, guess)
        if trial.converged:
            off = equations.reduced(b.solution, trial.unknowns - guess)
            found.append((equations.metric.length(off), trial.solution))
    way = 1 if b.position > a.position else -1
    yield (min(found, key=lambda one: one[0])[1], way) if found else None


def branch_point(
    equations: RibbonEquations, a: Point[Solution], b: Point[Solution]
) -> Point[Solution] | None:
    """Return where another branch crosses between two points, None for nowhere or not found."""
    if not (a.sign * b.sign < 0 and _one_layout(a, b)):
        return None
    try:
        beside = Beside(equations, a, b)
        arc = beside.root(TESTS[BRANCH_POINT](beside))
    except np.linalg.LinAlgError:
        return None
    if arc is None:
        return None
    unknowns, tangent = beside.unknowns(arc), beside.tangent(arc)
    solution = equations.restored(a.solution, unknowns)
    return replace(
        a, solution=solution, unknowns=unknowns, tangent=tangent, kind=BRANCH_POINT, note=""
    )


class _Stretch:
    """A branch between two points of one layout, by arclength."""

    def __init__(self, equations: RibbonEquations, a: Point[Solution], b: Point[Solution]) -> None:
        """Linearise at both ends."""
        self.equations, self.a = equations, a
        self.beside = Beside(equations, a, b)

    def arcs(self, own: float, turns: bool) -> list[tuple[float, int]]:
        """Return where the own value is passed, about, and which way."""
        whole = self.beside.whole
        arcs = np.linspace(0.0, whole, SAMPLES)
        if turns and self._turn_tells(own, arcs):
            root = self.beside.root(TESTS[FOLD](self.beside))
            if root is not None:
                arcs = np.sort(np.append(arcs, root))
        heights = np.array([self._position(arc) - own for arc in arcs])
        found = []
        for i in np.flatnonzero(heights[:-1] * heights[1:] < 0):
            part = heights[i] / (heights[i] - heights[i + 1])
            found.append(
                (float(arcs[i] + part * (arcs[i + 1] - arcs[i])), int(np.sign(heights[i + 1])))
            )
        return found

    def at(self, arc: float, own: float) -> Solution | None:
        """Return the solution at the own value near an arclength, None where there is none."""
        equations, a, whole = self.equations, self.a, abs(self.beside.whole)
        guess = np.append(self.beside.unknowns(arc)[:-1], own)
        trial = equations.correct_at(a.solution, guess)
        off = equations.metric.length(equations.reduced(a.solution, trial.unknowns - guess))
        if trial.converged and off <= OFF * min(whole, abs(arc) + whole / 10):
            return trial.solution
        return self._by_arclength(arc, own)

    def _by_arclength(self, arc: float, own: float) -> Solution | None:
        """Return the same, next to where the branch turns: by points at given arclengths."""
        for _ in range(ROUNDS):
            probe = self.beside.at(arc, 0.0)
            if probe is None:
                return None
            rate = probe.tangent[-1]
            change = (own - float(probe.unknowns[-1])) / rate if rate else np.inf
            if abs(change) <= EXACT * abs(self.beside.whole):
                return probe.solution
            if not abs(change) <= abs(self.beside.whole):
                return None
            arc += change
        return None

    def _turn_tells(self, own: float, arcs: np.ndarray) -> bool:
        """Whether the own value may be passed at the turn between the points."""
        heights = np.array([self._position(arc) for arc in arcs])
        up = self.a.tangent[-1] > 0
        top = float(heights.max() if up else heights.min())
        rise = top - (max if up else min)(heights[0], heights[-1])
        return bool(
            (top - own) * (1 if up else -1) > -NEAR * abs(rise) - 1e-3 * abs(np.ptp(heights))
        )

    def _position(self, arc: float) -> float:
        return float(self.beside.unknowns(arc)[-1])


def _one_layout(a: Point[Solution], b: Point[Solution]) -> bool:
    """Whether the unknowns of two points stand for the same things."""
    mine, others = a.solution, b.solution
    same = mine.dense.blocks is others.dense.blocks and mine.sheets == others.sheets
    return same and all(
        np.array_equal(x, y) for x, y in zip(mine.mesh.phases, others.mesh.phases, strict=True)
    )
