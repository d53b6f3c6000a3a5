"""Verification: whether this is the solution of the problem that the scene states.

Every condition is evaluated again on the dense output, by expressions that have no other roots than
the condition itself; directors must be orthonormal and |eta| <= 1 where the law demands it, and a
loop must close with the half twists that were asked.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ribbonopt.accuracy.estimate import SAFETY, Analysis, analyse
from ribbonopt.accuracy.gaps import LEAST, compared
from ribbonopt.mechanics.outputs import SLOPE, sheet_slopes
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.problem.imposed import verdicts_function
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.verification import NO_LENGTH, Verification, unverified
from ribbonopt.transcription.buffered import Buffered

from .zero_moment import SHORTEST, unbent_share

TOLERANCE = 1e-8
SPARE, MOST = 10.0, 1e-2  # times the estimated error; of the strains: how far off the law may be
ROUNDED = 1e-13  # of the largest moment: none
STRAIGHT = 1e-6  # by which the equations of a straight ribbon may be off between the stages
JUMP = 1e-6  # of the largest moment, on either side of a jump of the law


def verify(solution: Solution, ribbon: Ribbon) -> Verification:
    """Check a solution against its scene."""
    trajectory = solution.trajectory
    if len(trajectory.ends) > 2 and not (np.diff(trajectory.ends) > NO_LENGTH).all():
        problem = f"a phase between two sign changes of {ribbon.law.switch_name} has no length"
        return replace(unverified(), problems=(problem,))
    found, nodes = _measured(solution, ribbon), trajectory.at_nodes
    worst, residual, drift, problems = found.worst, found.residual, found.drift, list[str]()
    # Gauss keeps orthonormality to rounding, other schemes only to their own accuracy; natural
    # conditions of a minimum hold to the accuracy of the mesh.
    exact = solution.dense.blocks.symplectic and not solution.problem.recovered
    allowed = TOLERANCE + (0.0 if exact else residual)
    if not worst <= allowed:
        same = solution.posed.given is solution.posed.scene
        units = "" if same else " (units Dw = L = 1)"
        problems.append(f"{found.name} is off by {worst:.2g}{units}")
    if not drift["orthonormality"] <= allowed:
        problems.append(
            f"the directors are not orthonormal (off by {drift['orthonormality']:.2g}); refine the "
            "mesh or use scheme: gauss"
        )
    # The convexified energy itself allows |eta| > 1, as a mixture of both sheets.
    if solution.sheets:
        from .phase_margins import phase_problems  # few scenes have phases

        error = partial(_moment_error, solution)
        problems += phase_problems(solution, ribbon, TOLERANCE + residual, error)
    elif not ribbon.law.smooth and not solution.problem.recovered:
        from .arcs import sign_changes

        switches = sign_changes(solution).switches
        if len(switches):
            start, end = solution.scene.interval
            where = ", ".join(f"{start + (end - start) * at:.4g}" for at in switches)
            switch = ribbon.law.switch_name
            problems.append(
                f"{switch} changes sign at s = {where}, where the law's strains jump, without "
                "phases that end there"
            )
    if ribbon.law.natural and not ribbon.law.smooth and not solution.problem.recovered:
        from .equal_curvatures import unseen_leaps

        problems += unseen_leaps(solution)
    if ribbon.law.bounds_eta and not solution.problem.recovered:
        eta = sheet_slopes(nodes)
        if 0 in solution.sheets:
            phase = trajectory.phase_of(trajectory.nodes)
            eta[np.array(solution.sheets)[phase] == 0] = 0
        # Of a section without a moment, a free end, rounding tells the strains.
        told = np.maximum(np.abs(nodes["switching"]), nodes["leap"])
        eta[told <= ROUNDED * nodes.largest("m")] = 0
        if not eta.max() <= 1 + TOLERANCE + residual:
            s = solution.nodes[int(eta.argmax())]
            what = "the slope, |eta| but for natural strains," if SLOPE in nodes else "|eta|"
            problems.append(
                f"{what} = {eta.max():.4g} at s = {s:.4g}, beyond 1: eq. (4.1) forbids it; the "
                "ribbon wants to switch sheets there (law: sadowsky, regularized or variational)"
            )
    problems += (*_off_the_law(solution, ribbon), *_unseen(solution, ribbon, residual))
    problems += found.of_loop
    law = trajectory.at_stages.largest("law_residual")
    law /= max(nodes.largest("u"), LEAST)  # a straight ribbon has no strains
    return Verification(tuple(problems), worst, residual, law, drift)


class _Measured(NamedTuple):
    """What was measured of a solution of a posed scene; see `Verification`.

    `name` is that of the worst condition, `of_loop` what a loop is not that was asked for.
    """

    posed: Posed
    name: str
    worst: float
    residual: float
    drift: dict[str, float]
    of_loop: list[str]


def _measured(solution: Solution, ribbon: Ribbon) -> _Measured:
    """Measure once: a solution in phases is judged again when its error is known."""
    kept, posed = solution.trajectory.found, solution.posed
    known: _Measured | None = kept.get(_Measured)
    if known is None or known.posed is not posed:
        residual = float(solution.dense.residual_between_nodes().max())
        of_loop, loop = list[str](), solution.scene.boundary.loop
        if loop is not None:
            from .topology import loop_problems  # only where a scene has one

            of_loop = loop_problems(solution, loop, residual)
        worst, drift = _worst_condition(solution, ribbon), _drifts(solution, ribbon.uniform)
        known = kept[_Measured] = _Measured(posed, *worst, residual, drift, of_loop)
    return known


def _off_the_law(solution: Solution, ribbon: Ribbon) -> list[str]:
    """Say whether the strains at the nodes are others than those of the law at the moments.

    By more than the estimated error of the answer explains, or so far that nothing excuses it. In
    phases and in the inverted form they are the law's own; minima of a relaxed energy have others.
    """
    nodes = solution.trajectory.at_nodes
    off, size = nodes["law_residual"], max(nodes.largest("u"), LEAST)
    if nodes.largest("law_residual") <= TOLERANCE * size or solution.problem.recovered:
        return []
    if not ribbon.law.smooth:
        # Where the law jumps rounding decides on which side it is.
        off = np.where(np.abs(nodes["switching"]) > JUMP * nodes.largest("m"), off, 0.0)
    found = float(off.max()) / size
    if found <= TOLERANCE:
        return []
    try:
        errors = analyse(solution).errors
        explained = max(errors["states"], errors["u0"] / size)
    except np.linalg.LinAlgError:  # no estimate: nothing is explained
        explained = 0.0
    if found <= min(TOLERANCE + SPARE * explained, MOST):
        return []
    s = solution.nodes[int(off.argmax())]
    return [
        f"the strains at s = {s:.4g} are off the law by {found:.1e} of the largest: refine the "
        "mesh (transcription), or use formulation: inverted, which holds the law exactly"
    ]


def _unseen(solution: Solution, ribbon: Ribbon, residual: float) -> list[str]:
    """Say whether a state without a moment, of which no bar can tell, is one at the stages only."""
    if residual <= STRAIGHT or not unbent_share(solution, ribbon.law) > 1 - SHORTEST:
        return []
    return [
        f"the equations are off by {residual:.2g} between the stages of a ribbon without a moment "
        "at any, and no bar is known there: refine the mesh (transcription)"
    ]


def _moment_error(solution: Solution) -> float:
    """Bar of the moments along the ribbon, Dw = L = 1; infinite while the mesh is to be refined."""
    refined = Analysis in solution.trajectory.found
    if solution.posed.scene.tolerance is not None and not refined:
        return np.inf
    try:
        errors = analyse(solution).errors
    except np.linalg.LinAlgError:  # no estimate
        return np.inf
    force = solution.trajectory.at_nodes.largest("n")
    return SAFETY * (errors["m0"] + force * errors["states"])


def _worst_condition(solution: Solution, ribbon: Ribbon) -> tuple[str, float]:
    """Name and size of the condition that is furthest from what was asked."""
    names, of_loads, verdicts = ribbon.kept(_verdicts)
    count, constants = len(ribbon.states), len(ribbon.constants)
    nodes = solution.dense.at_nodes
    # Without further states, and without the lengths of phases.
    known = [
        nodes[0, :count],
        nodes[-1, :count],
        solution.constants[:constants],
        solution.dense.theta,
    ]
    if len(places := solution.posed.places):
        known.append(solution.trajectory.states(places)[:, :count].ravel())
    (values,) = verdicts(*known)
    # Relative to the loads, absolute in lengths and directors (L = 1).
    start = solution.trajectory.at_nodes
    scale = 1 + max(math.hypot(*start[name][0].tolist()) for name in ("n", "m"))
    sizes = np.abs(values) / np.where(of_loads, scale, 1.0)
    if not math.isfinite(sizes.sum()):
        sizes = np.where(np.isfinite(sizes), sizes, np.inf)
    index = int(sizes.argmax())
    return names[index], float(sizes[index])


def _verdicts(ribbon: Ribbon) -> tuple[tuple[str, ...], NDArray[np.bool_], Buffered]:
    """Names of what to verify, which are loads, and their values on numpy arrays."""
    names, function = verdicts_function(ribbon)
    loads = np.array(["force" in n or "moment" in n or "also" in n for n in names], bool)
    return names, loads, Buffered(function)


def _drifts(solution: Solution, uniform: bool) -> dict[str, float]:
    """Drifts of what is conserved; H is not where the law depends on s."""
    nodes, unknown = solution.trajectory.at_nodes, float("nan")
    drift = {"orthonormality": nodes.largest("orthonormality")}
    if solution.posed.stations:  # n steps there, and what follows from it
        return dict.fromkeys(("n", "n_dot_m", "H"), unknown) | drift
    if solution.posed.loads:
        from .conserved import conserved  # few scenes have loads

        found = {name: one.drift for name, one in conserved(solution, uniform).items()}
        return {"n": unknown, "n_dot_m": unknown, "H": unknown} | drift | found
    rows = compared(solution.trajectory)
    changes = nodes.choice.largest(np.abs(rows - rows[0]).max(axis=0))
    scale = math.hypot(*nodes["n"][0].tolist()) * nodes.largest("m")
    n, H = (_drift(changes[name], nodes.largest(name)) for name in ("n", "H"))
    n_dot_m = _drift(changes["n_dot_m"], scale)
    return {"n": n, "n_dot_m": n_dot_m, "H": H if uniform else unknown} | drift


def _drift(change: float, size: float) -> float:
    """Return a change along the ribbon, relative to the size of the quantity."""
    return change / size if size > 0 else change
