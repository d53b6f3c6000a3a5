"""Equilibria of the smooth law followed by Newton's method: loads brought on, delta brought down.

The inverted formulation on a coarse mesh. A step that fails is tried again shorter; steps that
succeed grow. No IPOPT: each step costs one or two milliseconds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.attempt.structure import Structure
from ribbonopt.guess import Guess
from ribbonopt.mechanics.laws.smooth import in_family, sharpened, sharpness
from ribbonopt.problem import Posed
from ribbonopt.scene import Collocation, Law, Newton
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import NewtonSolver, Status

MESH = Collocation(scheme="gauss", degree=3, intervals=30)
SOLVER = Newton(tolerance=1e-8, max_iterations=30)
NEAR = 0.05  # residual of the conditions, over 1 + size of the loads, that Newton may close at once
LEAST_STEP = 1 / 64
MOST_STEPS = 40
FACTOR, LEAST_FACTOR = 0.33, 0.95  # delta from one step to the next, first and where to give up


@dataclass(frozen=True, eq=False)
class HomotopyPath:
    """A path of equilibria, each with its law; whether it led to its end."""

    points: tuple[Solution, ...]
    steps: int
    iterations: int
    complete: bool


def smooth_of(posed: Posed, law: Law) -> Posed:
    """Return a scene under a smooth law, as these solves want it."""
    states = "planar" if posed.scene.states == "planar" else "reduced"
    settings = {"formulation": "inverted", "states": states, "solver": SOLVER}
    return posed.under(law=law, transcription=MESH, **settings)


def follow(
    structure: Structure, posed: Posed, law: Law, guess: Guess, delta: float
) -> HomotopyPath:
    """Follow from a guess at one law to all of the conditions, then down to a delta.

    `structure` is that of `smooth_of` for this kind of law, `posed` the scene itself.
    """
    run = _Tracking(structure, posed, law, guess)
    complete = run.bring_loads() and run.bring_down(delta)
    return HomotopyPath(tuple(run.points), run.steps, run.iterations, complete)


class _Tracking:
    """One path: where it is, and what it has cost."""

    def __init__(self, structure: Structure, posed: Posed, law: Law, guess: Guess) -> None:
        self.structure, self.posed, self.law = structure, posed, law
        self.steps = self.iterations = 0
        self.points: list[Solution] = []
        self.attempt = self._attempt(law)
        assert isinstance(self.attempt.solver, NewtonSolver)  # as SOLVER says
        self.newton = self.attempt.solver
        self.w = self.attempt.unknowns(guess)

    def bring_loads(self) -> bool:
        """Meet the conditions: at once where they nearly hold, else bit by bit."""
        residuals = self.newton.system.residuals(self.w, self.attempt.p).conditions
        _, _, constants = self.attempt.nlp.layout.unpack(self.w)
        off = float(np.abs(residuals).max()) / (1 + float(np.abs(constants).max(initial=0.0)))
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
        """Follow the smooth family to a smaller delta; other laws stay as they are."""
        factor = FACTOR
        while in_family(self.law) and sharpness(self.law, 0.0) > target * (1 + 1e-9):
            law = sharpened(self.law, max(target, sharpness(self.law, 0.0) * factor))
            if self._step(law, None):
                self.law, factor = law, max(0.1, factor**2)
                self._keep()
                continue
            factor = float(np.sqrt(factor))
            if factor > LEAST_FACTOR or self.steps > MOST_STEPS:
                return False
        return True

    def _step(self, law: Law, relaxed: Array | None) -> bool:
        attempt = self.attempt if law is self.law else self._attempt(law)
        report = self.newton.solve(self.w, attempt.p, relaxed)
        self.steps += 1
        self.iterations += report.iterations
        if report.status is not Status.CONVERGED:
            return False
        self.w, self.attempt = report.w, attempt
        return True

    def _keep(self) -> bool:
        self.points.append(self.attempt.restored(self.w))
        return True

    def _attempt(self, law: Law) -> Attempt:
        return self.structure.attempt(smooth_of(self.posed, law))
