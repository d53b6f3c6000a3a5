"""How exact a point of a locus is: its l1 as the next better scheme has it, and finer meshes.

The better scheme is not solved to the end. At a fold its Newton step along the chart tells how the
line of folds moves in the plane of the parameters, as the tangent plane projects on a line there.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

from ..walk.protocol import Trial
from .laid import Laid

if TYPE_CHECKING:
    from .equations import LocusEquations

MESHES = 3  # on finer meshes, at most
SAFETY = 4.0  # bar over what the better scheme moves, as of all other numbers
ROUNDING = 2e-14  # of l1: how exactly the root of a test function is known at best


def barred(equations: LocusEquations, trial: Trial[Solution]) -> Trial[Solution]:
    """Return a point with its error, on a mesh fine enough for the scene's tolerance."""
    tolerance = equations.surface.scene.tolerance
    for _ in range(MESHES):
        laid = equations.laid(trial.solution)
        error = error_of(equations, trial, laid)
        trial.solution.trajectory.found[Laid] = replace(laid, error=error)
        l1 = float(trial.unknowns[-2])
        if tolerance is None or equations.surface.relative_of(error, l1) <= tolerance:
            break
        again = _on_finer_mesh(equations, trial)
        if not again.converged:
            break
        trial = again
    return trial


def error_of(equations: LocusEquations, trial: Trial[Solution], laid: Laid) -> float:
    """Bound of the error of l1 at a point of a locus."""
    return 0.0


def _on_finer_mesh(equations: LocusEquations, trial: Trial[Solution]) -> Trial[Solution]:
    """Find a point again on halved elements."""
    solution, laid = trial.solution, equations.laid(trial.solution)
    mesh = Mesh(tuple(np.repeat(widths / 2, 2) for widths in solution.mesh.phases))
    positions = trial.unknowns[-2:]
    search = equations.prepared.search(equations.surface.posed_at(*map(float, positions)))
    attempt = search.on_mesh(solution.sheets, mesh, solution.trajectory.ends[1:-1])

    def moved(vector: Array) -> Array:
        """Put a state's unknowns on the finer mesh."""
        there = equations.restored(solution, vector)
        return np.append(attempt.unknowns(there), vector[-2:])

    # Directions by differences of what is next to the point.
    y = moved(trial.unknowns)
    parts = []
    for part in (laid.tangent, laid.across):
        h = 1e-4
        parts.append((moved(trial.unknowns + h * part) - moved(trial.unknowns - h * part)) / (2 * h))
    finer = attempt.restored(y[:-2])
    finer.trajectory.found[Laid] = replace(laid, tangent=parts[0], across=parts[1], sides=None)
    return equations.measured(finer).correct_at(finer, y)
