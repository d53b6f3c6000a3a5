"""From a branch point onto the branch that crosses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ribbonopt.arrays import Array

from .points import KINK, POINT, Point, S
from .protocol import Equations
from .tangents import near, renewed

AWAY, LEAST_AWAY = 0.05, 1e-4  # arclength of the first step onto a branch that crosses
FARTHER = (2 * AWAY, 4 * AWAY)  # where rounding is magnified too much there
BACK = 0.3  # of that: most that accuracy may move its end by
MOVES = 1e-3  # least change of the position, as one counts, over the square of the arclength
PITCHFORK, TRANSCRITICAL = "pitchfork", "transcritical"
BESIDE = (0.0, 1e-12, 1e-10, 1e-8)  # arclength from a point where equations are nearly singular


def switched(
    equations: Equations[S],
    point: Point[S],
    sign: int,
    itself: Callable[[Point[S]], bool] = lambda point: False,
    least: float = LEAST_AWAY,
) -> Point[S]:
    """Return the first point on the branch that crosses at a branch point; LinAlgError for none.

    `itself` tells whether a point is on the branch that is left. Such a one is returned only where
    none nearer is on another: that branch may cross itself. `least` is the arclength below which
    none is looked for.
    """
    equations = equations.measured(point.solution)
    point = renewed(equations, point)
    if point.kind == KINK:
        return _left(equations, point, sign)
    known = equations.departure(point)
    if known is None:
        direction = sign * _oriented(equations, point, null_direction(equations, point))
    else:
        direction = sign * _oriented(equations, known.along, known.direction)
        point = known.along if direction @ known.direction > 0 else known.against
    away, own = AWAY, None
    while away > least:
        first = _at(equations, point, direction, away)
        if first is not None:
            if not itself(first[0]):
                return _sharp(equations, point, direction, itself, *first)
            own = own or first[0]
        away /= 2
    if own is not None:
        return own
    raise np.linalg.LinAlgError("no point was found on the branch that crosses")


def _at(
    equations: Equations[S], point: Point[S], direction: Array, away: float
) -> tuple[Point[S], bool] | None:
    """Return the point at an arclength from a branch point, finished, and whether it is blurred.

    None where there is none, or where finishing leads back on the branch itself, which is no
    crossing.
    """
    guess = point.unknowns + away * direction
    trial = equations.correct_along(point, direction, away, guess)
    off = equations.metric.length(equations.reduced(point.solution, trial.unknowns - guess))
    if not trial.converged or off >= away:
        return None
    there = equations.reduced(trial.solution, trial.unknowns)
    ahead = there - equations.reduced(point.solution, point.unknowns)
    trial = equations.finished(point, trial)
    moved = equations.reduced(trial.solution, trial.unknowns) - there
    if not trial.converged or equations.metric.length(moved) > BACK * away:
        return None
    found, tangent = near(equations, trial.solution, trial.unknowns, ahead)
    first = replace(
        point,
        solution=trial.solution,
        unknowns=trial.unknowns,
        tangent=tangent,
        sign=found.sign,
        step=away,
        kind=POINT,
        note=trial.note,
        row={},
        error=None,
    )
    return first, trial.blurred


def _sharp(
    equations: Equations[S],
    point: Point[S],
    direction: Array,
    itself: Callable[[Point[S]], bool],
    first: Point[S],
    blurred: bool,
) -> Point[S]:
    """Return a first point, or one farther off where that alone is as exact as asked.

    At a pitchfork rounding is magnified by the inverse square of the distance.
    """
    for away in FARTHER if blurred else ():
        try:
            other = _at(equations, point, direction, away)
        except np.linalg.LinAlgError:
            break
        if other is None or itself(other[0]):
            break
        if not other[1]:
            return other[0]
    return first


def _left(equations: Equations[S], point: Point[S], sign: int) -> Point[S]:
    """Return the first point on one of two branches that leave a kink beside the main one."""
    others = equations.leaving(point)[1:]
    which = (1 - sign) // 2
    if which >= len(others):
        raise np.linalg.LinAlgError("no more branches leave the kink than were followed")
    return replace(others[which], kind=POINT)


def named(equations: Equations[S], point: Point[S]) -> str:
    """Say what crosses at a branch point: a pitchfork, a transcritical branch, or "" for unknown.

    At a pitchfork the position turns on the branch that crosses.
    """
    try:
        direction = null_direction(equations, point)
    except np.linalg.LinAlgError:
        return ""
    for away in (AWAY / 8, AWAY / 32):
        moved = []
        for sign in (1, -1):
            guess = point.unknowns + sign * away * direction
            trial = equations.correct_along(point, sign * direction, away, guess)
            off = equations.metric.length(equations.reduced(point.solution, trial.unknowns - guess))
            if trial.converged and off < away:
                moved.append(float(trial.unknowns[-1]) - point.position)
        if len(moved) == 2:
            least = MOVES * away**2 * equations.metric.sizes[-1]
            if min(abs(change) for change in moved) < least:
                return ""
            return PITCHFORK if moved[0] * moved[1] > 0 else TRANSCRITICAL
    return ""


def null_direction(equations: Equations[S], point: Point[S]) -> Array:
    """Return the unit direction (n + k,) of the branch that crosses at a branch point.

    Across the tangent of the branch itself, in the metric of the branch.
    """
    metric = equations.metric
    ahead = equations.reduced(point.solution, point.tangent)
    direction = point.tangent
    for offset in BESIDE:
        unknowns = point.unknowns + offset * point.tangent
        solution = equations.restored(point.solution, unknowns)
        try:
            found, _ = near(equations, solution, unknowns, ahead)
        except np.linalg.LinAlgError:  # singular to the last digit
            continue
        # Singular to rounding, or nearly: what any side gives is the null direction, times so much
        # that its square may be no number.
        kernel = found.kernel()
        largest = float(np.abs(kernel).max())
        if np.isfinite(largest):
            direction = kernel / largest
            break
    direction = (
        direction
        - metric.product(equations.reduced(point.solution, direction), ahead) * point.tangent
    )
    return _oriented(equations, point, direction)


def _oriented(equations: Equations[S], point: Point[S], direction: Array) -> Array:
    """Return one of the two ways of a direction (n + k,), the same in every run; of unit length."""
    part = equations.reduced(point.solution, direction) / equations.metric.sizes
    # Components may be alike by symmetry, so that none of them can decide.
    sign = 1.0 if part @ np.cos(np.arange(len(part)) ** 1.5) >= 0 else -1.0
    return np.asarray(sign * direction / np.linalg.norm(part))
