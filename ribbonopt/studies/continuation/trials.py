"""What attempts come to, as trials of the walk: the position stands behind their unknowns."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import SolveReport

from .walk.protocol import Trial


def trial_of(attempt: Attempt, position: Array) -> Trial[Solution]:
    """Return what attempt at a position (1,) have come to."""
    found = attempt.best
    assert found is not None
    unknowns = np.concatenate([found.dense.w, position])
    return Trial(found, unknowns, found.verified, found.message)


def checked(trial: Trial[Solution], found: Solution) -> Trial[Solution]:
    """Return a trial with another solution at its position; the same unknowns where these are."""
    unknowns = trial.unknowns
    if found.trajectory is not trial.solution.trajectory:
        unknowns = np.append(found.dense.w, unknowns[-1])
    return Trial(found, unknowns, found.verified, found.message)


def without_last(report: SolveReport) -> SolveReport:
    """Return the report without the position and its equation."""
    return replace(
        report,
        w=report.w[:-1],
        residuals=report.residuals[:-1],
        multipliers=report.multipliers[:-1],
    )
