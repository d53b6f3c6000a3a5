"""What a scene does not need and is therefore not made, each with its reason."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ribbonopt.problem import BoundaryValueProblem, Posed

if TYPE_CHECKING:
    from ribbonopt.solution.solution import Solution

    from .search import Search


def skipped(
    posed: Posed,
    problem: BoundaryValueProblem,
    search: Search | None = None,
    found: Solution | None = None,
) -> tuple[str, ...]:
    """Say what a scene does not need and what is therefore not made, each with its reason.

    `search` is what has led to a solution, `found` that after refinement; before it there is none.
    """
    result, scene = [], posed.given
    ledger = None if search is None else search.ledger
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
    if search is not None and found is not None and solvers and not found.sheets:
        result.append(f"phases ({_no_phases(search)})")
    result += [] if ledger is None else ledger.spared
    if scene.continuation is not None:
        result.append("continuation (ribbonopt continue follows it)")
    if scene.tolerance is None:
        result.append("mesh refinement (no tolerance is asked for)")
    elif search is not None and found is not None and found.verified and solvers:
        best = search.best
        if best is not None and found.trajectory is best.trajectory:
            result.append("mesh refinement (the first mesh meets the tolerance)")
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


def _no_phases(search: Search) -> str:
    """Say why a solution has no phases."""
    scene, law = search.posed.scene, search.structure.ribbon.law
    if not law.kinked:
        return "the law is smooth"
    if scene.formulation != "inverted":
        return "only the inverted formulation has any"
    return "the scene says so" if scene.switching == "off" else f"{law.switch_name} keeps its sign"
