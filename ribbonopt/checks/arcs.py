"""Arcs of a solution between the points where m2 changes sign, and arcs on which it stays zero.

A smooth law crosses m2 = 0 in a layer of width delta; on a mixture (the relaxed arcs of section 4)
it stays near zero with |eta| > 1 however small delta is.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.guess import Guess
from ribbonopt.guess.balanced import Balanced
from ribbonopt.guess.named import ShapeGuess
from ribbonopt.mechanics.outputs import sheet_slopes
from ribbonopt.scene import Scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solution.trajectory import Trajectory

NEGLIGIBLE = 1e-7  # m2 over the largest |m| that has no sign
FAINT, SEEN = 1e-5, 10.0  # (m2, m3) over the largest |m|, and over the tolerance: is not seen
BEYOND = 1.05  # |eta| of a mixture
ROUNDED = 1e-12  # of the largest moment
EMPTY = 1e-5  # of the length of the ribbon: a phase that may not be there
SHORTEST = 0.01  # of an arc of a mixture, and of the phase before one that begins at an end


@dataclass(frozen=True, eq=False)
class Arcs:
    """Kinds of phases (+1, -1: sign of the switch; 0: mixture) and fractions where they meet."""

    kinds: tuple[int, ...]
    switches: Array


class Signs(NamedTuple):
    """Arcs of a solution by how faint tails may be, and whether every change of sign counts."""

    known: dict[tuple[float, bool], Arcs]


MIXTURE = Arcs((0,), np.empty(0))  # from end to end


def arcs_of(solution: Solution) -> Arcs:
    """Return the arcs of a solution in phases; those that meet at a single place count as one."""
    turns = solution.trajectory.turns
    kinds = (solution.sheets[0], *(solution.sheets[i] for i in turns))
    return Arcs(kinds, solution.trajectory.ends[list(turns)])


def cut_at(arcs: Arcs, places: Array) -> Arcs:
    """Return arcs that also end at fractions (k,) of the length, where something acts or holds."""
    ends = np.sort(np.concatenate([arcs.switches, places]))
    middles = (np.append(0.0, ends) + np.append(ends, 1.0)) / 2
    kinds = np.array(arcs.kinds)[np.searchsorted(arcs.switches, middles)]
    return Arcs(tuple(kinds.tolist()), ends)


def is_mixture(guess: Guess) -> bool:
    """Whether a guess is a shape with twist and no m2 from end to end."""
    if not isinstance(guess, ShapeGuess | Balanced):
        return False
    fields = guess.fields(np.linspace(0.0, 1.0, 9))
    _, m2, m3 = np.abs(np.einsum("ki,kij->jk", fields.m, fields.frames))
    return bool(m2.max() <= NEGLIGIBLE * m3.min() and m3.min() > 0)


def sign_changes(solution: Solution, every: bool = False) -> Arcs:
    """Return the arcs between sign changes of the law's switch, as stages and ends tell.

    Where nothing leaps there (a planar ribbon) the law is smooth: such changes do not count, unless
    `every` one is asked for.
    """
    asked = _faint(solution), every
    known = solution.trajectory.found.setdefault(Signs, Signs({})).known
    if asked not in known:
        known[asked] = _sign_changes(solution.trajectory, *asked)
    found: Arcs = known[asked]
    return found


def _sign_changes(trajectory: Trajectory, faint: float, every: bool) -> Arcs:
    """Return the same; in tails as `faint` as that nothing can be told."""
    o, ends = trajectory.at_stages, trajectory.at_nodes
    scale, inside, at_ends = o.largest("m"), o["switching"], ends["switching"]
    lowest = min(float(inside.min()), float(at_ends[0]), float(at_ends[-1]))
    highest = max(float(inside.max()), float(at_ends[0]), float(at_ends[-1]))
    least = NEGLIGIBLE * scale
    if max(-lowest, highest) > max(NEGLIGIBLE, faint) * scale and min(-lowest, highest) <= least:
        return Arcs((1 if highest > -lowest else -1,), np.empty(0))  # one sign, but for rounding
    value, leap = (
        np.concatenate([ends[name][:1], o[name], ends[name][-1:]]) for name in ("switching", "leap")
    )
    f = np.concatenate([[0.0], trajectory.stages[1], [1.0]])
    size = np.abs(value) > NEGLIGIBLE * scale
    # In the tail of a layer, which mesh and rounding may let change sign, nothing can be told.
    size &= np.maximum(np.abs(value), leap) > faint * scale
    f, value, leap = f[size], value[size], leap[size]
    if not len(value):
        return Arcs((1,), np.empty(0))
    signs = np.sign(value).astype(int)
    leaps = leap > NEGLIGIBLE * scale
    changes = np.flatnonzero(signs[1:] != signs[:-1])
    at = changes if every else _counted(signs, changes, leaps[changes] | leaps[changes + 1])
    # Between the two points the function is straight, to the accuracy of a first guess.
    switches = f[at] + (f[at + 1] - f[at]) * value[at] / (value[at] - value[at + 1])
    first = signs[at[0]] if len(at) else signs[0]
    kinds = (int(first), *(int(signs[i + 1]) for i in at))
    return Arcs(kinds, switches)


def _counted(
    signs: NDArray[np.intp], changes: NDArray[np.intp], leaping: NDArray[np.bool_]
) -> NDArray[np.intp]:
    """Return the changes at which something leaps, and what else is needed between these.

    The law of a phase has one sign where it begins and where it ends: between leaps from which it
    would have both, one change without a leap counts too.
    """
    found: list[int] = []
    for i, leaps in zip(changes, leaping, strict=True):
        if not leaps:
            continue
        if found and signs[found[-1] + 1] != signs[i]:
            found.append(int(next(c for c in changes if c > found[-1])))
        found.append(int(i))
    return np.array(found, np.intp)


def leaps(solution: Solution) -> bool:
    """Whether the law's strains would leap at a sign change: not where the ribbon is planar."""
    return bool((solution.trajectory.at_stages["leap"] > NEGLIGIBLE * _scale(solution)).any())


def leaps_at_ends(solution: Solution) -> list[bool]:
    """Whether the law's strains change at once at each place where phases meet.

    Not where the ribbon is its own image by inversion: there its law is smooth, and in the small
    elements that others need rounding would be all there is.
    """
    leap = solution.trajectory.at_nodes["leap"]
    starts = [part.start for part in solution.dense.blocks.layout.phase_slices[1:]]
    return [bool(value > FAINT * leap.max()) for value in leap[starts]]


def with_mixtures(sharp: Solution, blunt: Solution) -> Iterator[Arcs]:
    """Yield arcs of a smooth law with mixtures among them, the likeliest first; none without.

    `sharp` and `blunt` are its solutions at a small delta and at three times that: a layer shrinks
    from one to the other, a mixture does not. One that reaches an end of the ribbon stays one to
    the end if m2 is zero there, as on the axis of a symmetric band. At a clamp it does by design
    only, as a helix does that is a mixture all along: else a short phase of one sheet is between.
    """
    before = _beyond(blunt)
    mixtures = []
    for a, b in _beyond(sharp):
        overlap = [(c, d) for c, d in before if c < b and d > a]
        width = sum(d - c for c, d in overlap)
        if b - a > max(SHORTEST, 0.6 * width):
            mixtures.append((a, b))
    if not mixtures:
        return
    at_ends = sharp.trajectory.at_nodes["switching"][[0, -1]]
    zero = np.abs(at_ends) <= NEGLIGIBLE * _scale(sharp)
    arcs = sign_changes(sharp)
    apart, to_ends = (
        _interleaved(arcs, [_reaching(mixture, *gaps) for mixture in mixtures])
        for gaps in (np.where(zero, 0.0, SHORTEST), (0.0, 0.0))
    )
    if apart.kinds == to_ends.kinds:
        yield apart
    else:
        yield from (to_ends, apart) if to_ends.kinds == (0,) else (apart, to_ends)


def without_empty(solution: Solution) -> Arcs | None:
    """Return the arcs of a solution without phases that seem to have no length, if any do.

    Such a length is often a double root, and known to half the digits.
    """
    ends = solution.trajectory.ends
    lengths = np.diff(ends)
    if not (np.abs(lengths) <= EMPTY).any() or (lengths < -EMPTY).any():
        return None
    kinds: list[int] = []
    switches: list[float] = []
    for kind, start, length in zip(solution.sheets, ends, lengths, strict=False):
        if length > EMPTY and (not kinds or kinds[-1] != kind):
            switches += [float(start)] if kinds else []
            kinds.append(kind)
    return Arcs(tuple(kinds), np.array(switches))


def given_arcs(source: Solution, scene: Scene) -> Arcs:
    """Phases that meet where a scene says, of alternating sign; `source` may have other units."""
    assert isinstance(scene.switching, tuple)
    start, end = scene.interval
    switches = (np.array(scene.switching) - start) / (end - start)
    s = source.scene.interval
    middle = s[0] + (s[1] - s[0]) * switches[:1] / 2
    first = 1 if source.outputs(middle)["switching"][0] > 0 else -1
    return Arcs(tuple(first * (-1) ** i for i in range(len(switches) + 1)), switches)


def _reaching(mixture: tuple[float, float], first: float, last: float) -> tuple[float, float]:
    """Fractions of a mixture that stops at gaps from the ends of the ribbon where it is near."""
    a, b = mixture
    return first if a < SHORTEST else a, 1 - last if b > 1 - SHORTEST else b


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
    """Fractions between which strains are beyond those of one sheet."""
    f, slopes = solution.trajectory.stages[1], sheet_slopes(solution.trajectory.at_stages)
    beyond = np.concatenate([[False], slopes > BEYOND, [False]])
    edges = np.flatnonzero(beyond[1:] != beyond[:-1])
    return [(f[a], f[b - 1]) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _faint(solution: Solution) -> float:
    """Return (m2, m3), over the largest |m|, of a tail that does not show in the answer."""
    tolerance = solution.posed.scene.tolerance
    return NEGLIGIBLE if tolerance is None else min(max(SEEN * tolerance, NEGLIGIBLE), FAINT)


def _scale(solution: Solution) -> float:
    return solution.trajectory.at_stages.largest("m")
