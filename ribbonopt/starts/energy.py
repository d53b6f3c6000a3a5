"""Least energy of a smooth law: the first solve, which needs to know nothing of loads.

IPOPT on a coarse mesh, from a shape that need not even be a ribbon; force and moment follow from
the costates. What is prescribed of loads is left out here, unless a dead force has a potential.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ribbonopt.accuracy.verify import unverified
from ribbonopt.arrays import Array
from ribbonopt.discretize import discretize
from ribbonopt.guess import Guess, initial_unknowns
from ribbonopt.problem import BoundaryValueProblem, Ribbon, ribbon_of, theta_of
from ribbonopt.problem.energy import minimum
from ribbonopt.scene import Collocation, Law, Scene
from ribbonopt.solution import Solution
from ribbonopt.solvers import SolveReport
from ribbonopt.solvers.ipopt import Ipopt
from ribbonopt.transcription import NLP, Mesh

from .costates import with_recovered

MESH = Collocation(scheme="gauss", degree=3, intervals=16)
TOLERANCE, MAX_ITERATIONS = 1e-6, 120


@dataclass(frozen=True, eq=False)
class LeastEnergy:
    """The problem of least energy of a scene's structure, built once."""

    ribbon: Ribbon
    problem: BoundaryValueProblem
    nlp: NLP
    solver: Ipopt

    @classmethod
    def of(cls, scene: Scene, law: Law) -> LeastEnergy:
        """Build for the conditions of a scene under a law with a smooth energy."""
        scene = _posed(scene, law)
        ribbon = ribbon_of(scene)
        problem = minimum(ribbon)
        nlp = discretize(scene, problem)
        solver = Ipopt(nlp, TOLERANCE, MAX_ITERATIONS)
        return cls(ribbon, problem, nlp, solver)

    def theta(self, scene: Scene, law: Law) -> Array:
        """Parameters (nt,) of a scene of this structure."""
        return np.array(list(theta_of(_posed(scene, law)).values()))

    def solve(self, scene: Scene, law: Law, guess: Guess) -> tuple[SolveReport, Solution]:
        """Solve for the numbers of a scene; the solution is worth nothing unless converged."""
        p = np.concatenate([self.theta(scene, law), Mesh.uniform(MESH.intervals).widths])
        w = initial_unknowns(guess, self.ribbon, self.problem, self.nlp.blocks, p)
        report = self.solver.solve(w, p)
        p = with_recovered(self.problem, self.nlp, report, p)
        solution = Solution(
            scene=_posed(scene, law),
            problem=self.problem,
            dense=self.nlp.blocks.dense(report.w, p),
            status=report.status,
            message=report.status.value,
            iterations=report.iterations,
            verification=unverified(),
            multipliers=report.multipliers,
        )
        return report, solution


def _posed(scene: Scene, law: Law) -> Scene:
    return replace(scene, formulation="energy", states="reduced", law=law, transcription=MESH)
