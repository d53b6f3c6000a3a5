"""Loads brought on: the conditions at the ends met bit by bit, and what acts along the ribbon.

A step that fails is tried again shorter; steps that succeed grow.
"""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array

from .factors import Factors
from .tracking import MOST_STEPS, SURE, Tracking, growth

NEAR = 0.05  # residual of the conditions, over 1 + size of the loads, that Newton may close at once
HEAVY = 30.0  # size of loads, Dw = L = 1, beyond which they are brought on by factors
FIRST_FOLLOWERS = 1.2  # of the logarithm of loads without a potential: what is first tried
LEAST_STEP = 1 / 64


def bring_loads(run: Tracking) -> bool:
    """Meet the conditions: at once where they nearly hold, else bit by bit."""
    residuals = run.conditions()
    _, _, constants = run.attempt.nlp.layout.unpack(run.w)
    off = float(np.abs(residuals).max()) / (1 + float(np.abs(constants).max(initial=0.0)))
    if off < NEAR and run.step(run.law, None):
        return run.keep()
    size = max(float(np.abs(residuals).max()), _along(run))
    if size > HEAVY:
        return _bring_heavy(run, size)
    share, step = 0.0, 0.25
    if not run.step(run.law, residuals):
        return False
    while share < 1:
        following = min(1.0, share + step)
        if run.step(run.law, (1 - following) * residuals):
            share, step = following, min(2 * step, 0.5)
            continue
        step /= 4
        if step < LEAST_STEP or run.steps > MOST_STEPS:
            return False
    return run.keep()


def _bring_heavy(run: Tracking, size: float) -> bool:
    """Bring on loads far larger than one: their size grows by factors, and meshes follow."""
    run.loads = 0.0
    run.attempt = run.attempt_at(run.law)
    residuals = run.conditions()
    # Evenly at first, then by factors: first buckling is at a few units of load.
    course = Factors(size, 0.5)
    while not course.done:
        run.loads = course.share
        if not _grown(run, course, (1 - run.loads) * residuals, heavy=True):
            return False
    return run.step(run.law, None) and run.keep()


def bring_followers(run: Tracking) -> bool:
    """Bring on the loads along the ribbon that have no potential: least energy knew none."""
    if run.followers == 1:
        return True
    size = _along(run, without_potential=True)
    course = Factors(size, FIRST_FOLLOWERS)
    while not course.done:
        run.followers = course.share
        if not _grown(run, course, None, heavy=size > HEAVY):
            return False
    run.followers = 1.0
    run.points.pop()  # an equilibrium without them
    return run.keep()


def _grown(run: Tracking, course: Factors, relaxed: Array | None, *, heavy: bool) -> bool:
    """Try the loads as they are now, and say whether to go on; meshes follow `heavy` ones."""
    before, w = run.iterations, run.w
    run.attempt = run.attempt_at(run.law)
    done = run.step(run.law, relaxed)
    if done and run.iterations - before <= SURE:
        course.taken(growth(run.iterations - before))
        if heavy:
            run.regrade()
        return True
    # After many iterations it may be another equilibrium: not what grew from before.
    run.w = w
    return course.refused() and run.steps <= 2 * MOST_STEPS


def _along(run: Tracking, *, without_potential: bool = False) -> float:
    """Return the size of loads between the ends, as a force."""
    loads = [load for load in run.posed.loads if bool(load.without_potential) is without_potential]
    along = run.posed.length * max((load.size_along() for load in loads), default=0.0)
    stations = () if without_potential else run.posed.stations
    points = (action.loads.values() for station in stations for action in station.actions)
    return max(along, *(abs(v) for some in points for v in some), 0.0)
