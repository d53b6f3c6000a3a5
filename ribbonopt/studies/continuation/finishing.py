"""From what a correction came to, to a point: verified, to tolerance, in the phases it needs."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.accuracy.estimate import relative_error
from ribbonopt.attempt.attempt import verified
from ribbonopt.checks.phase_words import changed_phases
from ribbonopt.pipeline.spare import SPARE
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

from .along import NEXT_TO_FOLD, error_along
from .coordinates import row_of
from .trials import checked
from .walk.points import POINT, Point
from .walk.protocol import Trial

if TYPE_CHECKING:
    from .ribbons import RibbonEquations

GENTLE = 0.3  # share of the position in the tangent, from where on no fold is near
STEEP = 0.1  # of the error at a given position: one along the branch that tells of a fold
SINGULAR = "the equations are singular at this very point: branches cross there, or one turns"
NEXT_TO_CROSSING = "next to where branches cross: the error is above the tolerance"


def finished(
    equations: RibbonEquations, origin: Point[Solution], trial: Trial[Solution]
) -> Trial[Solution]:
    """Return a solution verified, to tolerance, in the phases it needs.

    None converged where the equations are singular to the last digit: another step is not.
    """
    try:
        return _finished(equations, origin, trial)
    except np.linalg.LinAlgError:
        return replace(trial, converged=False, message=SINGULAR)


def _finished(
    equations: RibbonEquations, origin: Point[Solution], trial: Trial[Solution]
) -> Trial[Solution]:
    found, note, prepared = trial.solution, "", equations.prepared
    tolerance = found.scene.tolerance
    search = prepared.search(found.posed)
    if not found.sheets and search.phases_help and search.better_in_phases(found):
        found = prepared.solve(found.posed, guess=found, fallback=False)
    elif equations.unbent(found):  # no error can be told of it
        found = verified(found, prepared.ribbon)
    elif tolerance is not None and relative_error(found)[0] > tolerance:
        found, note = _refined(equations, origin, trial, tolerance)
    else:
        found = verified(found, prepared.ribbon)
    note = "; ".join(filter(None, [note, changed_phases(origin.solution, found)]))
    missed = found.status in (Status.ROUNDED, Status.TOLERANCE_MISSED)
    blurred = missed and origin.kind != POINT
    if blurred:
        # Where branches cross rounding is magnified: the row says how exact it is.
        found = replace(found, status=Status.CONVERGED, message=Status.CONVERGED.value)
        note = "; ".join(filter(None, [note, NEXT_TO_CROSSING]))
    return replace(checked(trial, found), note=note, blurred=blurred)


def elsewhere(
    equations: RibbonEquations, origin: Solution, position: float
) -> Trial[Solution] | None:
    """Solve at a position with all that a single scene may need, where phases may have changed."""
    prepared = equations.prepared
    if not prepared.search(origin.posed).phases_help:
        return None
    posed = equations.curve.posed_at(position)
    found = prepared.solve(posed, guess=origin, fallback=False)
    note = changed_phases(origin, found)
    unknowns = np.append(found.dense.w, position)
    return Trial(found, unknowns, True, found.message, note) if found.verified else None


def _on_a_mesh(equations: RibbonEquations, solution: Solution) -> Solution:
    """Return a solution on a mesh that meets its tolerance: one grown from its own, or anew.

    Layers that have become thin since the mesh was made may be too much for one that grows.
    """
    found = equations.prepared.refined(solution, SPARE)
    if found.status is not Status.TOLERANCE_MISSED:
        return found
    again = equations.prepared.solve(solution.posed, guess=solution, fallback=False)
    return again if again.verified else found


def _refined(
    equations: RibbonEquations,
    origin: Point[Solution],
    trial: Trial[Solution],
    tolerance: float,
) -> tuple[Solution, str]:
    """Return a solution verified, as exact as asked for; next to a fold, along the branch."""
    solution, position = trial.solution, float(trial.unknowns[-1])
    prepared, curve = equations.prepared, equations.curve
    ahead = equations.metric.dual(equations.reduced(origin.solution, origin.tangent))
    if abs(origin.tangent[-1]) > GENTLE * equations.metric.sizes[-1]:
        return _on_a_mesh(equations, solution), ""
    for _ in range(2):
        error = error_along(solution, curve, position, row_of(solution, ahead))
        if error <= min(tolerance, STEEP * relative_error(solution)[0]):
            return verified(solution, prepared.ribbon), NEXT_TO_FOLD
        solution = _on_a_mesh(equations, solution)
        if solution.verified:
            break
    return solution, ""
