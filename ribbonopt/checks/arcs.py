"""Arcs of a solution between the points where m2 changes sign, and arcs on which it stays zero.

A smooth law crosses m2 = 0 in a layer of width delta; on a mixture (the relaxed arcs of section 4)
it stays near zero with |eta| > 1 however small delta is.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.problem import Ribbon
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription.buffered import Mapped

NEGLIGIBLE = 1e-7  # m2 over the largest |m| that has no sign
FAINT, SEEN = 1e-5, 10.0  # (m2, m3) over the largest |m|, and over the tolerance: is not seen
BEYOND = 1.05  # |eta| of a mixture
SHORTEST = 0.01  # of an arc of a mixture, and of the phase before one that begins at an end


@dataclass(frozen=True, eq=False)
class Arcs:
    """Kinds of the phases (+1, -1: sign of m2; 0: mixture) and fractions where they meet."""

    kinds: tuple[int, ...]
    switches: Array


def sign_changes(solution: Solution) -> Arcs:
    """Return the arcs between sign changes of the law's switch, as far as the stages can tell.

    Where nothing leaps there (a planar ribbon) the law is smooth: such changes do not count.
    """
    o, f = solution.at_stages, solution.trajectory.stages[1]
    value, leap, scale = o["switching"], o["leap"], _scale(solution)
    size = np.abs(value) > NEGLIGIBLE * scale
    # In the tail of a layer, which mesh and rounding may let change sign, nothing can be told.
    size &= np.maximum(np.abs(value), leap) > _faint(solution) * scale
    f, value, leap = f[size], value[size], leap[size]
    if not len(value):
        return Arcs((1,), np.empty(0))
    signs = np.sign(value).astype(int)
    leaps = leap > NEGLIGIBLE * scale
    at = np.flatnonzero((signs[1:] != signs[:-1]) & (leaps[1:] | leaps[:-1]))
    # Between the two points the function is straight, to the accuracy of a first guess.
    switches = f[at] + (f[at + 1] - f[at]) * value[at] / (value[at] - value[at + 1])
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
    f, eta = solution.trajectory.stages[1], solution.at_stages["eta"]
    beyond = np.concatenate([[False], np.abs(eta) > BEYOND, [False]])
    edges = np.flatnonzero(beyond[1:] != beyond[:-1])
    return [(f[a], f[b - 1]) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _faint(solution: Solution) -> float:
    """Return (m2, m3), over the largest |m|, of a tail that does not show in the answer."""
    tolerance = solution.posed.scene.tolerance
    return NEGLIGIBLE if tolerance is None else float(np.clip(SEEN * tolerance, NEGLIGIBLE, FAINT))


def _scale(solution: Solution) -> float:
    return float(np.abs(solution.at_stages["m"]).max())


def phase_problems(solution: Solution, ribbon: Ribbon) -> list[str]:
    """Say where a solution in phases is not one of the law: wrong side of its switch, no mixture.

    Margins of a law are compared in units Dw = L = 1.
    """
    problems = []
    v, fraction, _, phase = solution.trajectory.stages
    nodes, theta = v[:, : len(ribbon.states)], solution.dense.theta
    tolerance = 1e-6 * float(np.abs(solution.trajectory.at_stages["m"]).max())
    s = solution.posed.scene.interval[0] + solution.posed.length * fraction
    start, end = solution.scene.interval
    ends = start + (end - start) * solution.trajectory.ends
    constants = solution.constants[: len(ribbon.constants)]
    for i, kind in enumerate(solution.sheets):
        rows = phase == i
        where = f"between s = {ends[i]:.4g} and {ends[i + 1]:.4g}"
        names, margins = ribbon.kept(_margins)[kind]
        (values,) = margins(nodes[rows], constants, theta, s[rows])
        least = values.reshape(-1, len(names)).min(axis=0)
        short = zip(names, least, strict=True)
        problems += [name.format(where=where) for name, value in short if value < -tolerance]
    return problems


def _margins(ribbon: Ribbon) -> dict[int, tuple[tuple[str, ...], Mapped]]:
    """Names of the margins of every kind of phase, and their values at stages."""
    found = {kind: ribbon.margins_function(kind) for kind in (-1, 0, 1)}
    return {kind: (names, Mapped(function)) for kind, (names, function) in found.items()}
