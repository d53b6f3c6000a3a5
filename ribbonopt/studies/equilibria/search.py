"""All equilibria of one scene: every branch is followed, through its folds, from what is known.

A branch on which a number of the scene moves passes the scene's own value again and again, and each
time that is an equilibrium. From each two halves of a branch leave, to either side; each is
followed once, and so are those of the branches that cross, until nothing new comes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.errors import ConvergenceError
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.problem import Posed
from ribbonopt.solution.solution import Solution
from ribbonopt.starts.equilibria import Described, same
from ribbonopt.studies.continuation.coordinates import reduced
from ribbonopt.studies.continuation.ribbons import RibbonEquations
from ribbonopt.studies.continuation.walk.points import POINT, Point
from ribbonopt.studies.continuation.walk.switching import switched

from .between import branch_point, crossings
from .line import Line

SAME = 1e-5  # arclength between two answers of one equilibrium, at least
AGREES = 1e3  # times the tolerance: the same
COARSE = 1e-4  # the same, where there is no tolerance
MET = 1e-4  # arclength between two estimates of one point where branches cross

Tell = Callable[[str], None]


def quiet(_: str) -> None:
    """Tell nothing."""


@dataclass(eq=False)
class Node:
    """An equilibrium of the scene, and which halves of branches that leave it are followed.

    Attributes
    ----------
    solution : Solution
        Verified, to the scene's tolerance.
    found_by : str
        What led to it first.
    place : (m,) array
        Its coordinates.
    followed : set of (str, int)
        Halves of branches, by the number that moves and the side to which it does.
    """

    solution: Solution
    found_by: str
    place: Array
    followed: set[tuple[str, int]] = field(default_factory=set)


@dataclass(eq=False)
class Junction:
    """Where branches cross, and the ways that have still to be followed."""

    line: Line
    point: Point[Solution]
    place: Array
    ways: list[int] = field(default_factory=lambda: [1, -1])


class Search:
    """The search, as far as it has come."""

    def __init__(
        self, prepared: Prepared, posed: Posed, below: float, points: int, tell: Tell
    ) -> None:
        """Begin with nothing; `below` is the strain energy, in units of the scene."""
        self.prepared, self.posed, self.below, self.most = prepared, posed, below, points
        self.tell = tell
        self.nodes: list[Node] = []
        self.junctions: list[Junction] = []
        self.points = self.walks = self.lost = 0
        self.endings: dict[str, int] = {}
        tolerance = posed.scene.tolerance
        self.gap = COARSE if tolerance is None else max(SAME, AGREES * tolerance)

    def enter(self, solution: Solution, found_by: str) -> Node:
        """Return the node of a verified solution, a new one where it is none that is known."""
        known = self.known(solution)
        if known is None:
            known = Node(solution, found_by, place_of(solution))
            self.nodes.append(known)
        return known

    def known(self, solution: Solution) -> Node | None:
        """Return the node that a solution is, None for none."""
        place, loop = place_of(solution), self.posed.scene.boundary.loop is not None
        new = Described(solution)
        for node in self.nodes:
            if loop or len(place) != len(node.place):
                if same(Described(node.solution), new, images=False, gap=self.gap):
                    return node
            elif _apart(node.place, place) < self.gap:
                return node
        return None

    def run(self, lines: Sequence[Line]) -> None:
        """Follow all that is known along some numbers, one after the other, until nothing new."""
        while self.points < self.most:
            way = next(self._ways(lines), None)
            if way is None:
                return
            way()
        self._ended("were left when there were as many points as allowed")

    def _ways(self, lines: Sequence[Line]) -> Iterator[Callable[[], None]]:
        """Yield what there is still to follow, the first number first."""
        for line in lines:
            for junction in self.junctions:
                if junction.line is line and junction.ways:
                    yield lambda j=junction: self._leave(j)
            for node in self.nodes:
                for sign in (1, -1):
                    if (line.name, sign) not in node.followed and not self._above(node.solution):
                        yield lambda n=node, s=sign: self._begin(line, n, s)

    def _begin(self, line: Line, node: Node, sign: int) -> None:
        """Follow a half of the branch through an equilibrium."""
        node.followed.add((line.name, sign))
        try:
            first = line.begun(node.solution, sign)
        except np.linalg.LinAlgError:
            self._ended("could not be begun: the equations are singular at the scene itself")
            return
        number = 1 + self.nodes.index(node)
        self._follow(line, first, f"{line.name} from equilibrium {number}")

    def _leave(self, junction: Junction) -> None:
        """Follow one way of the branch that crosses at a junction."""
        sign = junction.ways.pop(0)
        equations = junction.line.equations(junction.point.solution)
        try:
            first = switched(equations, junction.point, sign)
        except np.linalg.LinAlgError:
            self._ended("that cross could not be begun")
            return
        where = junction.line.curve.value(junction.point.position)
        self._follow(junction.line, first, f"{junction.line.name}, crossing at {where:.6g}")

    def _follow(self, line: Line, first: Point[Solution], found_by: str) -> None:
        """Follow a branch from a point until it ends, or comes to where another has been."""
        self.walks += 1
        walk = line.walk(line.equations(first.solution))
        before, count = first, 0
        for point in walk.points(first):
            if point.kind != POINT:
                continue
            self.points, count = self.points + 1, count + 1
            value = line.curve.value(point.position)
            self.tell(
                f"{len(self.nodes)} equilibria; {self.points} points; {line.name} = {value:.5g}"
            )
            equations = line.equations(before.solution)
            if self._passed(line, equations, before, point, found_by):
                self._ended("came to where another had been")
                return
            if self._above(point.solution):
                self._ended(f"rose above the energy {self.below:.6g}")
                return
            if count >= line.curve.most or self.points >= self.most:
                self._ended("were left after as many points as allowed")
                return
            before = point
        self._ended(
            "left the range" if walk.ending.reached else "were lost where no step succeeded"
        )

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
            crossing = branch_point(equations, a, b)
            if crossing is None:
                self._ended("that cross were not located")
            elif self._meets(line, equations, crossing):
                return True
        for found in crossings(equations, a, b, line.own):
            if found is None:
                self.lost += 1
                continue
            node = self._node_at(*found, found_by)
            if node is None:
                continue
            way = found[1]
            node.followed.add((line.name, -way))
            if (line.name, way) in node.followed:
                return True
            node.followed.add((line.name, way))
        return False

    def _node_at(self, loose: Solution, way: int, found_by: str) -> Node | None:
        """Return the node that a solution without a tolerance becomes, None if it becomes none."""
        known = self.known(loose)
        if known is not None:
            return known
        try:
            found = self.prepared.solve(self.posed, guess=loose, fallback=False)
        except ConvergenceError:
            found = None
        if found is None or not found.verified or self._off(found, loose):
            self.lost += 1
            return None
        return self.enter(found, found_by)

    def _off(self, found: Solution, loose: Solution) -> bool:
        """Whether an answer is far from what it was to make more exact."""
        a, b = place_of(found), place_of(loose)
        return len(a) == len(b) and _apart(a, b) > 1e-2

    def _meets(self, line: Line, equations: RibbonEquations, point: Point[Solution]) -> bool:
        """Whether branches cross at a point that is known; else it is from now on."""
        place = equations.reduced(point.solution, point.unknowns)
        for known in self.junctions:
            if known.line is line and equations.metric.length(place - known.place) < MET:
                return True
        self.junctions.append(Junction(line, point, place))
        return False

    def _above(self, solution: Solution) -> bool:
        return solution.energy > self.below

    def _ended(self, how: str) -> None:
        self.endings[how] = self.endings.get(how, 0) + 1


def place_of(solution: Solution) -> Array:
    """Coordinates (m,) of an equilibrium of the scene: states at both ends, constants."""
    return reduced(solution, np.append(solution.dense.w, 0.0))[:-1]


def _apart(a: Array, b: Array) -> float:
    """Return how far apart two places are, each coordinate relative to its size, or to 1."""
    return float(np.linalg.norm((a - b) / (1 + np.abs(a))))
