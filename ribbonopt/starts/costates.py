"""Loads from the costates of a minimum: parameters that follow once a problem is solved."""

from __future__ import annotations

import casadi as ca
import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.solvers import SolveReport
from ribbonopt.transcription import NLP


def with_recovered(problem: BoundaryValueProblem, nlp: NLP, report: SolveReport, p: Array) -> Array:
    """Parameters p (np,) with those put in that follow from the costates; p where none do."""
    if not problem.recovered:
        return p
    inputs = [problem.points[0], problem.costate, problem.parameters]
    function = ca.Function("recover", inputs, [ca.vertcat(*problem.recovered.values())])
    nodes, _, _ = nlp.layout.unpack(report.w)
    theta = p[: problem.parameters.numel()]
    values = function(nodes[0], nlp.layout.start_costate(report.multipliers), theta)
    where = [problem.parameter_names.index(name) for name in problem.recovered]
    result: Array = p.copy()
    result[where] = np.array(values).ravel()
    return result
