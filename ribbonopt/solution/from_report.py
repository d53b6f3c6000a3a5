"""From a solver's report to a solution, loads from the costates of a minimum included."""

from __future__ import annotations

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.scene import Scene
from ribbonopt.solution.verification import unverified
from ribbonopt.solvers import SolveReport
from ribbonopt.transcription import NLP

from .solution import Solution
from .trajectory import Trajectory


def solution_of(
    scene: Scene,
    problem: BoundaryValueProblem,
    nlp: NLP,
    report: SolveReport,
    p: Array,
    sheets: tuple[int, ...] = (),
) -> Solution:
    """Return what a solver found for a scene at the parameters p (np,), not yet verified."""
    if report.status.converged and problem.recovered:
        p = _with_recovered(problem, nlp, report, p)
    return Solution(
        scene=scene,
        trajectory=Trajectory(problem, nlp.output(report.w, p)),
        status=report.status,
        message=report.status.value,
        iterations=report.iterations,
        verification=unverified(),
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
    theta = nlp.layout.theta(p)
    values = function(nodes[0], nlp.layout.start_costate(report.multipliers), theta)
    where = [problem.parameter_names.index(name) for name in problem.recovered]
    result: Array = p.copy()
    result[where] = np.array(values).ravel()
    return result
