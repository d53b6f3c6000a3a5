"""The one place where solutions are made: from unknowns, or from what a solver reports.

For a minimum the loads follow from the costates.
"""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.problem import BoundaryValueProblem, Posed
from ribbonopt.solvers import SolveReport, Status
from ribbonopt.transcription import NLP

from .solution import Solution
from .trajectory import Trajectory
from .verification import unverified


def solution_at(
    posed: Posed,
    problem: BoundaryValueProblem,
    nlp: NLP,
    w: Array,
    p: Array,
    **known: Any,
) -> Solution:
    """Return the solution with the unknowns w (nw,) at the parameters p (np,).

    Parameters
    ----------
    posed, problem, nlp
        What is asked, its equations and the program they became.
    w, p
        Unknowns and parameters.
    known
        Other fields of `Solution`; without them it has converged and nothing of it was checked.
    """
    fields: dict[str, Any] = {
        "status": Status.CONVERGED,
        "message": Status.CONVERGED.value,
        "iterations": 0,
        "verification": unverified(),
    }
    trajectory = Trajectory(problem, nlp.output(w, p))
    return Solution(posed=posed, trajectory=trajectory, **(fields | known))


def solution_of(
    posed: Posed,
    problem: BoundaryValueProblem,
    nlp: NLP,
    report: SolveReport,
    p: Array,
    sheets: tuple[int, ...] = (),
) -> Solution:
    """Return what a solver found for a posed scene at the parameters p (np,), not yet verified."""
    w = report.w
    if report.status.converged and problem.recovered:
        p = _with_recovered(problem, nlp, report, p)
        if problem.completed is not None:
            w = _completed(problem, problem.completed, nlp, w, p)
    return solution_at(
        posed,
        problem,
        nlp,
        w,
        p,
        status=report.status,
        message=report.status.value,
        iterations=report.iterations,
        multipliers=report.multipliers,
        sheets=sheets,
    )


def _with_recovered(
    problem: BoundaryValueProblem, nlp: NLP, report: SolveReport, p: Array
) -> Array:
    """Parameters p (np,) with those put in that follow from the costates."""
    inputs = [problem.points[0], problem.costate, problem.parameters]
    function = ca.Function("recover", inputs, [ca.vertcat(*problem.recovered.values())])
    nodes, _, _ = nlp.layout.unpack(report.w)
    theta = p[: problem.parameters.numel()]
    values = function(nodes[0], nlp.layout.start_costate(report.multipliers), theta)
    where = [problem.parameter_names.index(name) for name in problem.recovered]
    result: Array = p.copy()
    result[where] = np.array(values).ravel()
    return result


def _completed(
    problem: BoundaryValueProblem, completed: ca.SX, nlp: NLP, w: Array, p: Array
) -> Array:
    """Unknowns w (nw,) with states that hold what was recovered."""
    nodes, stages, constants = nlp.layout.unpack(w)
    function = ca.Function("completed", [problem.state, problem.parameters], [completed])
    theta, nx = p[: problem.parameters.numel()], problem.state.numel()

    def put_into(states: Array) -> Array:
        flat = states.reshape(-1, nx)
        found = function.map(len(flat))(flat.T, np.repeat(theta[:, None], len(flat), axis=1))
        return np.asarray(np.array(found).T.reshape(states.shape))

    inside = stages.copy()
    inside[..., :nx] = put_into(np.ascontiguousarray(stages[..., :nx]))
    return nlp.layout.pack(put_into(nodes), inside, constants)
