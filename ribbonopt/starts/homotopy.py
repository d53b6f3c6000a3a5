"""Equilibria of the smooth law followed by Newton's method: loads brought on, delta brought down.

A step that fails is tried again shorter; steps that succeed grow.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.attempt.structure import Structure
from ribbonopt.classes import dataclass
from ribbonopt.guess import Guess
from ribbonopt.mechanics.laws.smooth import in_family, sharpened, sharpness
from ribbonopt.problem import Posed
from ribbonopt.scene import Law, Variational
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

from .grading import is_coarse
from .loading import bring_followers, bring_loads
from .tracking import MOST_STEPS, SURE, Tracking, growth

FACTOR, LEAST_FACTOR = 0.33, 0.95  # delta from one step to the next, first and where to give up
NEARLY = 1.25  # times the last delta: a step that would end short of it by no more goes all the way
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


def follow(
    structure: Structure, posed: Posed, law: Law, guess: Guess, delta: float
) -> HomotopyPath:
    """Follow from a guess at one law to all of the conditions, then down to a delta.

    `structure` is that of `smooth_of` for this kind of law, `posed` the scene itself.
    """
    run = Tracking(structure, posed, law, guess)
    bring = _bring_down if isinstance(law, Variational) else _make_uneven
    complete = bring_loads(run) and bring_followers(run) and bring(run, delta)
    return HomotopyPath(tuple(run.points), run.steps, run.iterations, complete)


def _bring_down(run: Tracking, target: float) -> bool:
    """Follow the smooth family to a smaller delta; other laws stay as they are."""
    factor = FACTOR
    while isinstance(run.law, Variational) and run.law.delta > target * (1 + 1e-9):
        goal = run.law.delta * factor
        law = sharpened(run.law, target if goal < NEARLY * target else goal)
        if run.step(law, None):
            run.law, factor = law, max(0.1, factor**2)
            run.keep()
            if is_coarse(run.points[-1]):
                run.regrade()
            continue
        factor = float(np.sqrt(factor))
        if factor > LEAST_FACTOR or run.steps > MOST_STEPS:
            return False
    return True


def _make_uneven(run: Tracking, target: float) -> bool:
    """Follow rods to a smaller ratio of stiffnesses; other laws stay as they are.

    Each step begins on the secant through the two equilibria before. Nodes follow the layers of
    twist or bending, and so does the secant: it goes from node to node, wherever they are.
    """
    if not in_family(run.law) or sharpness(run.law, 0.0) <= target * (1 + 1e-9):
        return True
    run.regrade(FEW, GATHERED)
    if not run.step(run.law, None):
        return False
    run.points[-1] = run.attempt.restored(run.w)
    count, step, before = FEW, FIRST_STEP, None
    at, last = float(np.log(sharpness(run.law, 0.0))), float(np.log(target))
    while at > last + 1e-9:
        step = min(step, at - last)
        law = sharpened(run.law, float(np.exp(at - step)))
        assert run.mesh is not None
        here, iterations = (at, run.mesh, run.w), run.iterations
        if before is not None and len(before[2]) == len(run.w):
            ahead = step / (before[0] - at)
            run.mesh = _beyond(before[1], run.mesh, ahead)
            run.w = run.w + (run.w - before[2]) * ahead
        # After many iterations it may be another equilibrium: the secant would be wrong.
        if run.step(law, None, most=SURE):
            before, run.law, at = here, law, at - step
            step = min(LARGEST_STEP, step * growth(2 * (run.iterations - iterations)))
            run.keep()
            if is_coarse(run.points[-1]):
                count = MANY
            run.regrade(count, GATHERED)
            continue
        _, run.mesh, run.w = here
        step /= 2
        if step < SMALLEST_STEP:
            return False
    return True


def _beyond(before: Mesh, here: Mesh, ahead: float) -> Mesh:
    """Return the mesh that follows from two, `ahead` times as far on."""
    (a,), (b,) = before.phases, here.phases
    widths = np.maximum(b + (b - a) * ahead, NARROWER * b)
    return Mesh((widths / widths.sum(),))
