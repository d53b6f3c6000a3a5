"""Arcs of a solution between the points where m2 changes sign, and arcs on which it stays zero.

A smooth law crosses m2 = 0 in a layer of width delta; on a mixture (the relaxed arcs of section 4)
it stays near zero with |eta| > 1 however small delta is.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution

NEGLIGIBLE = 1e-7  # m2 over the largest |m| that has no sign
BEYOND = 1.05  # |eta| of a mixture
SHORTEST = 0.01  # of an arc of a mixture, and of the phase before one that begins at an end


@dataclass(frozen=True, eq=False)
class Arcs:
    """Kinds of the phases (+1, -1: sign of m2; 0: mixture) and fractions where they meet."""

    kinds: tuple[int, ...]
    switches: Array


def sign_changes(solution: Solution) -> Arcs:
    """Return the arcs between sign changes of m2, as far as the stages can tell.

    Where m3 vanishes too (a planar ribbon) the law is smooth: such changes do not count.
    """
    f, m2, m3, _ = _sampled(solution)
    scale = _scale(solution)
    size = np.abs(m2) > NEGLIGIBLE * scale
    f, m2, m3 = f[size], m2[size], m3[size]
    if not len(m2):
        return Arcs((1,), np.empty(0))
    signs = np.sign(m2).astype(int)
    twisted = np.abs(m3) > NEGLIGIBLE * scale
    at = np.flatnonzero((signs[1:] != signs[:-1]) & (twisted[1:] | twisted[:-1]))
    # Between the two points m2 is straight, to the accuracy of a first guess.
    switches = f[at] + (f[at + 1] - f[at]) * m2[at] / (m2[at] - m2[at + 1])
    kinds = (int(signs[0]), *(int(signs[i + 1]) for i in at))
    return Arcs(kinds, switches)


def with_mixtures(sharp: Solution, blunt: Solution) -> Arcs:
    """Return the arcs of a smooth law, mixtures among them.

    `sharp` and `blunt` are its solutions at a small delta and at three times that: a layer shrinks
    from one to the other, a mixture does not.
    """
    found = _beyond(sharp)
    before = _beyond(blunt)
    mixtures = []
    for a, b in found:
        overlap = [(c, d) for c, d in before if c < b and d > a]
        width = sum(d - c for c, d in overlap)
        if b - a > max(SHORTEST, 0.6 * width):
            mixtures.append((max(a, SHORTEST), min(b, 1 - SHORTEST)))
    if not mixtures:
        return sign_changes(sharp)
    return _interleaved(sign_changes(sharp), mixtures)


def _interleaved(arcs: Arcs, mixtures: list[tuple[float, float]]) -> Arcs:
    """Cut the mixtures out of the arcs of one sign."""
    cuts = np.unique(np.concatenate([[0.0], arcs.switches, [1.0], *mixtures]))
    kinds: list[int] = []
    switches: list[float] = []
    for a, b in pairwise(cuts):
        middle = (a + b) / 2
        mixed = any(c < middle < d for c, d in mixtures)
        kind = 0 if mixed else arcs.kinds[int(np.searchsorted(arcs.switches, middle))]
        if kinds and kind == kinds[-1]:
            continue
        if kinds:
            switches.append(float(a))
        kinds.append(kind)
    return Arcs(tuple(kinds), np.array(switches))


def _beyond(solution: Solution) -> list[tuple[float, float]]:
    """Fractions between which |eta| is beyond that of one sheet."""
    f, _, _, eta = _sampled(solution)
    beyond = np.concatenate([[False], np.abs(eta) > BEYOND, [False]])
    edges = np.flatnonzero(beyond[1:] != beyond[:-1])
    return [(f[a], f[b - 1]) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _sampled(solution: Solution) -> tuple[Array, Array, Array, Array]:
    """Fractions, m2, m3 and eta at the stages."""
    o = solution.at_stages
    return solution.trajectory.stages[1], o["m2"], o["m3"], o["eta"]


def _scale(solution: Solution) -> float:
    return float(np.abs(solution.at_stages["m"]).max())


def phase_problems(solution: Solution) -> list[str]:
    """Say where a solution in phases is not one of the law: wrong sign of m2, or no mixture."""
    problems = []
    phase, units = solution.trajectory.stages[3], solution.units
    # In units Dw = L = 1, in which forces, squares of moments and strains can be compared.
    stages = {name: value / units.of(name) for name, value in solution.at_stages.items()}
    tolerance = 1e-6 * float(np.abs(stages["m"]).max())
    start, end = solution.scene.interval
    ends = start + (end - start) * solution.trajectory.ends
    for i, kind in enumerate(solution.sheets):
        rows = phase == i
        where = f"between s = {ends[i]:.4g} and {ends[i + 1]:.4g}"
        if kind and (kind * stages["m2"][rows] < -tolerance).any():
            problems.append(f"m2 has the wrong sign {where}: no equilibrium of Sadowsky's ribbon")
        if not kind:
            n3, m1, m3 = (stages[name][rows] for name in ("n3", "m1", "m3"))
            if (n3 + m3**2 / 4 - m1**2 / 4 < -tolerance).any():
                problems.append(f"the mixture {where} is unstable: K < 0")
            if (np.abs(stages["u2"][rows]) > np.abs(stages["u3"][rows]) + tolerance).any():
                problems.append(f"|u2| > |u3| {where}: not a mixture")
    return problems
