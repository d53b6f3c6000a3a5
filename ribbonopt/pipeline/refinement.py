"""Refinement: from a solution to one whose estimated error meets the scene's tolerance.

Nodes are moved (widths are parameters: nothing is built), then elements are added, until the error
of the answer is small enough. Each solve starts on the solution before, by Newton's method.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.accuracy.compared import alone
from ribbonopt.accuracy.estimate import SAFETY, analyse, relative_error
from ribbonopt.accuracy.layers import Layers
from ribbonopt.accuracy.remesh import (
    SIZES,
    UNSEEN,
    WIDEST,
    analyticity,
    graded,
    redistributed,
    size_for,
    wanted_widths,
)
from ribbonopt.arrays import Array
from ribbonopt.attempt.afford import TooLargeError
from ribbonopt.attempt.attempt import verified
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status
from ribbonopt.transcription import Mesh

from .halving import AttemptOn, Halving

if TYPE_CHECKING:
    from ribbonopt.problem import Ribbon
    from ribbonopt.scene import Scene
    from ribbonopt.transcription.structure import Blocks

ROUNDS = 20
SLOW = 0.3  # share of the error before that a round should leave
AIM = 0.5  # share of the tolerance that a new mesh aims at
CLOSE = 10.0  # times the tolerance, from where on a mesh that helped little was not fine enough
GROUND = 2e-14  # local error of an element that is rounding
MOST = 190  # elements of a minimum, of a phase
LEFT = 3.0  # times what the solver leaves, below which finer meshes are of little use
GROWTH = 2.0  # most that the number of elements grows in a round


def refine(
    solution: Solution,
    tolerance: float,
    ribbon: Ribbon,
    attempt_on: AttemptOn,
    aim: float = AIM,
) -> Solution:
    """Return a verified solution whose error, relative to the sizes of the answer, is small enough.

    Parameters
    ----------
    solution
        A verified solution on any mesh.
    tolerance
        Relative error wanted, see `ribbonopt.accuracy.estimate.relative_error`.
    ribbon
        Mechanics, to verify what comes out.
    attempt_on
        Gives the means to solve on a mesh.
    aim
        Share of the tolerance that a new mesh aims at.

    Returns
    -------
    Solution
        With a status that says so where the tolerance could not be met.
    """
    first, before, means = solution, np.inf, Halving(attempt_on, list(solution.steps))
    found = means.compared(solution)
    if found is None:
        return _missed(replace(solution, steps=tuple(means.steps)), tolerance)
    solution, steps = found, means.steps
    best, smallest, status, rounded = solution, np.inf, Status.TOLERANCE_MISSED, False
    for _ in range(ROUNDS):
        try:
            error, _ = relative_error(solution)
        except np.linalg.LinAlgError:
            lost = Status.SINGULAR
            solution = solution if solution.verification.known else verified(solution, ribbon)
            return replace(solution, status=lost, message=lost.value, steps=tuple(steps))
        if error < smallest:
            best, smallest = solution, error
        if error <= tolerance:
            # In phases the signs of m2 are judged by the error, which is known only now.
            same = solution is first and not solution.sheets and solution.verification.known
            done = solution if same else verified(solution, ribbon)
            return done if same else replace(done, steps=tuple(steps))
        least = analyse(solution).least
        stuck, close = error > SLOW * before, error <= CLOSE * tolerance
        again, rounded = rounded, stuck and _is_rounding(solution, tolerance)
        status = Status.ROUNDED if rounded else Status.TOLERANCE_MISSED
        # Close to the tolerance the mesh may just not have been fine enough: one more tells.
        if _is_left(error, least) or (rounded and (again or not close)):
            status = Status.ROUNDED
            break
        surprised = stuck and not close and not solution.problem.recovered
        goal = max(aim * tolerance * (1 / CLOSE if stuck and close else 1.0), least)
        mesh, short = _better_mesh(solution, goal, error, surprised)
        before = error
        try:
            found = means.on(mesh, solution, error)
        except TooLargeError:  # what there is is worth more than a message
            break
        if found is None:
            break
        solution = found
        if short:
            break
    if solution is not best and relative_error(solution)[0] > smallest:
        solution = best
    solution = verified(replace(solution, steps=tuple(steps)), ribbon)
    return _missed(solution, tolerance, status) if solution.verified else solution


def _is_left(error: float, least: float) -> bool:
    """Whether an error is what the solver leaves on any mesh."""
    return error <= LEFT * least


def _is_rounding(solution: Solution, tolerance: float) -> bool:
    """Whether every element is as exact as can be, so that finer ones only add rounding."""
    found = analyse(solution)
    inside = SAFETY * float(found.inside.max()) <= tolerance
    return bool(found.local.max() <= GROUND and inside)


def on_finer_mesh(missed: Solution, solve: Callable[[Scene], Solution]) -> Solution:
    """Solve a scene anew on twice as many elements, if no finer mesh led on from its own.

    A coarse mesh has solutions of its own, near which there is none of the ribbon's equations.
    """
    scene, count = missed.scene, missed.scene.transcription.intervals
    if sum(missed.mesh.elements) > count:
        return missed
    finer = replace(scene.transcription, intervals=2 * count)
    try:
        found = solve(replace(scene, transcription=finer))
    except TooLargeError:
        return missed
    if not found.verified:
        return missed
    steps, iterations = (*missed.steps, *found.steps), missed.iterations + found.iterations
    spent = {name: missed.timings[name] + seconds for name, seconds in found.timings.items()}
    found = replace(found, posed=missed.posed, steps=steps)
    return replace(found, iterations=iterations, timings=spent)


def _better_mesh(
    solution: Solution, aim: float, error: float, surprised: bool
) -> tuple[Mesh, bool]:
    """Return a mesh that brings the error to `aim`, and whether it is as fine as any may be.

    `surprised` that the mesh before did not, it expects a layer that no stage has met so far.
    """
    found = analyse(solution)
    trajectory, local, known = found.trajectory, found.local, found.layers
    dense, blocks, minimum = trajectory.dense, trajectory.dense.blocks, solution.problem.recovered
    widths, phases, short = blocks.widths(dense.p), [], False
    target = float(local.sum()) * min(1.0, aim / error) / len(local)
    # Inside an element the collocation polynomial counts, whose order is lower.
    inside = (SAFETY * found.inside / aim) ** (1 / (blocks.degree + 1))
    rho = analyticity(dense.decay())
    if surprised:
        rho = np.where(local > target, UNSEEN, rho)
    lengths, most = np.diff(trajectory.ends) * trajectory.length, MOST if minimum else SIZES[-1]
    for part, near, length in zip(blocks.layout.phase_slices, known, lengths, strict=True):
        h = widths[part]
        wanted = wanted_widths(h, local[part], rho[part], blocks.order, target)
        wanted = np.minimum(wanted, h / np.maximum(inside[part], 1 / WIDEST))
        if minimum:  # controls have a lower order still, and are singular where strains fade
            open_ = SAFETY * found.inside[part]
            widest = wanted_widths(h, open_, rho[part], blocks.degree - 1, aim)
            wanted = np.minimum(wanted, widest)
        limits = _limits(near, blocks, target / length, bool(minimum)) if len(near) else ()
        positions, share = graded(h, wanted, *limits)
        count = max(int(np.ceil(share[-1])), len(h) // 2)
        size = size_for(min(count, int(GROWTH * len(h)), most))
        short = short or (size == most and count > size)
        phases.append(redistributed(positions, share, size))
    return Mesh(tuple(phases)), short


def _limits(
    near: Layers, blocks: Blocks, target: float, minimum: bool
) -> tuple[Array, Callable[[Array], Array]]:
    """Return where layers are, and the widths that resolve them.

    In elements so narrow that no jump matters in them a minimum tells nothing of its controls.
    """
    least = target / float(near.sizes.max(initial=target)) if minimum else 0.0
    return near.places.real, lambda positions: np.maximum(
        near.widths(positions, blocks.degree, blocks.order, target), least
    )


def _missed(
    solution: Solution, tolerance: float, status: Status = Status.TOLERANCE_MISSED
) -> Solution:
    """Return the solution, with what keeps its error from being small enough."""
    if alone(solution):
        why = "No minimum was found on a finer mesh, with which to compare this one"
        return replace(solution, status=status, message=f"{status.value}. {why}")
    error, name = relative_error(solution)
    if error <= tolerance:
        return solution
    found = analyse(solution)
    local, nodes, (start, end) = found.local, found.trajectory.nodes, solution.scene.interval
    element = int(np.argmax(local))
    a, b = start + (end - start) * nodes[element : element + 2]
    return replace(
        solution,
        status=status,
        message=(
            f"{status.value}. The relative error of {name} is {error:.1e}, asked "
            f"was {tolerance:.1e}, on {len(solution.nodes) - 1} intervals; most of it "
            f"comes from s = {a:.4g} to s = {b:.4g}"
        ),
    )
