"""Solves on the meshes of a refinement; of a minimum two, whose difference is its error.

Elements of the one are halves of those of the other, so that none of them is as wide.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any, TypeAlias

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

if TYPE_CHECKING:
    from ribbonopt.attempt.attempt import Attempt

#: means to solve on a mesh, phases meeting at given fractions of the length
AttemptOn: TypeAlias = Callable[[Mesh, Array], "Attempt"]


@dataclass(eq=False)
class Halving:
    """Solves on one mesh after another, each from the solution before; `steps` are what it took."""

    attempt_on: AttemptOn
    steps: list[Mapping[str, Any]] = field(default_factory=list)

    def compared(self, solution: Solution) -> Solution | None:
        """Return a solution that has something to be compared with; None if none is found."""
        if not solution.problem.recovered or solution.coarser is not None:
            return solution
        found = self._on(solution.mesh.halved(), solution, "to compare with")
        return found and replace(found, coarser=solution.trajectory)

    def on(self, mesh: Mesh, solution: Solution, error: float) -> Solution | None:
        """Return a solution on a mesh, from another; None if none is found."""
        if solution.problem.recovered and len(solution.posed.places):
            mesh = mesh.through(solution.posed.places)
        found = self._on(mesh, solution, f"for an error of {error:.0e}")
        return found and self.compared(replace(found, coarser=None))

    def _on(self, mesh: Mesh, solution: Solution, words: str) -> Solution | None:
        started = time.perf_counter()
        attempt = self.attempt_on(mesh, solution.trajectory.ends[1:-1])
        if not attempt.run(solution, quick=True, check=False) or attempt.best is None:
            return None
        step = f"mesh of {sum(mesh.elements)} intervals {words}"
        seconds = time.perf_counter() - started
        self.steps.append({"step": step, "iterations": attempt.iterations, "seconds": seconds})
        return attempt.best
