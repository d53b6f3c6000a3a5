"""What parts of the path may ask of the whole: to solve another scene, of another structure."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeAlias

from ribbonopt.guess import Guess
from ribbonopt.problem import BoundaryValueProblem, Posed
from ribbonopt.scene import Scene
from ribbonopt.solution.solution import Solution

from .search import Search


class Means(Protocol):
    """What solves scenes of one structure: `ribbonopt.pipeline.prepared.Prepared`."""

    @property
    def problem(self) -> BoundaryValueProblem:
        """Equations, in one phase."""

    @property
    def seconds(self) -> float:
        """What it took to build."""

    def posed(self, scene: Scene | Posed | None = None) -> Posed:
        """Return a scene (default: the prepared one) posed."""

    def search(self, scene: Scene | Posed | None = None) -> Search:
        """Return a search for solutions of a scene."""

    def solve(
        self,
        scene: Scene | Posed | None = None,
        guess: Guess | None = None,
        *,
        fallback: bool = True,
        quick: bool = False,
    ) -> Solution:
        """Solve a scene, by `fallback` from the automatic start where a guess leads nowhere.

        `quick` leaves it at Newton's method from the guess, where that can be.
        """

    def solve_once(self) -> Solution:
        """Solve the prepared scene on its own number of intervals."""

    def refined(
        self, solution: Solution, spare: float = 1.0, search: Search | None = None
    ) -> Solution:
        """Return a solution on a mesh that meets its tolerance."""


#: builds the means to solve a scene
Prepare: TypeAlias = Callable[[Scene | Posed], Means]
