"""What a search for all equilibria knows: equilibria, and points where branches cross."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution
from ribbonopt.starts.equilibria import Described, same
from ribbonopt.studies.continuation.coordinates import reduced
from ribbonopt.studies.continuation.walk.points import Point

from .line import Line

FAR_OFF = 1e-2  # relative distance of what was only to be made more exact: it has become another


@dataclass(eq=False)
class Node:
    """An equilibrium, and which halves of branches that leave it are followed.

    Attributes
    ----------
    solution : Solution
        Verified, to the scene's tolerance where it is one of the scene itself.
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


@dataclass(eq=False)
class Nodes:
    """Equilibria of one scene, in the order in which they were found.

    Attributes
    ----------
    gap : float
        Relative distance below which two are the same.
    closed : bool
        Whether they are closed bands, of which the same one may begin elsewhere along itself.
    """

    gap: float
    closed: bool
    all: list[Node] = field(default_factory=list)

    def enter(self, solution: Solution, found_by: str) -> Node:
        """Return the node of a solution, a new one where it is none that is known."""
        known = self.known(solution)
        if known is None:
            known = Node(solution, found_by, place_of(solution))
            self.all.append(known)
        return known

    def known(self, solution: Solution) -> Node | None:
        """Return the node that a solution is, None for none."""
        place, new = place_of(solution), Described(solution)
        for node in self.all:
            if self.closed or len(place) != len(node.place):
                if same(Described(node.solution), new, images=False, gap=self.gap):
                    return node
            elif _apart(node.place, place) < self.gap:
                return node
        return None


def place_of(solution: Solution) -> Array:
    """Coordinates (m,) of an equilibrium of the scene: states at both ends, constants."""
    return reduced(solution, np.append(solution.dense.w, 0.0))[:-1]


def far_off(found: Solution, loose: Solution) -> bool:
    """Whether an answer is far from what it was to make more exact."""
    a, b = place_of(found), place_of(loose)
    return len(a) == len(b) and _apart(a, b) > FAR_OFF


def _apart(a: Array, b: Array) -> float:
    """Return how far apart two places are, each coordinate relative to its size, or to 1."""
    return float(np.linalg.norm((a - b) / (1 + np.abs(a))))
