"""One path of equilibria of a smooth law: where it is, what it has cost, and a step of it.

The inverted formulation on a coarse mesh, solved by Newton's method. No IPOPT: each step costs one
or two milliseconds.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.attempt.structure import Structure
from ribbonopt.guess import Guess
from ribbonopt.problem import Posed
from ribbonopt.scene import Collocation, Law, Newton
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import NewtonSolver, Status
from ribbonopt.transcription import Mesh

from .grading import FLAT, graded_mesh

MESH = Collocation(scheme="gauss", degree=3, intervals=30)
SOLVER = Newton(tolerance=1e-8, max_iterations=30)
SURE = 12  # iterations after which a step has surely not left its branch
MOST_STEPS = 40


def smooth_of(posed: Posed, law: Law) -> Posed:
    """Return a scene under a smooth law, as these solves want it."""
    states = "planar" if posed.scene.states == "planar" else "reduced"
    settings = {"formulation": "inverted", "states": states, "solver": SOLVER}
    return posed.under(law=law, transcription=MESH, **settings)


class Tracking:
    """One path: where it is, and what it has cost."""

    def __init__(self, structure: Structure, posed: Posed, law: Law, guess: Guess) -> None:
        self.structure, self.posed, self.law = structure, posed, law
        self.steps = self.iterations = 0
        self.points: list[Solution] = []
        self.mesh: Mesh | None = None
        # Shares of the loads along the ribbon, of those that have a potential and of others.
        self.loads = 1.0
        self.followers = 0.0 if any(load.without_potential for load in posed.loads) else 1.0
        self.attempt = self.attempt_at(law)
        self.w = self.attempt.unknowns(guess)

    def regrade(self, least: int = MESH.intervals, power: float = FLAT) -> None:
        """Move the nodes to where the ribbon bends now."""
        solution = self.attempt.restored(self.w)
        self.mesh = graded_mesh(solution, least, power)
        self.attempt = self.attempt_at(self.law)
        self.w = self.attempt.unknowns(solution)

    def conditions(self) -> Array:
        """Residuals of the conditions at the ends."""
        found: Array = _newton(self.attempt).system.residuals(self.w, self.attempt.p).conditions
        return found

    def step(self, law: Law, relaxed: Array | None, most: int | None = None) -> bool:
        """Solve under a law, from where it is, with some residuals of the conditions left."""
        attempt = self.attempt if law is self.law else self.attempt_at(law)
        report = _newton(attempt).solve(self.w, attempt.p, relaxed, most=most)
        self.steps += 1
        self.iterations += report.iterations
        if report.status is not Status.CONVERGED:
            return False
        self.w, self.attempt = report.w, attempt
        return True

    def keep(self) -> bool:
        """Add where it is to the points of the path."""
        self.points.append(self.attempt.restored(self.w))
        return True

    def attempt_at(self, law: Law) -> Attempt:
        """Return what solves the scene under a law, with the shares of the loads as they are."""
        attempt = self.structure.attempt(smooth_of(self.posed, law), mesh=self.mesh)
        if self.loads < 1 or self.followers < 1:
            names = attempt.problem.parameter_names
            for load in self.posed.loads:
                share = self.followers if load.without_potential else self.loads
                for name in load.numbers_to_scale():
                    attempt.p[names.index(name)] *= share
            for action in (a for station in self.posed.stations for a in station.actions):
                for name in action.loads:
                    attempt.p[names.index(name)] *= self.loads
        return attempt


def _newton(attempt: Attempt) -> NewtonSolver:
    assert isinstance(attempt.solver, NewtonSolver)  # as SOLVER says
    return attempt.solver


def growth(iterations: int) -> float:
    """Return by what to multiply a step after one that took some iterations."""
    return float(np.clip(2.5 - 0.1 * iterations, 0.7, 2.0))
