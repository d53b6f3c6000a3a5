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
from ribbonopt.scene import Collocation, Law, Newton, Variational
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import NewtonSolver, Status
from ribbonopt.transcription import Mesh

from .grading import FLAT, graded_mesh, is_coarse

MESH = Collocation(scheme="gauss", degree=3, intervals=30)
SOLVER = Newton(tolerance=1e-8, max_iterations=30)
NEAR = 0.05  # residual of the conditions, over 1 + size of the loads, that Newton may close at once
HEAVY = 30.0  # size of loads, Dw = L = 1, beyond which they are brought on by factors
FIRST_LOADS = 2.0  # size of loads that are brought on evenly before they grow by factors
MOST_GROWTH, LEAST_GROWTH = 1.2, 0.02  # of the logarithm of a load in a step
SURE = 12  # iterations after which a step has surely not left its branch
LEAST_STEP = 1 / 64
MOST_STEPS = 40
FACTOR, LEAST_FACTOR = 0.33, 0.95  # delta from one step to the next, first and where to give up
# Of rods: logarithm of the ratio of stiffnesses, steps at first, where to give up, and at most.
FIRST_STEP, SMALLEST_STEP, LARGEST_STEP = 0.4, 0.04, 1.2
FEW, MANY = 40, 80  # intervals for layers of twist or bending, and where few are too coarse
GATHERED = 0.5  # power of the strains with which they gather there
NARROWER = 0.3  # how much an interval may shrink in a step


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
    bring = run.bring_down if isinstance(law, Variational) else run.make_uneven
    complete = run.bring_loads() and bring(delta)
    return HomotopyPath(tuple(run.points), run.steps, run.iterations, complete)


class _Tracking:
    """One path: where it is, and what it has cost."""

    def __init__(self, structure: Structure, posed: Posed, law: Law, guess: Guess) -> None:
        self.structure, self.posed, self.law = structure, posed, law
        self.steps = self.iterations = 0
        self.points: list[Solution] = []
        self.mesh: Mesh | None = None
        self.loads = 1.0  # share of the loads along the ribbon
        self.attempt = self._attempt(law)
        self.w = self.attempt.unknowns(guess)

    def bring_loads(self) -> bool:
        """Meet the conditions: at once where they nearly hold, else bit by bit."""
        residuals = self._conditions()
        _, _, constants = self.attempt.nlp.layout.unpack(self.w)
        off = float(np.abs(residuals).max()) / (1 + float(np.abs(constants).max(initial=0.0)))
        if off < NEAR and self._step(self.law, None):
            return self._keep()
        size = max(float(np.abs(residuals).max()), self._along())
        if size > HEAVY:
            return self._bring_heavy(size)
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

    def _bring_heavy(self, size: float) -> bool:
        """Bring on loads far larger than one: their size grows by factors, and meshes follow."""
        self.loads = 0.0
        self.attempt = self._attempt(self.law)
        residuals = self._conditions()
        # Evenly at first, then by factors: first buckling is at a few units of load.
        last = float(np.arcsinh(size / FIRST_LOADS))
        at, step = 0.0, 0.5
        while at < last:
            following = min(last, at + step)
            self.loads = FIRST_LOADS * float(np.sinh(following)) / size if following < last else 1.0
            before, w = self.iterations, self.w
            self.attempt = self._attempt(self.law)
            done = self._step(self.law, (1 - self.loads) * residuals)
            if done and self.iterations - before <= SURE:
                at, step = following, min(step * _growth(self.iterations - before), MOST_GROWTH)
                self._regrade()
                continue
            # After many iterations it may be another equilibrium: not what grew from before.
            self.w, step = w, step / 3
            if step < LEAST_GROWTH or self.steps > 2 * MOST_STEPS:
                return False
        return self._step(self.law, None) and self._keep()

    def _along(self) -> float:
        """Return the size of dead loads along the ribbon, as a force."""
        numbers = [load.numbers().values() for load in self.posed.loads if load.dead]
        along = self.posed.length * max((abs(v) for some in numbers for v in some), default=0.0)
        points = (a.loads.values() for st in self.posed.stations for a in st.actions)
        return max((abs(v) for some in points for v in some), default=along)

    def _regrade(self, least: int = MESH.intervals, power: float = FLAT) -> None:
        """Move the nodes to where the ribbon bends now."""
        solution = self.attempt.restored(self.w)
        self.mesh = graded_mesh(solution, least, power)
        self.attempt = self._attempt(self.law)
        self.w = self.attempt.unknowns(solution)

    def bring_down(self, target: float) -> bool:
        """Follow the smooth family to a smaller delta; other laws stay as they are."""
        factor = FACTOR
        while isinstance(self.law, Variational) and self.law.delta > target * (1 + 1e-9):
            law = sharpened(self.law, max(target, self.law.delta * factor))
            if self._step(law, None):
                self.law, factor = law, max(0.1, factor**2)
                self._keep()
                if is_coarse(self.points[-1]):
                    self._regrade()
                continue
            factor = float(np.sqrt(factor))
            if factor > LEAST_FACTOR or self.steps > MOST_STEPS:
                return False
        return True

    def make_uneven(self, target: float) -> bool:
        """Follow rods to a smaller ratio of stiffnesses; other laws stay as they are.

        Each step begins on the secant through the two equilibria before. Nodes follow the layers of
        twist or bending, and so does the secant: it goes from node to node, wherever they are.
        """
        if not in_family(self.law) or sharpness(self.law, 0.0) <= target * (1 + 1e-9):
            return True
        self._regrade(FEW, GATHERED)
        if not self._step(self.law, None):
            return False
        self.points[-1] = self.attempt.restored(self.w)
        count, step, before = FEW, FIRST_STEP, None
        at, last = float(np.log(sharpness(self.law, 0.0))), float(np.log(target))
        while at > last + 1e-9:
            step = min(step, at - last)
            law = sharpened(self.law, float(np.exp(at - step)))
            assert self.mesh is not None
            here, iterations = (at, self.mesh, self.w), self.iterations
            if before is not None and len(before[2]) == len(self.w):
                ahead = step / (before[0] - at)
                self.mesh = _beyond(before[1], self.mesh, ahead)
                self.w = self.w + (self.w - before[2]) * ahead
            # After many iterations it may be another equilibrium: the secant would be wrong.
            if self._step(law, None, most=SURE):
                before, self.law, at = here, law, at - step
                step = min(LARGEST_STEP, step * _growth(2 * (self.iterations - iterations)))
                self._keep()
                if is_coarse(self.points[-1]):
                    count = MANY
                self._regrade(count, GATHERED)
                continue
            _, self.mesh, self.w = here
            step /= 2
            if step < SMALLEST_STEP:
                return False
        return True

    def _conditions(self) -> Array:
        """Residuals of the conditions at the ends."""
        found: Array = _newton(self.attempt).system.residuals(self.w, self.attempt.p).conditions
        return found

    def _step(self, law: Law, relaxed: Array | None, most: int | None = None) -> bool:
        attempt = self.attempt if law is self.law else self._attempt(law)
        report = _newton(attempt).solve(self.w, attempt.p, relaxed, most=most)
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
        attempt = self.structure.attempt(smooth_of(self.posed, law), mesh=self.mesh)
        if self.loads < 1:
            names = {name for load in self.posed.loads if load.dead for name in load.numbers()}
            names |= {n for st in self.posed.stations for a in st.actions for n in a.loads}
            for i, name in enumerate(attempt.problem.parameter_names):
                attempt.p[i] *= self.loads if name in names else 1.0
        return attempt


def _newton(attempt: Attempt) -> NewtonSolver:
    assert isinstance(attempt.solver, NewtonSolver)  # as SOLVER says
    return attempt.solver


def _growth(iterations: int) -> float:
    """Return by what to multiply a step after one that took some iterations."""
    return float(np.clip(2.5 - 0.1 * iterations, 0.7, 2.0))


def _beyond(before: Mesh, here: Mesh, ahead: float) -> Mesh:
    """Return the mesh that follows from two, `ahead` times as far on."""
    (a,), (b,) = before.phases, here.phases
    widths = np.maximum(b + (b - a) * ahead, NARROWER * b)
    return Mesh((widths / widths.sum(),))
