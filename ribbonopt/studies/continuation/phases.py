"""How near a ribbon is to a change of its phases, as numbers that are smooth along a branch.

In each phase the law is that of one side of its switch, continued beyond it; so a branch can be
followed a little past the point where its phases stop being the right ones. What says so is a
margin, which is positive before and negative behind: the switch at an end of the ribbon, the switch
where it is nearest to zero inside a phase, its slope where it changes sign, the length of a phase.
"""

from __future__ import annotations

from enum import Enum
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.checks.arcs import NEGLIGIBLE
from ribbonopt.checks.phase_words import phase_words, switch_of
from ribbonopt.mechanics.laws.catalogue import capabilities
from ribbonopt.mechanics.outputs import SLOPE, sheet_slopes
from ribbonopt.problem.pieces import stations_among
from ribbonopt.solution.solution import Solution

EMPTY = 1e-6  # of the length: at its ends the switch of such a phase says no more than that
NEAR = 0.3  # of the largest value in a phase: a minimum above that is no touch to come
BEFORE, BESIDE = 1e-9, 1e-5  # of a phase, where it ends; of the length, for slopes there
ROUNDS = 12  # of the search for a minimum


class What(Enum):
    """What happens to a phase."""

    BORN_AT_START = "a phase is born at the start"
    BORN_AT_END = "a phase is born at the end"
    BORN_INSIDE = "a phase is born inside"
    BORN_BETWEEN = "a mixture is born at the end"
    LEFT = "the mixture is one no more at some place"
    GONE_AT_START = "the first phase has no length left"
    GONE_AT_END = "the last phase has no length left"
    GONE_INSIDE = "a phase inside has no length left"


class Change(NamedTuple):
    """A change of phases, and the phase whose margin tells it."""

    what: What
    phase: int

    def told(self, solution: Solution) -> str:
        """Say it in words, for the phases of a solution."""
        kinds = phase_words(solution.sheets, switch_of(solution.scene))
        return f"{self.what.value} (of phase {self.phase + 1} among: {kinds})"


def margins(solution: Solution) -> dict[Change, float]:
    """Return the margins of a solution in phases, relative to its largest moment or its length."""
    kinds, found = solution.sheets, {}
    last, lengths = len(kinds) - 1, np.diff(solution.trajectory.ends)
    stations = stations_among(kinds, len(solution.posed.stations))
    mixes = not capabilities(
        solution.scene
    ).fades  # strains that fade away are those of no two sides
    for i, kind in enumerate(kinds):
        # What is gone beside a station is born behind it: a trial in these phases fails there, and
        # the search for others begins anew.
        if last and _may_go(kinds, i) and not {i, i + 1} & set(stations):
            ends = {0: What.GONE_AT_START, last: What.GONE_AT_END}
            found[Change(ends.get(i, What.GONE_INSIDE), i)] = float(lengths[i])
        if kind == 0:
            found[Change(What.LEFT, i)] = min(share for _, share, _ in spares(solution, i))
            continue
        sigma, value = profile(solution, i)
        if i == 0 and (not last or lengths[i] > EMPTY):
            found[Change(What.BORN_AT_START, i)] = float(value[0])
        if i == last and (not last or lengths[i] > EMPTY):
            found[Change(What.BORN_AT_END, i)] = float(value[-1])
        lowest = [value for _, value in minima(solution, i, sigma, value)]
        if lowest:
            found[Change(What.BORN_INSIDE, i)] = min(lowest)
        if mixes and i < last and kinds[i + 1] and i + 1 not in stations:
            found[Change(What.BORN_BETWEEN, i)] = kinds[i + 1] * _slope_at_end(solution, i)
    return found


def profile(solution: Solution, phase: int) -> tuple[Array, Array]:
    """Return positions in a phase (k,), 0 to 1, and there the switch times the phase's kind."""
    sigma, (value,) = _along(solution, phase, "switching")
    return sigma, value * solution.sheets[phase] / moment(solution)


def minima(solution: Solution, phase: int, sigma: Array, value: Array) -> list[tuple[float, float]]:
    """Return the low minima inside a phase: where, and the value, from its profile."""
    low = NEAR * float(np.abs(value).max())
    inner = (value[1:-1] <= value[:-2]) & (value[1:-1] < value[2:]) & (value[1:-1] < low)
    return [
        _lowest(solution, phase, *sigma[[j, j + 1, j + 2]], *value[[j, j + 1, j + 2]])
        for j in np.flatnonzero(inner)
    ]


def spares(solution: Solution, phase: int) -> list[tuple[float, float, int]]:
    """Return what a mixture has to spare where that is least: at either end, or inside.

    Position in the phase, 0 to 1; by how much |u2| = 2 |n2 u3 / K| is below |u3|, relative to that
    (see `ribbonopt.mechanics.laws.mixture.MixtureLaw`); sign of u2.
    """
    sigma, (n2, n3, m1, m3) = _along(solution, phase, "n2", "n3", "m1", "m3")
    ratio = 2 * n2 / (n3 + (m3**2 - m1**2) / 4)
    share, signs = 1 - np.abs(ratio), np.sign(ratio * m3).astype(int)
    if solution.scene.natural is not None:
        share, signs = _natural_spares(solution, phase, sigma)
    lowest = 1 + np.flatnonzero((share[1:-1] <= share[:-2]) & (share[1:-1] < share[2:]))
    return [(float(sigma[j]), float(share[j]), int(signs[j])) for j in (0, *lowest, -1)]


def _natural_spares(solution: Solution, phase: int, sigma: Array) -> tuple[Array, NDArray[np.intp]]:
    """Return the same of a ribbon with natural strains, by how its law says it."""
    trajectory = solution.trajectory
    a, b = trajectory.ends[phase : phase + 2]
    o = trajectory.outputs(a + (b - a) * np.minimum(sigma, 1 - BEFORE))
    sign = np.sign(o[SLOPE] if SLOPE in o else o["u2"]).astype(int)
    return 1 - 1 / np.maximum(sheet_slopes(o), NEGLIGIBLE), sign


def _along(solution: Solution, phase: int, *names: str) -> tuple[Array, list[Array]]:
    """Return positions (k,) of nodes and stages in a phase, 0 to 1, and outputs."""
    dense, trajectory = solution.dense, solution.trajectory
    s = dense.blocks.layout.phase_slices[phase]
    rows = trajectory.stages[3] == phase
    _, inner, _ = dense.stages(phase)
    places = np.concatenate([dense.nodes(phase), inner])
    order = np.argsort(places, kind="stable")
    values = [
        np.concatenate([trajectory.at_nodes[name][s.start : s.stop + 1], at[rows]])[order]
        for name, at in ((name, trajectory.at_stages[name]) for name in names)
    ]
    return places[order], values


def _slope_at_end(solution: Solution, phase: int) -> float:
    """Return the slope of the switch m2 at the end of a phase, over moment and length.

    m2' = -n1 - u3 m1 by eqs. (2.2) and (2.7): exact there, as slopes of polynomials are not.
    With natural strains the switch is more than m2 by what depends on s alone.
    """
    nodes, trajectory = solution.trajectory.at_nodes, solution.trajectory
    at = solution.dense.blocks.layout.phase_slices[phase].stop
    n1, m1, u3 = (float(nodes[name][at]) for name in ("n1", "m1", "u3"))
    found = -(n1 + u3 * m1) * trajectory.length
    if solution.scene.natural is not None:
        place = trajectory.ends[phase + 1]
        both = np.clip([place - BESIDE, place + BESIDE], 0.0, 1.0)
        o = trajectory.outputs(both)
        natural = o["switching"] - o["m2"]
        found += float((natural[1] - natural[0]) / (both[1] - both[0]))
    return found / moment(solution)


def moment(solution: Solution) -> float:
    """Largest component of the moment along a solution, units Dw = L = 1."""
    return float(np.abs(solution.trajectory.at_nodes["m"]).max())


def one_sign(solution: Solution) -> int:
    """Return the sign that the law's switch has all along a solution; 0 if it changes."""
    trajectory, least = solution.trajectory, NEGLIGIBLE * moment(solution)
    both = (trajectory.at_nodes["switching"], trajectory.at_stages["switching"])
    below, above = (min(v.min() for v in both) < -least, max(v.max() for v in both) > least)
    return int(above) - int(below)


def orientation(kinds: tuple[int, ...]) -> float:
    """Return the sign by which phases change that of the determinant of the equations.

    The length of a phase is an unknown and the zero of the switch at its end a condition, whose
    derivative by that length has the sign of the phase that follows. Without these factors the
    determinant is that of a ribbon whose phases end where they must: the same in any phases. A
    mixture that is born where the switch touches zero makes no difference, but one between two
    sides of the law takes the place of a condition of either sign.
    """
    pairs = pairwise(kinds)
    switches = ((a, b) for a, b in pairs if a and b and a != b)  # two of one kind meet at stations
    sign = float(np.prod([after for _, after in switches]))
    around = zip(kinds[:-2], kinds[1:-1], kinds[2:], strict=True)
    return sign * float(np.prod([a * b for a, mixture, b in around if not mixture]))


def _may_go(kinds: tuple[int, ...], i: int) -> bool:
    """Whether the phases around one can meet; those at an end are none of mixtures."""
    around = kinds[max(i - 1, 0) : i] + kinds[i + 1 : i + 2]
    return len(around) == 2 or 0 not in (*around, kinds[i])


def _lowest(
    solution: Solution, phase: int, a: float, b: float, c: float, fa: float, fb: float, fc: float
) -> tuple[float, float]:
    """Return the minimum between a < b < c by parabolas through the nearest three places."""
    sheet, scale = solution.sheets[phase], moment(solution)
    ends = solution.trajectory.ends[phase : phase + 2]
    for _ in range(ROUNDS):
        bend = ((fc - fb) / (c - b) - (fb - fa) / (b - a)) / (c - a)
        if not bend > 0:
            break
        place = (a + b) / 2 - (fb - fa) / (b - a) / bend / 2
        if not a < place < c or abs(place - b) <= 1e-9 * (c - a):
            break
        at = np.array([ends[0] + (ends[1] - ends[0]) * place])
        f = float(solution.trajectory.outputs(at)["switching"][0]) * sheet / scale
        if f > fb:
            break
        left = place < b
        a, fa, c, fc = (a, fa, b, fb) if left else (b, fb, c, fc)
        b, fb = place, f
    return float(b), float(fb)
