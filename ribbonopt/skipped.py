"""What a scene does not need and is therefore not made, each with its reason."""

from __future__ import annotations

from ribbonopt.problem import BoundaryValueProblem
from ribbonopt.scene import Scene


def skipped(
    scene: Scene, problem: BoundaryValueProblem, solvers: tuple[str, ...] = ()
) -> tuple[str, ...]:
    """Say what a scene does not need and what is therefore not made, each with its reason.

    `solvers` are those that were used; before a solve, none.
    """
    result = []
    if scene.states == "reduced":
        result.append("force and moment as states (no loads: n is constant, m follows from r)")
        result.append("nine director components (a unit quaternion carries the frame)")
    if all(phase.cost is None for phase in problem.phases):
        result.append("second derivatives (nothing is minimised)")
    if problem.square and scene.solver.type != "ipopt" and "ipopt" not in solvers:
        result.append("IPOPT and the sparse Jacobian (Newton condenses element by element)")
    if scene.guess != "auto":
        result.append("automatic start (the guess is given)")
    result.append("mesh refinement and further formulations (not asked for)")
    return tuple(result)
