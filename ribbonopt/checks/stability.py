"""Stability: negative directions of the second variation of the energy, from any equilibrium.

Of all shapes that satisfy the conditions on positions and directors, an equilibrium is one where
the energy, less the work of dead forces, is stationary; it is stable where it is a minimum. The
second variation (`variation`) is a quadratic form along the ribbon, whose inertia elimination tells
(`elimination`). Of a piece of a ribbon only disturbances with its symmetry are judged.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np

from ribbonopt.accuracy.spin import SPIN, spins
from ribbonopt.classes import dataclass
from ribbonopt.mechanics.laws.catalogue import bends_alone
from ribbonopt.problem import BoundaryValueProblem, Ribbon
from ribbonopt.problem.potentials import without_potential
from ribbonopt.solution.solution import Solution

from .arcs import NEGLIGIBLE, sign_changes
from .elimination import factored
from .in_plane import mechanics, planar_posed, posed_in_plane
from .variation import Energy, Variation
from .zero_moment import faded_share, law_in_space, law_of, unbent_share

T = TypeVar("T")

# Neutral directions (a loop that slides along itself) have eigenvalues of the order of the error.
ROUNDING = 1e-9  # of the largest eigenvalue: error of the others, at least,
MOST = 1e-2  # and at most

NO_EQUILIBRIUM = "this is no equilibrium"


@dataclass(frozen=True, eq=False)
class SecondVariation:
    """Second variation of the energy on the directions that keep the conditions.

    `negative` is the number of its clearly negative eigenvalues, those below -`neutral`. `error` is
    that of eigenvalues, over the largest, which is about `largest`. Units Dw = L = 1. `spins` says
    that one is zero since an isotropic rod spins, which is neither for nor against it; `planar`
    that only directions in the ribbon's plane were looked at, `symmetric` that only those with the
    symmetry of which a piece is solved. `in_plane` is how many are in the plane of an unstable
    ribbon that is held there; None where it is not known.
    """

    negative: int
    neutral: float
    error: float
    largest: float
    spins: bool = False
    planar: bool = False
    in_plane: int | None = None
    symmetric: bool = False

    @property
    def verdict(self) -> str:
        """What it says, in words."""
        where = " in its plane" if self.planar else ""
        found = stability_in_words(self.negative, where)
        if self.in_plane is not None:
            found = (
                f"{found}, {self.in_plane} of them in its plane"
                if self.in_plane
                else f"stable in its plane, {stability_in_words(self.negative, ' in space')}"
            )
        found += " among disturbances with its symmetry" if self.symmetric else ""
        return f"{found}; neutral: {SPIN}" if self.spins else found


def stability_in_words(negative: int, where: str = "") -> str:
    """Say in users' words what a count of negative directions means, such as "in its plane"."""
    if not negative:
        return f"stable{where}"
    return f"unstable{where}, {negative} direction{'s' if negative > 1 else ''}"


def negative_directions(solution: Solution) -> int | None:
    """Negative directions of the energy, 0 where stable; None where `why_not` says why."""
    found = second_variation(solution)
    return None if isinstance(found, str) else found.negative


def negative_within_plane(solution: Solution) -> int | None:
    """Negative directions in the plane of a ribbon that is held in one; None of any other."""
    found = second_variation(solution)
    if isinstance(found, str) or solution.scene.states != "planar":
        return None
    return found.negative if found.planar or not found.negative else found.in_plane


def negative_range(solution: Solution) -> tuple[int, int] | None:
    """Least and largest number of negative directions, neutral ones counted or not; None so too."""
    found, variation = second_variation(solution), variation_of(solution)
    if isinstance(found, str) or isinstance(variation, str):
        return None
    most = factored(variation.form, -found.neutral).negative - found.spins
    return found.negative, max(found.negative, most)


def why_not(solution: Solution) -> str:
    """Say why there is no second variation; empty where there is one."""
    found = second_variation(solution)
    return found if isinstance(found, str) else ""


def told_of_plane(solution: Solution) -> str:
    """Say what the count of negative directions means of a ribbon that is held in a plane.

    Empty where there is none, in space, or where it is stable in space.
    """
    found = second_variation(solution)
    if isinstance(found, str):
        return ""
    if found.planar:
        return "directions across the plane are not counted, where the loads have no potential"
    return "" if found.in_plane is None else found.verdict


def second_variation(solution: Solution) -> SecondVariation | str:
    """Return the second variation of the energy or, in words, why there is none.

    What is built for it is kept with the equations that the solution was found by.
    """
    if not solution.status.converged:
        return NO_EQUILIBRIUM
    known = solution.trajectory.found
    if SecondVariation not in known:
        known[SecondVariation] = _judged(variation_of(solution), solution)
    found: SecondVariation | str = known[SecondVariation]
    return found


def _judged(variation: Variation | str, solution: Solution) -> SecondVariation | str:
    if isinstance(variation, str):
        return variation
    largest, error = variation.largest, variation.error
    neutral = max(error, ROUNDING) * largest
    negative = factored(variation.form, neutral).negative
    planar = planar_posed(solution) is not None
    inside = None if planar or not negative else _negative_in_plane(solution)
    symmetric = solution.scene.boundary.repeats
    parts = negative, neutral, error, largest, spins(solution), planar
    return SecondVariation(*parts, inside, symmetric)


def _negative_in_plane(solution: Solution) -> int | None:
    """Negative directions in the plane of a ribbon that is held there; None where not known."""
    posed = posed_in_plane(solution)
    if posed is None or not bends_alone(posed.scene):
        return None
    energy = _once(solution.problem.kept(_planar), lambda: Energy.of(mechanics(posed)))
    found = energy.variation(solution, posed.values)
    if not found.error < MOST:
        return None
    neutral = max(found.error, ROUNDING) * found.largest
    return factored(found.form, neutral).negative


def variation_of(solution: Solution) -> Variation | str:
    """Return the second variation as a quadratic form or, in words, why there is none."""
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
    ribbon = _once(solution.problem.kept(_ribbons), lambda: mechanics(posed))
    # With the conditions of this very scene: whether they are zero decides.
    refused = without_potential(replace(ribbon, conditions=posed.conditions))
    if refused is not None:
        return refused.reason
    energy = _once(solution.problem.kept(_energies), lambda: Energy.of(ribbon))
    found = energy.variation(solution, posed.values)
    if found.error < MOST:
        return found
    if found.residual < found.stages.error:
        return f"the shape is known to {found.stages.error:.1e} only: the mesh is too coarse"
    return (
        f"the energy is not stationary (the part {found.residual:.1e} of its gradient is left): "
        "loads that are prescribed do work, or the mesh is too coarse"
    )


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


def _once(store: list[T], make: Callable[[], T]) -> T:
    """Return what is in store; made where there is nothing."""
    if not store:
        store.append(make())
    return store[0]


def _ribbons(problem: BoundaryValueProblem) -> list[Ribbon]:
    """Return the place where a problem keeps the mechanics of its energy."""
    return []


def _planar(problem: BoundaryValueProblem) -> list[Energy]:
    """Return the place where a problem keeps what is built of its energy in its plane."""
    return []


def _energies(problem: BoundaryValueProblem) -> list[Energy]:
    """Return the place where a problem keeps what is built of its energy."""
    return []
