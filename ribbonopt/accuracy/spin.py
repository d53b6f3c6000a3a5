"""The spin of an isotropic rod: a neutral direction that many ends do not oppose.

A rod that is the same about all axes across d3 has the energy it has, whatever constant angle its
sections are turned by about d3. Between two clamps on one axis, or where a ring is cut, that angle
and a turn of the whole about the axis go together: the bent rod turns about its clamp's tangent, at
no cost. The answer then is one of a family, and the equations are singular: bars are those of the
member of it that was found.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.mechanics.rotations import product
from ribbonopt.problem import BoundaryValueProblem, Ribbon
from ribbonopt.problem.wellposed.linearized import Linearized, linearize
from ribbonopt.problem.wellposed.motions import allowed_motions, rigid, unopposed
from ribbonopt.solution.solution import Solution

SPIN = "the rod, isotropic, turns about the tangent of its clamp"
STRAIGHT = 1e-6  # angle of the tangents: a straight rod that turns about itself stays what it is
PART = 1e-6  # of the spin in a motion


class Spin(NamedTuple):
    """Whether a solution's rod spins freely."""

    free: bool


def spins(solution: Solution) -> bool:
    """Whether nothing opposes that a bent rod turns about its clamp's tangent, sections with it.

    Known of what is solved in space, without loads or supports at points of it; in a plane nothing
    spins.
    """
    known = solution.trajectory.found
    if Spin not in known:
        known[Spin] = Spin(_spins(solution))
    return bool(known[Spin].free)


def _spins(solution: Solution) -> bool:
    if not solution.status.converged or solution.scene.states == "planar":
        return False
    square, may = solution.problem.square, solution.problem.neutral
    if (square and not may) or not capabilities(solution.posed.scene).spins:
        return False
    tangents = solution.trajectory.at_nodes["d3"]
    if np.linalg.norm(tangents - tangents[0], axis=1).max() < STRAIGHT:
        return False
    if solution.posed.stations or any(not load.dead for load in solution.posed.loads):
        return False
    posed = solution.posed.under(formulation="inverted", states="reduced")
    kept = solution.problem.kept(_conditions)
    if not kept:
        kept.append(linearize(Ribbon.of(posed), posed))
    conditions = replace(kept[0], posed=posed)
    ends = solution.fields(np.array([0.0, 1.0]))
    (first, last), c = conditions.ribbon.model.pack(ends, conditions.reference)
    z = np.concatenate([first, last, c])
    spin = np.zeros((len(z), 1))
    for at in (0, conditions.nx):
        q = z[at + 3 : at + 7]
        spin[at + 3 : at + 7, 0] = np.array(product(q, (0.0, 0.0, 0.0, 1.0))) / 2
    motions = np.hstack([rigid(conditions, z) @ allowed_motions(conditions), spin])
    free = unopposed(conditions, z, motions)
    return bool(free.size and np.abs(free[-1]).max() > PART * np.abs(free).max())


def _conditions(problem: BoundaryValueProblem) -> list[Linearized]:
    """Return the place where a problem keeps its conditions, linearised."""
    return []


def spin_problems(solution: Solution) -> list[str]:
    """Say that an answer is one of a family, of which nothing tells which."""
    if not spins(solution):
        return []
    return [
        f"{SPIN} at no cost: the answer is one of a family, turned as the solver left it (a half, "
        "held by `support: flip` on an axis of its symmetry, is determined)"
    ]
