"""What a scene does not need and is therefore not made, each with its reason."""

from __future__ import annotations

from ribbonopt.attempt.ledger import Ledger
from ribbonopt.problem import BoundaryValueProblem, Posed


def skipped(
    posed: Posed,
    problem: BoundaryValueProblem,
    ledger: Ledger | None = None,
    sheets: tuple[int, ...] = (),
) -> tuple[str, ...]:
    """Say what a scene does not need and what is therefore not made, each with its reason.

    `ledger` is what a solve has cost, `sheets` the phases it ended in; before it there are none.
    """
    result, scene = [], posed.given
    solvers = () if ledger is None else ledger.solvers
    if scene.states != "full":
        if not posed.loaded:
            result.append("force and moment as states (no loads: n is constant, m follows from r)")
        if scene.states == "planar":
            result.append("what is across the plane (an angle carries the frame)")
        else:
            result.append("nine director components (a unit quaternion carries the frame)")
    if all(phase.cost is None for phase in problem.phases):
        result.append("second derivatives (nothing is minimised)")
    may_need_it = scene.guess == "auto" if not solvers else "ipopt" in solvers
    if problem.square and scene.solver.type != "ipopt" and not may_need_it:
        result.append("IPOPT and the sparse Jacobian (Newton condenses element by element)")
    if scene.guess != "auto" and not (ledger and ledger.given_up):
        result.append("automatic start (the guess is given)")
    result += _repeated(posed)
    if solvers and not sheets:
        result.append("phases (the law is smooth, m2 keeps its sign, or the scene says so)")
    if scene.continuation is not None:
        result.append("continuation (ribbonopt continue follows it)")
    if scene.tolerance is None:
        result.append("mesh refinement (no tolerance is asked for)")
    return tuple(result)


def _repeated(posed: Posed) -> list[str]:
    """Say what symmetry repeats of a ribbon, or why no more of a loop."""
    boundary, result = posed.given.boundary, []
    loop, count = boundary.loop, boundary.pieces
    if count > 1 and (loop is not None or not posed.loaded):
        rest = "the other half" if count == 2 else f"{count - 1} of {count} pieces"
        whole = "strip" if loop is None else "loop"
        result.append(f"{rest} of the {whole} (symmetry repeats what is solved)")
    if boundary.repeats:
        result.append("disturbances without the symmetry (stability is not judged by them)")
    if loop is not None and posed.undivided:
        solved = {"whole": "the whole", "half": "a half"}.get(loop.piece, "this one")
        result.append(f"a smaller piece of the loop than {solved} (piece: auto: {posed.undivided})")
    return result
