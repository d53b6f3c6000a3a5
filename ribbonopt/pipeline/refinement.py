"""Refinement: from a solution to one whose estimated error meets the scene's tolerance.

Nodes are moved (widths are parameters: nothing is built), then elements are added, until the error
of the answer is small enough. Each solve starts on the solution before, by Newton's method.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

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

if TYPE_CHECKING:
    from ribbonopt.attempt.attempt import Attempt
    from ribbonopt.problem import Ribbon
    from ribbonopt.scene import Scene

ROUNDS = 20
SLOW = 0.3  # share of the error before that a round should leave
AIM = 0.5  # share of the tolerance that a new mesh aims at
CLOSE = 10.0  # times the tolerance, from where on a mesh that helped little was not fine enough
GROUND = 2e-14  # local error of an element that is rounding
GROWTH = 2.0  # most that the number of elements grows in a round


def refine(
    solution: Solution,
    tolerance: float,
    ribbon: Ribbon,
    attempt_on: Callable[[Mesh, Array], Attempt],
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
        Gives the means to solve on a mesh, phases meeting at given fractions of the length.
    aim
        Share of the tolerance that a new mesh aims at.

    Returns
    -------
    Solution
        With a status that says so where the tolerance could not be met.
    """
    first, steps, before = solution, list(solution.steps), np.inf
    best, least, status = solution, np.inf, Status.TOLERANCE_MISSED
    for _ in range(ROUNDS):
        try:
            error, _ = relative_error(solution)
        except np.linalg.LinAlgError:
            lost = Status.SINGULAR
            return replace(solution, status=lost, message=lost.value, steps=tuple(steps))
        if error < least:
            best, least = solution, error
        if error <= tolerance:
            # In phases the signs of m2 are judged by the error, which is known only now.
            same = solution is first and not solution.sheets
            done = solution if same else verified(solution, ribbon)
            return replace(done, steps=tuple(steps))
        if error > SLOW * before and _is_rounding(solution, tolerance):
            status = Status.ROUNDED
            break
        started = time.perf_counter()
        stuck, close = error > SLOW * before, error <= CLOSE * tolerance
        goal = aim * tolerance * (1 / CLOSE if stuck and close else 1.0)
        mesh, short = _better_mesh(solution, goal, error, stuck and not close)
        before = error
        try:
            attempt = attempt_on(mesh, solution.trajectory.ends[1:-1])
        except TooLargeError:  # what there is is worth more than a message
            break
        if not attempt.run(solution, quick=True, check=False) or attempt.best is None:
            break
        solution = attempt.best
        steps.append(
            {
                "step": f"mesh of {sum(mesh.elements)} intervals for an error of {error:.0e}",
                "iterations": attempt.iterations,
                "seconds": time.perf_counter() - started,
            }
        )
        if short:
            break
    if solution is not best and relative_error(solution)[0] > least:
        solution = best
    solution = verified(replace(solution, steps=tuple(steps)), ribbon)
    return _missed(solution, tolerance, status) if solution.verified else solution


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
    blocks, found = solution.dense.blocks, analyse(solution)
    local, known = found.local, found.layers
    widths, phases, short = blocks.widths(solution.dense.p), [], False
    target = float(local.sum()) * min(1.0, aim / error) / len(local)
    # Inside an element the collocation polynomial counts, whose order is lower.
    inside = (SAFETY * found.inside / aim) ** (1 / (blocks.degree + 1))
    rho = analyticity(solution.dense.decay())
    if surprised:
        rho = np.where(local > target, UNSEEN, rho)
    lengths = np.diff(solution.trajectory.ends) * solution.trajectory.length
    for part, near, length in zip(blocks.layout.phase_slices, known, lengths, strict=True):
        h = widths[part]
        wanted = wanted_widths(h, local[part], rho[part], blocks.order, target)
        wanted = np.minimum(wanted, h / np.maximum(inside[part], 1 / WIDEST))
        limits = _limits(near, blocks.degree, blocks.order, target / length) if len(near) else ()
        positions, share = graded(h, wanted, *limits)
        count = max(int(np.ceil(share[-1])), len(h) // 2)
        size = size_for(min(count, int(GROWTH * len(h))))
        short = short or (size == SIZES[-1] and count > size)
        phases.append(redistributed(positions, share, size))
    return Mesh(tuple(phases)), short


def _limits(
    near: Layers, degree: int, order: int, target: float
) -> tuple[Array, Callable[[Array], Array]]:
    """Return where layers are, and the widths that resolve them."""
    return near.places.real, lambda positions: near.widths(positions, degree, order, target)


def _missed(solution: Solution, tolerance: float, status: Status) -> Solution:
    """Return the solution, with what keeps its error from being small enough."""
    error, name = relative_error(solution)
    if error <= tolerance:
        return solution
    local = analyse(solution).local
    element = int(np.argmax(local))
    a, b = solution.nodes[element], solution.nodes[element + 1]
    return replace(
        solution,
        status=status,
        message=(
            f"{status.value}. The relative error of {name} is {error:.1e}, asked "
            f"was {tolerance:.1e}, on {len(local)} intervals; most of it comes from s = {a:.4g} to "
            f"s = {b:.4g}"
        ),
    )
