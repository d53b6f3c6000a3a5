"""Where a solution in phases is not one of its law: margins and zeros of its sides and mixtures."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.problem.imposed import margins_function
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription.buffered import Mapped

from .arcs import ROUNDED

MARGIN = 1e-6  # of the largest moment: how far below zero a margin of the law may be at most


def phase_problems(
    solution: Solution, ribbon: Ribbon, accuracy: float, moments: Callable[[], float]
) -> list[str]:
    """Say where a solution in phases is not one of the law: wrong side of its switch, no mixture.

    Margins of a law are compared in units Dw = L = 1. `accuracy` is that of the equations, relative
    to the largest load: what must be zero is so to that. `moments` gives the error of the moments,
    which what must not be negative is so to; it is asked only where more than rounding is.
    """
    at_stages = solution.trajectory.at_stages
    scale, force = at_stages.largest("m"), at_stages.largest("n")
    loads = max(scale, force)
    start, end = solution.scene.interval
    ends = start + (end - start) * solution.trajectory.ends
    problems, phases = [], _least(solution, ribbon)
    margin = ROUNDED * scale
    if any((least[:count] < -margin).any() for _, count, least in phases):
        margin = min(MARGIN * scale, max(moments(), margin))
    for i, (names, count, least) in enumerate(phases):
        allowed = np.where(np.arange(len(names)) < count, margin, accuracy * loads)
        if (least < -allowed).any():
            where = f"between s = {ends[i]:.4g} and {ends[i + 1]:.4g}"
            short = zip(names, least, allowed, strict=True)
            problems += [name.format(where=where) for name, value, most in short if value < -most]
    return problems


class _Least(NamedTuple):
    """Least margins of a solution of a posed scene, in phases of some kinds: see `_least`."""

    posed: Posed
    sheets: tuple[int, ...]
    phases: list[tuple[tuple[str, ...], int, Array]]


def _least(solution: Solution, ribbon: Ribbon) -> list[tuple[tuple[str, ...], int, Array]]:
    """Return for each phase names of margins, how many are none of zeros, and the least of each.

    Found once: they are judged again when the error is known.
    """
    kept, posed, sheets = solution.trajectory.found, solution.posed, solution.sheets
    known: _Least | None = kept.get(_Least)
    if known is None or known.posed is not posed or known.sheets != sheets:
        phases = [_least_of(solution, ribbon, i, kind) for i, kind in enumerate(sheets)]
        known = kept[_Least] = _Least(posed, sheets, phases)
    return known.phases


def _least_of(
    solution: Solution, ribbon: Ribbon, phase: int, kind: int
) -> tuple[tuple[str, ...], int, Array]:
    """Return the same of one phase, at its stages and nodes."""
    trajectory, (start, _) = solution.trajectory, solution.posed.scene.interval
    v, fraction, _, phases = trajectory.stages
    rows, part = phases == phase, solution.dense.blocks.layout.phase_slices[phase]
    nodes = slice(part.start, part.stop + 1)
    places = start + solution.posed.length * np.concatenate(
        [fraction[rows], trajectory.nodes[nodes]]
    )
    states = np.concatenate([v[rows], solution.dense.at_nodes[nodes]])[:, : len(ribbon.states)]
    constants = solution.constants[: len(ribbon.constants)]
    known = ribbon.kept(_margins)
    if kind not in known:
        names, count, function = margins_function(ribbon, kind)
        known[kind] = names, count, Mapped(function)
    names, count, margins = known[kind]
    (values,) = margins(states, constants, solution.dense.theta, places)
    return names, count, values.reshape(-1, len(names)).min(axis=0)


def _margins(_: Ribbon) -> dict[int, tuple[tuple[str, ...], int, Mapped]]:
    """Names of the margins of each kind of phase, how many are none of zeros, and all values.

    Filled in as solutions have phases of these kinds: most have none with a mixture.
    """
    return {}
