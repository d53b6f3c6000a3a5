"""Stability: negative directions of the second variation of the energy, from any equilibrium.

Of all shapes that satisfy the conditions on positions and directors, an equilibrium is one where
the energy, less the work of dead forces, is stationary; it is stable where it is a minimum. The
second variation (`variation`) is a quadratic form along the ribbon, whose inertia elimination tells
(`elimination`). Of a piece of a ribbon only disturbances with its symmetry are judged.
"""

from __future__ import annotations

from ribbonopt.accuracy.spin import SPIN, spins
from ribbonopt.classes import dataclass
from ribbonopt.solution.solution import Solution

from .elimination import factored
from .energy_of import NO_EQUILIBRIUM, energy_in_plane, energy_of
from .in_plane import planar_posed
from .variation import Variation

# Neutral directions (a loop that slides along itself) have eigenvalues of the order of the error.
ROUNDING = 1e-9  # of the largest eigenvalue: error of the others, at least,
MOST = 1e-2  # and at most
LARGEST = 1e12  # compliance, units Dw = L = 1: a stage is where the law is singular
SINGULAR = "the law is singular where the ribbon is all but straight"


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
    stated = energy_in_plane(solution)
    if isinstance(stated, str):
        return None
    found = stated.energy.variation(solution, stated.posed.values)
    if not found.error < MOST:
        return None
    neutral = max(found.error, ROUNDING) * found.largest
    return factored(found.form, neutral).negative


def variation_of(solution: Solution) -> Variation | str:
    """Return the second variation as a quadratic form or, in words, why there is none."""
    stated = energy_of(solution)
    if isinstance(stated, str):
        return stated
    found = stated.energy.variation(solution, stated.posed.values)
    return useless(found) or found


def useless(found: Variation) -> str:
    """Say why a second variation tells nothing; empty where it does."""
    if not found.largest < LARGEST:
        # A stage is all but where m2 and m3 vanish: what is counted there is rounding.
        return SINGULAR
    if found.error < MOST:
        return ""
    if found.residual < found.stages.error:
        return f"the shape is known to {found.stages.error:.1e} only: the mesh is too coarse"
    return (
        f"the energy is not stationary (the part {found.residual:.1e} of its gradient is left): "
        "loads that are prescribed do work, or the mesh is too coarse"
    )
