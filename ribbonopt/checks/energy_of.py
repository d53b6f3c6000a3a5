"""The energy whose second variation is taken at an equilibrium, or why there is none.

Loads and laws without one, laws whose energy has no second derivatives where the solution is, and
kinks that no phases know of.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple, TypeVar

import numpy as np

from ribbonopt.mechanics.laws.catalogue import bends_alone
from ribbonopt.problem import BoundaryValueProblem, Posed, Ribbon
from ribbonopt.problem.potentials import end_without_potential, without_potential
from ribbonopt.solution.solution import Solution

from .arcs import NEGLIGIBLE, sign_changes
from .in_plane import mechanics, planar_posed, posed_in_plane
from .variation import Energy
from .zero_moment import faded_share, law_in_space, law_of, unbent_share

T = TypeVar("T")

NO_EQUILIBRIUM = "this is no equilibrium"


class Stated(NamedTuple):
    """An energy as functions, and the scene that it is of, with its numbers."""

    energy: Energy
    posed: Posed


def energy_of(solution: Solution) -> Stated | str:
    """Return the energy of a solution as functions or, in words, why there is none.

    What is built for it is kept with the equations that the solution was found by.
    """
    if not solution.status.converged:
        return NO_EQUILIBRIUM
    within = planar_posed(solution)
    name, law = solution.scene.law.type, law_of(solution) if within else law_in_space(solution)
    if not law.variational:
        return f"the law {name} has no energy"
    if law.states and law.direct() is law:
        return f"the law {name} has states of its own, which its energy here does without"
    none = f"the energy of the law {name} has no second derivatives"
    if unbent_share(solution, law):
        return f"{none} where m2 = m3 = 0"
    if faded_share(solution, law):
        return f"{none} that are known where m2 and m3 fade away"
    if not law.smooth:
        kinked = _on_the_kink(solution, law.switch_name) if law.kinked else "at its kinks"
        if kinked:
            return f"{none} {kinked}"
    posed = within or solution.posed.under(formulation="energy", states="reduced")
    ribbon = once(solution.problem.kept(_ribbons), lambda: mechanics(posed))
    # With the conditions of this very scene: whether they are zero decides.
    refused = without_potential(replace(ribbon, conditions=posed.conditions))
    if refused is not None:
        return refused.reason
    energy = once(solution.problem.kept(_energies), lambda: Energy.of(ribbon))
    return Stated(energy, posed)


def energy_in_plane(solution: Solution) -> Stated | str:
    """Return the energy of a planar scene in its plane alone or, in words, why there is none."""
    if not solution.status.converged:
        return NO_EQUILIBRIUM
    posed = posed_in_plane(solution)
    if posed is None:
        return "the scene is in no plane (planar: true), or what acts has no potential there"
    if not bends_alone(posed.scene):
        name = posed.scene.law.type
        return f"the energy of the law {name} has no second derivatives in the plane"
    refused = end_without_potential(posed.conditions)
    if refused is not None:
        return refused.reason
    return Stated(once(solution.problem.kept(_planar), lambda: Energy.of(mechanics(posed))), posed)


def _on_the_kink(solution: Solution, switch: str) -> str:
    """Say where a solution of a kinked law is not clearly on one side of it; empty if nowhere."""
    if 0 in solution.sheets:
        return f"in a mixture of both sheets, where {switch} stays zero"
    o = solution.trajectory.at_stages
    value, small = o["switching"], NEGLIGIBLE * float(np.abs(o["m"]).max())
    if solution.sheets:
        kinds = np.array(solution.sheets)[solution.trajectory.stages[3]]
        wrong = (kinds * value < -small) & (o["leap"] > 0)
        beyond = f"where it is taken beyond them, {switch} having the wrong sign"
        return beyond if wrong.any() else ""
    near = (np.abs(value) <= small) & (o["leap"] > small)
    if near.any() or len(sign_changes(solution).kinds) > 1:
        found = f"where {switch} changes its sign, and no phases meet there"
        return f"{found} (switching: auto finds them)"
    return ""


def once(store: list[T], make: Callable[[], T]) -> T:
    """Return what is in store; made where there is nothing."""
    if not store:
        store.append(make())
    return store[0]


def _ribbons(problem: BoundaryValueProblem) -> list[Ribbon]:
    """Return the place where a problem keeps the mechanics of its energy."""
    return []


def _energies(problem: BoundaryValueProblem) -> list[Energy]:
    """Return the place where a problem keeps what is built of its energy."""
    return []


def _planar(problem: BoundaryValueProblem) -> list[Energy]:
    """Return the place where a problem keeps what is built of its energy in its plane."""
    return []
