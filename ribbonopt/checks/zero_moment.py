"""Straight states of laws that are homogeneous of degree one: m2 = m3 = 0 along the ribbon.

Such a law has no derivative there (all laws but linear ones: `linear_at_zero`), so that the state
is an equilibrium without a linearisation: no error estimate, no tangent but that along which it
stays straight, no negative directions and no branch points. What the guard of the law would give
is the stiffness of the guard. Buckling loads are another matter: `ribbonopt.studies.buckling`.
"""

from __future__ import annotations

from dataclasses import replace
from functools import reduce
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.mechanics.laws.law import ConstitutiveLaw
from ribbonopt.solution.solution import Solution

ZERO = 1e-13  # of the largest load: below it a moment counts as zero
FADES = 1e-8  # the same beside an interval: a moment that small has not ended, it fades away
LEAST = 1e-12  # the same where there is no load, in units Dw = L = 1
SHORTEST = 1e-3  # of the length, that is an interval and no point (an inflection, a free end)

WORDS = (
    "m2 = m3 = 0 along {where}, where the law {law} has no linearisation: errors, stability and "
    "branch points are not known there"
)
FADED = (
    "m2 and m3 fade away into rounding along the ribbon: stability and branch points are not known"
)


class InSpace(NamedTuple):
    """The relation of a solution's ribbon, were it held in no plane."""

    law: ConstitutiveLaw


def unbent_share(solution: Solution, law: ConstitutiveLaw) -> float:
    """Share of the length along which a law without a linearisation at zero has no moment."""
    if law.linear_at_zero or law.natural or not solution.status.converged:
        return 0.0
    return share_without_moment(solution, law)


def faded_share(solution: Solution, law: ConstitutiveLaw, below: float = FADES) -> float:
    """Share of the length along which such a law has no moment, or one that fades away.

    `below` is what counts as none, of the largest load.
    """
    if law.linear_at_zero or law.natural:
        return 0.0
    free, largest = _moments(solution, law)
    return _share(solution, free <= max(below * largest, LEAST))


def unseen(solution: Solution, law: ConstitutiveLaw) -> bool:
    """Whether moments vanish in rounding along a part, so that no determinant can be trusted."""
    return faded_share(solution, law, ZERO) > 0


def share_without_moment(solution: Solution, law: ConstitutiveLaw) -> float:
    """Share of the length along which the moments of a law's free strains vanish."""
    free, largest = _moments(solution, law)
    zero = free <= max(ZERO * largest, LEAST)
    if not zero.any():
        return 0.0
    ends = np.flatnonzero(zero[1:] != zero[:-1])
    beside = np.maximum(free[ends], free[ends + 1])
    if len(ends) and beside.max() <= FADES * largest:
        return 0.0
    return _share(solution, zero)


def _moments(solution: Solution, law: ConstitutiveLaw) -> tuple[Array, float]:
    """Largest moment of a law's free strains at every stage, and the largest load of all."""
    values = solution.trajectory.at_stages
    bent = law.components[1:] if law.edgewise else law.components
    free: Array = reduce(np.maximum, (np.abs(values[f"m{i + 1}"]) for i in bent))
    return free, max(values.largest("n"), values.largest("m"))


def _share(solution: Solution, zero: NDArray[np.bool_]) -> float:
    """Share of the length of stages that are no point alone."""
    padded = np.concatenate([[False], zero, [False]])
    zero = zero & (padded[:-2] | padded[2:])
    share = float(solution.trajectory.stages[2][zero].sum())
    return share if share > SHORTEST else 0.0


def lacks_linearisation(solution: Solution) -> bool:
    """Whether nothing can be said of a solution that rests on its linearised equations."""
    return unbent_share(solution, law_of(solution)) > 0


def law_of(solution: Solution) -> ConstitutiveLaw:
    """Return the relation of a solution's scene, to be asked what it has; made once."""
    known = solution.trajectory.found
    if ConstitutiveLaw not in known:
        known[ConstitutiveLaw] = capabilities(solution.scene)
    found: ConstitutiveLaw = known[ConstitutiveLaw]
    return found


def law_in_space(solution: Solution) -> ConstitutiveLaw:
    """Return the relation of a solution's ribbon, were it held in no plane."""
    scene = solution.scene
    if scene.states != "planar":
        return law_of(solution)
    known = solution.trajectory.found
    if InSpace not in known:
        known[InSpace] = InSpace(capabilities(replace(scene, states="reduced", planar=False)))
    found: InSpace = known[InSpace]
    return found.law


def unknown_of(solution: Solution) -> list[str]:
    """Say what is not known of such a state; nothing of all others."""
    law = law_of(solution)
    share = unbent_share(solution, law)
    if not share:
        return [FADED] if unseen(solution, law) else []
    where = "the ribbon" if share > 1 - SHORTEST else f"{share:.0%} of the ribbon"
    return [WORDS.format(where=where, law=solution.scene.law.type)]


def zero_moment_problems(solution: Solution) -> list[str]:
    """Say the same with what finds out more."""
    more = "`continue` finds the loads that buckle it; `switch: true` follows the buckled ribbon"
    return [f"{words} ({more})" for words in unknown_of(solution) if words != FADED]
