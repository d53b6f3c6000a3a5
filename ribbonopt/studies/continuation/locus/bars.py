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
from ribbonopt.solvers.local import Local, local, local_near
from ribbonopt.transcription import Mesh

from ..coordinates import row_in
from ..walk.points import FOLD
from ..walk.protocol import Trial
from .chart import Row
from .laid import Laid
from .slices import LostError

if TYPE_CHECKING:
    from .equations import LocusEquations

MESHES = 3  # on finer meshes, at most
SAFETY = 4.0  # bar over what the better scheme moves, as of all other numbers
STEEPEST = 0.1  # least share of l2 in the direction of a locus, for errors of l1 at one l2
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
        again = on_finer_mesh(equations, trial)
        if not again.converged:
            break
        trial = again
    return trial


def error_of(equations: LocusEquations, trial: Trial[Solution], laid: Laid) -> float:
    """Bound of the error of l1 at a point of a locus, at the same l2 but where that turns."""
    step = _moved(equations, trial, laid)
    # The locus in the plane of the parameters: at a cusp it has the direction of the plane's image.
    spans = np.array(equations.surface.spans)
    ways = [part[-2:] / spans for part in (laid.tangent, laid.across)]
    e = ways[0]
    if equations.kind == FOLD:
        e = max(ways, key=lambda way: float(np.linalg.norm(way)))
    e = e / np.linalg.norm(e)
    off = abs(e[1] * step[0] / spans[0] - e[0] * step[1] / spans[1])
    error = SAFETY * spans[0] * off / max(abs(e[1]), STEEPEST)
    return float(max(error + laid.doubt, ROUNDING * abs(trial.unknowns[-2])))


def _moved(equations: LocusEquations, trial: Trial[Solution], laid: Laid) -> Array:
    """Differences (2,) of the positions from those of the better scheme, along the chart."""
    solution = trial.solution
    equations = equations.measured(solution)
    better = _Better(equations, solution, laid)
    if equations.kind == FOLD:
        return better.near(trial.unknowns)[0].step[-2:]
    if laid.sides is None:
        raise LostError("the branch point is not known on both sides")
    own = equations.chart(
        solution,
        trial.unknowns,
        *(equations.reduced(solution, part) for part in (laid.tangent, laid.across)),
    )
    places, before, after, steps = [], [], [], []
    for side in laid.sides:
        read = own.read(side)
        places.append(own.place(side)[1])
        before.append(read.test)
        near, extended = better.near(side)
        there = better.at(extended + near.step)
        after.append(there.sign * float(np.exp(there.log - own.scale)))
        steps.append(near.step[-2:])
    t, off = np.array(places), np.array(after) - np.array(before)
    weights = np.array([t[1], -t[0]]) / (t[1] - t[0])
    slope = (before[1] - before[0]) / (t[1] - t[0])
    shift = -float(weights @ off) / slope
    return np.asarray(weights @ np.array(steps) + shift * laid.across[-2:])


class _Better:
    """The next better scheme next to a point of a locus, with the rows of the point's chart."""

    def __init__(self, equations: LocusEquations, solution: Solution, laid: Laid) -> None:
        self.equations, self.solution = equations, solution
        output, _ = solution.dense.refined()
        self.line = equations.surface.line_of(output)
        metric, layout = equations.metric, output.blocks.layout
        along, self.row = (
            row_in(layout, metric.dual(equations.reduced(solution, part)), self.line.count)
            for part in (laid.tangent, laid.across)
        )
        self.further = (Row(self.line, along, 0.0),)

    def near(self, unknowns: Array) -> tuple[Local, Array]:
        """Linearise at unknowns (n + 2,) of the point's layout; return that, and them here."""
        output, _ = self.equations.restored(self.solution, unknowns).dense.refined()
        found, _ = local_near(self.line, self.row, output.w, unknowns[-2:], self.further)
        return found, np.append(output.w, unknowns[-2:])

    def at(self, extended: Array) -> Local:
        """Linearise at unknowns of the better scheme."""
        w, positions = self.line.split(extended)
        return local(self.line, self.row, w, positions, self.further)


def on_finer_mesh(equations: LocusEquations, trial: Trial[Solution]) -> Trial[Solution]:
    """Find a point again on halved elements, at the same l2."""
    finer, y = halved(equations, trial)
    return equations.measured(finer).correct_at(finer, y)


def halved(equations: LocusEquations, trial: Trial[Solution]) -> tuple[Solution, Array]:
    """Return a point and its unknowns (n' + 2,) on halved elements, not corrected there."""
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
        parts.append(
            (moved(trial.unknowns + h * part) - moved(trial.unknowns - h * part)) / (2 * h)
        )
    finer = attempt.restored(y[:-2])
    finer.trajectory.found[Laid] = replace(laid, tangent=parts[0], across=parts[1], sides=None)
    return finer, y
