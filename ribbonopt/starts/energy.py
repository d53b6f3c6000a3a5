"""Least energy of a smooth law: the first solve, which needs to know nothing of loads.

IPOPT on a coarse mesh, from a shape that need not even be a ribbon; force and moment follow from
the costates. What is prescribed of loads is left out here, unless a dead force has a potential.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from ribbonopt.attempt.discretize import discretize
from ribbonopt.guess import Guess, initial_unknowns
from ribbonopt.problem import BoundaryValueProblem, Ribbon, ribbon_of, theta_values
from ribbonopt.problem.energy import minimum
from ribbonopt.scene import Collocation, Law, Scene
from ribbonopt.solution.from_report import solution_of
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import SolveReport
from ribbonopt.solvers.ipopt import IpoptSolver
from ribbonopt.transcription import NLP, Mesh

MESH = Collocation(scheme="gauss", degree=3, intervals=16)
TOLERANCE, MAX_ITERATIONS = 1e-6, 120


@dataclass(frozen=True, eq=False)
class LeastEnergy:
    """The problem of least energy of a scene's structure, built once."""

    ribbon: Ribbon
    problem: BoundaryValueProblem
    nlp: NLP
    solver: IpoptSolver

    @classmethod
    def of(cls, scene: Scene, law: Law) -> LeastEnergy:
        """Build for the conditions of a scene under a law with a smooth energy."""
        scene = _posed(scene, law)
        ribbon = ribbon_of(scene)
        problem = minimum(ribbon)
        nlp = discretize(scene, problem)
        solver = IpoptSolver(nlp, TOLERANCE, MAX_ITERATIONS)
        return cls(ribbon, problem, nlp, solver)

    def solve(self, scene: Scene, law: Law, guess: Guess) -> tuple[SolveReport, Solution]:
        """Solve for the numbers of a scene; the solution is worth nothing unless converged."""
        widths = Mesh.uniform(MESH.intervals).widths
        p = self.nlp.layout.parameters(theta_values(_posed(scene, law)), widths)
        w = initial_unknowns(guess, self.ribbon, self.problem, self.nlp.blocks, p)
        report = self.solver.solve(w, p)
        posed = _posed(scene, law)
        return report, solution_of(posed, self.problem, self.nlp, report, p)


def _posed(scene: Scene, law: Law) -> Scene:
    return replace(scene, formulation="energy", states="reduced", law=law, transcription=MESH)
