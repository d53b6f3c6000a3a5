"""A solution in other phases, at the point where these begin or end: the same ribbon.

A phase without length is an element of the mesh as any other. So what is born at an end of the
ribbon, or gone there, changes the vector of unknowns but not the state: the equations in the new
phases can be linearised at once.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.attempt.attempt import Attempt
from ribbonopt.attempt.structure import LEAST_IN_PHASE
from ribbonopt.pipeline.search import Search
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import Mesh

from .phases import EMPTY, Change, What, minima, profile, spares


def kinds_after(kinds: tuple[int, ...], changes: Iterable[Change]) -> tuple[int, ...]:
    """Return the kinds of phases after changes at the ends of the ribbon."""
    what = {change.what for change in changes}
    if What.GONE_AT_START in what:
        kinds = kinds[1:]
    if What.GONE_AT_END in what:
        kinds = kinds[:-1]
    if What.BORN_AT_START in what:
        kinds = (-kinds[0], *kinds)
    if What.BORN_AT_END in what:
        kinds = (*kinds, -kinds[-1])
    return kinds


def at_the_ends(
    search: Search, solution: Solution, changes: Iterable[Change]
) -> tuple[Attempt, Array]:
    """Return the means to solve after changes at the ends, and the unknowns there (nw,)."""
    changes = tuple(changes)
    what = {change.what for change in changes}
    layout = solution.dense.blocks.layout
    nodes, stages, c = layout.unpack(solution.dense.w)
    rod = layout.nc - len(layout.elements) + 1
    lengths = np.diff(solution.trajectory.ends) * solution.trajectory.length
    phases, constants = list(solution.mesh.phases), list(lengths)
    born = np.full(LEAST_IN_PHASE, 1 / LEAST_IN_PHASE)
    for first, gone, new in (
        (True, What.GONE_AT_START, What.BORN_AT_START),
        (False, What.GONE_AT_END, What.BORN_AT_END),
    ):
        at = 0 if first else -1
        if gone in what:
            count = len(phases.pop(at))
            constants.pop(at)
            kept = slice(count, None) if first else slice(None, len(stages) - count)
            stages = stages[kept]
            nodes = nodes[count:] if first else nodes[: len(nodes) - count]
        if new in what:
            place = 0 if first else len(phases)
            phases.insert(place, born)
            constants.insert(place, 0.0)
            more = np.repeat(nodes[[at]], len(born), axis=0)
            still = np.repeat(more[:, None], layout.stages, axis=1)
            nodes = np.concatenate([more, nodes] if first else [nodes, more])
            stages = np.concatenate([still, stages] if first else [stages, still])
    kinds = kinds_after(solution.sheets, changes)
    ends = np.cumsum(constants[:-1]) / sum(constants)
    attempt = search.on_mesh(kinds, Mesh(tuple(phases)), ends)
    everything = np.concatenate([c[:rod], constants[:-1]])
    return attempt, attempt.nlp.layout.pack(nodes, stages, everything)


def with_born(
    solution: Solution, changes: tuple[Change, ...], width: float, mixed: bool, zero: float
) -> tuple[tuple[int, ...], Array, list[int]]:
    """Return kinds, switches and which phases are new, of phases of a width born inside.

    Margins count as zero up to `zero`. In a phase that the switch touches a mixture is born or,
    not `mixed`, one of the other kind; between two phases a mixture; in a mixture the side of the
    law that u2 has come to.
    """
    born: list[tuple[float, int, bool]] = []  # where, which kind, whether in the midst of a phase
    ends, kinds = solution.trajectory.ends, solution.sheets
    for change in changes:
        i = change.phase
        start, length = float(ends[i]), float(ends[i + 1] - ends[i])
        if change.what is What.BORN_BETWEEN:
            born.append((start + length, 0, False))
        elif change.what is What.BORN_INSIDE:
            places = minima(solution, i, *profile(solution, i))
            kind = 0 if mixed else -kinds[i]
            born += [(start + sigma * length, kind, True) for sigma, v in places if v <= zero]
        else:
            born += [
                (start + sigma * length, sheet, 0 < sigma < 1)
                for sigma, share, sheet in spares(solution, i)
                if share <= zero
            ]
    result, switches, new = [kinds[0]], [], []
    meetings = iter(enumerate(ends[1:-1].tolist(), start=1))
    following = next(meetings, None)
    for at, kind, midst in sorted(born):
        while following is not None and following[1] < at - EMPTY:
            switches.append(following[1])
            result.append(kinds[following[0]])
            following = next(meetings, None)
        after = result[-1]
        if not midst and following is not None:
            after = kinds[following[0]]
            following = next(meetings, None)
        switches += [at - width / 2, at + width / 2]
        new.append(len(result))
        result += [kind, after]
    while following is not None:
        switches.append(following[1])
        result.append(kinds[following[0]])
        following = next(meetings, None)
    return tuple(result), np.array(switches), new


def in_other_phases(
    search: Search, source: Solution, kinds: tuple[int, ...], switches: Array
) -> tuple[Attempt, Array]:
    """Return the means to solve in phases that meet at fractions, and the unknowns of a source.

    LinAlgError where the phases have no length.
    """
    if not (np.diff([0.0, *switches, 1.0]) > 0).all():
        raise np.linalg.LinAlgError("phases do not follow each other")
    old, nodes = np.append(source.trajectory.nodes[:-1], 1.0), [0.0, *switches, 1.0]
    order = np.arange(len(old), dtype=float)
    phases = []
    for a, b in pairwise(nodes):
        first, last = np.interp([a, b], old, order)
        count = max(LEAST_IN_PHASE, round(last - first))
        inner = np.interp(np.linspace(first, last, count + 1), order, old)
        phases.append(np.diff(inner) / (inner[-1] - inner[0]))
    attempt = search.on_mesh(kinds, Mesh(tuple(phases)), np.asarray(switches))
    return attempt, attempt.unknowns(source)
