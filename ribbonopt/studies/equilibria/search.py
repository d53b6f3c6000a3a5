"""All equilibria of one scene: every branch is followed, through its folds, from what is known.

A branch on which a number of the scene moves passes the scene's own value again and again, and each
time that is an equilibrium. From each two halves of a branch leave, to either side; each is
followed once, and so are those of the branches that cross, until nothing new comes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np

from ribbonopt.errors import ConvergenceError
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.problem import Posed
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.ribbons import RibbonEquations
from ribbonopt.studies.continuation.walk.points import POINT, Point
from ribbonopt.studies.continuation.walk.switching import switched
from ribbonopt.studies.continuation.walk.walk import Ending, Walk

from .between import Crossing, branch_point, crossing_beside, crossings
from .line import Line
from .nodes import Junction, Node, Nodes, far_off

SAME = 1e-5  # relative distance of two answers of one equilibrium, at least
AGREES = 1e3  # times the tolerance: the same
COARSE = 1e-4  # the same, where there is no tolerance
MET = 1e-4  # arclength between two estimates of one point where branches cross

AWAY = 1e-6  # arclength of a first step onto a branch that crosses, at least: loads count little
MET_ANOTHER = "came to where another had been"
NOT_LOCATED = "crossed by others that were not located"
DOUBTS = 20  # crossings that are not located, after which none is looked for

Tell = Callable[[str], None]


def quiet(_: str) -> None:
    """Tell nothing."""


class Search:
    """The search, as far as it has come."""

    def __init__(
        self, prepared: Prepared, posed: Posed, below: float, points: int, tell: Tell
    ) -> None:
        """Begin with nothing; `below` is the strain energy, in units of the scene."""
        self.prepared, self.posed, self.below, self.most = prepared, posed, below, points
        self.tell = tell
        tolerance = posed.scene.tolerance
        self.gap = COARSE if tolerance is None else max(SAME, AGREES * tolerance)
        self.nodes = self._none()
        #: at the value zero of a number that moves, by its path, where some were looked for
        self.homes: dict[str, Nodes] = {}
        self.junctions: list[Junction] = []
        self.points = self.walks = self.lost = 0
        #: least and largest value that was come to, by the path of the number
        self.reached: dict[str, tuple[float, float]] = {}
        self.endings: dict[str, int] = {}
        self.cut = False  # whether there was more to follow than points allowed

    def enter(self, solution: Solution, found_by: str, home: str = "") -> Node:
        """Return the node of a verified solution of the scene; or at zero of the number `home`."""
        nodes = self.homes.setdefault(home, self._none()) if home else self.nodes
        return nodes.enter(solution, found_by)

    def run(self, lines: Sequence[Line]) -> None:
        """Follow all that is known along some numbers, one after the other, until nothing new."""
        while self.points < self.most:
            way = next(self._ways(lines), None)
            if way is None:
                return
            way()
        if next(self._ways(lines), None) is not None:
            self.cut = True

    def _ways(self, lines: Sequence[Line]) -> Iterator[Callable[[], None]]:
        """Yield what there is still to follow, the first number first."""
        for line in lines:
            for junction in self.junctions:
                if junction.line is line and junction.ways:
                    yield partial(self._leave, junction)
            homes = self.homes.get(line.name)
            for node in (*self.nodes.all, *(homes.all if homes else ())):
                for sign in (1, -1):
                    if (line.name, sign) not in node.followed and not self._above(node.solution):
                        yield partial(self._begin, line, node, sign)

    def _begin(self, line: Line, node: Node, sign: int) -> None:
        """Follow a half of the branch through an equilibrium."""
        node.followed.add((line.name, sign))
        own = node in self.nodes.all
        try:
            first = line.begun(node.solution, sign, line.own if own else 0.0)
        except np.linalg.LinAlgError:
            self._ended("not begun, where the equations are singular")
            return
        self._follow(line, first, f"{line.name} from {node.found_by}{'' if own else ' at 0'}")

    def _leave(self, junction: Junction) -> None:
        """Follow one way of the branch that crosses at a junction."""
        sign = junction.ways.pop(0)
        equations = junction.line.equations(junction.point.solution)
        try:
            first = switched(equations, junction.point, sign, least=AWAY)
        except np.linalg.LinAlgError:
            self._ended("crossed by others that could not be begun")
            return
        line, where = junction.line, junction.line.curve.value(junction.point.position)
        found_by = f"{line.name}, crossing at {where:.6g}"
        beside = partial(crossing_beside, equations, junction.point, first)
        if self._comes_back(line, beside, found_by):
            self._ended(MET_ANOTHER)
            return
        self._follow(line, first, found_by)

    def _follow(self, line: Line, first: Point[Solution], found_by: str) -> None:
        """Follow a branch from a point until it ends, or comes to where another has been."""
        self.walks += 1
        walk = line.walk(line.equations(first.solution))
        before, count = first, 0
        for point in self._points(walk, first):
            if point.kind != POINT:
                continue
            self.points, count = self.points + 1, count + 1
            value = line.curve.value(point.position)
            low, high = self.reached.get(line.name, (value, value))
            self.reached[line.name] = min(low, value), max(high, value)
            self.tell(
                f"{len(self.nodes.all)} equilibria; {self.points} points; {line.name} = {value:.5g}"
            )
            equations = line.equations(before.solution)
            if self._passed(line, equations, before, point, found_by):
                self._ended(MET_ANOTHER)
                return
            if self._above(point.solution):
                self._ended(f"rose above the energy {self.below:.6g}")
                return
            if count >= line.curve.most or self.points >= self.most:
                self._ended("stopped after as many points as allowed")
                return
            before = point
        self._ended("left the range" if walk.ending.reached else "stuck where no step succeeded")

    def _points(self, walk: Walk[Solution], first: Point[Solution]) -> Iterator[Point[Solution]]:
        """Yield the points of a walk, which ends where its equations are singular."""
        try:
            yield from walk.points(first)
        except np.linalg.LinAlgError as error:
            walk.ending = Ending(False, str(error))

    def _passed(
        self,
        line: Line,
        equations: RibbonEquations,
        a: Point[Solution],
        b: Point[Solution],
        found_by: str,
    ) -> bool:
        """Note what lies between two points; whether another branch has been there."""
        if a.sign * b.sign < 0:
            tried = self.endings.get(NOT_LOCATED, 0) < DOUBTS
            crossing = branch_point(equations, a, b) if tried else None
            if crossing is None:
                self._ended(NOT_LOCATED)
            elif self._meets(line, equations, crossing):
                return True
        return self._comes_back(line, partial(crossings, equations, a, b), found_by)

    def _comes_back(
        self,
        line: Line,
        crossings_at: Callable[[float], Iterator[Crossing | None]],
        found_by: str,
    ) -> bool:
        """Note where a branch comes back to the own value, or to zero; whether that is explored."""
        levels = {line.own: ""} | ({0.0: line.name} if line.name in self.homes else {})
        for level, home in levels.items():
            for found in crossings_at(level):
                node = None if found is None else self._node_at(found[0], home, found_by)
                if found is None or node is None:
                    self.lost += not home
                    continue
                way = found[1]
                node.followed.add((line.name, -way))
                if (line.name, way) in node.followed:
                    return True
                node.followed.add((line.name, way))
        return False

    def _node_at(self, loose: Solution, home: str, found_by: str) -> Node | None:
        """Return the node that a solution without a tolerance becomes, None if it becomes none."""
        if home:
            return self.enter(loose, found_by, home)
        known = self.nodes.known(loose)
        if known is not None:
            return known
        try:
            found = self.prepared.solve(self.posed, guess=loose, fallback=False)
        except ConvergenceError:
            return None
        return None if not found.verified or far_off(found, loose) else self.enter(found, found_by)

    def _meets(self, line: Line, equations: RibbonEquations, point: Point[Solution]) -> bool:
        """Whether branches cross at a point that is known; else it is from now on."""
        place = equations.reduced(point.solution, point.unknowns)
        for known in self.junctions:
            if known.line is line and equations.metric.length(place - known.place) < MET:
                return True
        self.junctions.append(Junction(line, point, place))
        return False

    def _none(self) -> Nodes:
        return Nodes(self.gap, self.posed.scene.boundary.loop is not None)

    def _above(self, solution: Solution) -> bool:
        return solution.energy > self.below

    def _ended(self, how: str) -> None:
        self.endings[how] = self.endings.get(how, 0) + 1
