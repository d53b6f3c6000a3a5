"""Where a solution in phases is not one of its law: margins and zeros of its sides and mixtures."""

from __future__ import annotations

import numpy as np

from ribbonopt.problem import Ribbon
from ribbonopt.problem.imposed import margins_function
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription.buffered import Mapped

from .arcs import ROUNDED

MARGIN = 1e-6  # of the largest moment: how far below zero a margin of the law may be at most


def phase_problems(
    solution: Solution, ribbon: Ribbon, accuracy: float, moments: float = np.inf
) -> list[str]:
    """Say where a solution in phases is not one of the law: wrong side of its switch, no mixture.

    Margins of a law are compared in units Dw = L = 1. `accuracy` is that of the equations, relative
    to the largest load: what must be zero is so to that. `moments` is the error of the moments:
    what must not be negative is so to that.
    """
    problems = []
    v, fraction, _, phase = solution.trajectory.stages
    theta, at_nodes = solution.dense.theta, solution.dense.at_nodes
    scale, force = (float(np.abs(solution.trajectory.at_stages[v]).max()) for v in "mn")
    loads = max(scale, force)
    s, s_nodes = (
        solution.posed.scene.interval[0] + solution.posed.length * at
        for at in (fraction, solution.trajectory.nodes)
    )
    start, end = solution.scene.interval
    ends = start + (end - start) * solution.trajectory.ends
    constants = solution.constants[: len(ribbon.constants)]
    for i, kind in enumerate(solution.sheets):
        rows, part = phase == i, solution.dense.blocks.layout.phase_slices[i]
        places = np.concatenate([s[rows], s_nodes[part.start : part.stop + 1]])
        states = np.concatenate([v[rows], at_nodes[part.start : part.stop + 1]])
        where = f"between s = {ends[i]:.4g} and {ends[i + 1]:.4g}"
        names, count, margins = ribbon.kept(_margins)[kind]
        (values,) = margins(states[:, : len(ribbon.states)], constants, theta, places)
        least = values.reshape(-1, len(names)).min(axis=0)
        margin = min(MARGIN * scale, max(moments, ROUNDED * scale))
        allowed = np.where(np.arange(len(names)) < count, margin, accuracy * loads)
        short = zip(names, least, allowed, strict=True)
        problems += [name.format(where=where) for name, value, most in short if value < -most]
    return problems


def _margins(ribbon: Ribbon) -> dict[int, tuple[tuple[str, ...], int, Mapped]]:
    """Names of the margins of every kind of phase, how many are none of zeros, and all values."""
    found = {kind: margins_function(ribbon, kind) for kind in (-1, 0, 1)}
    return {
        kind: (names, count, Mapped(function)) for kind, (names, count, function) in found.items()
    }
