"""Equilibria of the smooth law followed by Newton's method: loads brought on, delta brought down.

The inverted formulation on a coarse mesh. A step that fails is tried again shorter; steps that
succeed grow. No IPOPT: each step costs one or two milliseconds.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.discretize import discretize
from ribbonopt.guess import Guess, initial_unknowns
from ribbonopt.problem import BoundaryValueProblem, Ribbon, pose, theta_values
from ribbonopt.scene import Collocation, Law, Scene, Variational
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.trajectory import Trajectory
from ribbonopt.solution.verification import unverified
from ribbonopt.solvers import Status
from ribbonopt.solvers.newton import NewtonSolver
from ribbonopt.transcription import NLP, Mesh

MESH = Collocation(scheme="gauss", degree=3, intervals=30)
TOLERANCE, MAX_ITERATIONS = 1e-8, 30
NEAR = 0.05  # residual of the conditions, over 1 + size of the loads, that Newton may close at once
LEAST_STEP = 1 / 64
MOST_STEPS = 40
FACTOR, LEAST_FACTOR = 0.33, 0.95  # delta from one step to the next, first and where to give up


@dataclass(frozen=True, eq=False)
class HomotopyPath:
    """A path of equilibria: its last point and, for each that was kept, its law."""

    points: tuple[Solution, ...]
    steps: int
    iterations: int
    complete: bool


@dataclass(frozen=True, eq=False)
class SmoothHomotopy:
    """The equations of a scene's structure under a smooth law, built once."""

    ribbon: Ribbon
    problem: BoundaryValueProblem
    nlp: NLP
    newton: NewtonSolver

    @classmethod
    def of(cls, scene: Scene, law: Law) -> SmoothHomotopy:
        """Build for the conditions of a scene under a smooth law."""
        scene = _posed(scene, law)
        ribbon, problem = pose(scene)
        nlp = discretize(scene, problem)
        return cls(ribbon, problem, nlp, NewtonSolver(nlp, TOLERANCE, MAX_ITERATIONS))

    def follow(self, scene: Scene, law: Law, guess: Guess, delta: float) -> HomotopyPath:
        """Follow from a guess at one law to all of the conditions, then down to a delta."""
        run = _Tracking(self, scene, law, guess)
        complete = run.bring_loads() and run.bring_down(delta)
        return HomotopyPath(tuple(run.points), run.steps, run.iterations, complete)


class _Tracking:
    """One path: where it is, and what it has cost."""

    def __init__(self, equations: SmoothHomotopy, scene: Scene, law: Law, guess: Guess) -> None:
        self.equations, self.scene, self.law = equations, scene, law
        self.steps = self.iterations = 0
        self.points: list[Solution] = []
        f = equations
        self.w = initial_unknowns(guess, f.ribbon, f.problem, f.nlp.blocks, self._p(law))

    def bring_loads(self) -> bool:
        """Meet the conditions: at once where they nearly hold, else bit by bit."""
        p = self._p(self.law)
        residuals = self.equations.newton.system.residuals(self.w, p).conditions
        _, _, constants = self.equations.nlp.layout.unpack(self.w)
        off = float(np.abs(residuals).max()) / (1 + float(np.abs(constants).max()))
        if off < NEAR and self._step(self.law, None):
            return self._keep()
        share, step = 0.0, 0.25
        if not self._step(self.law, residuals):
            return False
        while share < 1:
            following = min(1.0, share + step)
            if self._step(self.law, (1 - following) * residuals):
                share, step = following, min(2 * step, 0.5)
                continue
            step /= 4
            if step < LEAST_STEP or self.steps > MOST_STEPS:
                return False
        return self._keep()

    def bring_down(self, target: float) -> bool:
        """Follow the variational law to a smaller delta; other laws stay as they are."""
        factor = FACTOR
        while isinstance(self.law, Variational) and self.law.delta > target * (1 + 1e-9):
            law = Variational(delta=max(target, self.law.delta * factor))
            if self._step(law, None):
                self.law, factor = law, max(0.1, factor**2)
                self._keep()
                continue
            factor = float(np.sqrt(factor))
            if factor > LEAST_FACTOR or self.steps > MOST_STEPS:
                return False
        return True

    def _step(self, law: Law, relaxed: Array | None) -> bool:
        report = self.equations.newton.solve(self.w, self._p(law), relaxed)
        self.steps += 1
        self.iterations += report.iterations
        if report.status is not Status.CONVERGED:
            return False
        self.w = report.w
        return True

    def _keep(self) -> bool:
        p = self._p(self.law)
        self.points.append(
            Solution(
                scene=_posed(self.scene, self.law),
                trajectory=Trajectory(self.equations.problem, self.equations.nlp.output(self.w, p)),
                status=Status.CONVERGED,
                message=Status.CONVERGED.value,
                iterations=self.iterations,
                verification=unverified(),
            )
        )
        return True

    def _p(self, law: Law) -> Array:
        theta = theta_values(_posed(self.scene, law))
        widths = Mesh.uniform(MESH.intervals).widths
        return self.equations.nlp.layout.parameters(theta, widths)


def _posed(scene: Scene, law: Law) -> Scene:
    return replace(scene, formulation="inverted", states="reduced", law=law, transcription=MESH)
