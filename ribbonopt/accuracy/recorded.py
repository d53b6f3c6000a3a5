"""What a scene records, of one solution, with bars."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.scene.stages import parse_record
from ribbonopt.solution.solution import Solution

from .estimate import SAFETY, analyse
from .gaps import ROUNDING

AROUND = np.array([0.0, -0.15, 0.15])  # of an element: errors vanish here and there


def recorded(solution: Solution) -> dict[str, float]:
    """Return the values of what a scene records, by name, in its units."""
    return {name: float(solution.sample(s, text)) for name, text, s in _formulas(solution)}


def recorded_errors(solution: Solution) -> dict[str, float]:
    """Bars of what a scene records, by name; nan where none can be given.

    Each is the largest difference to the next better scheme near its place, as in `estimate_error`.

    Raises
    ------
    LinAlgError
        If the equations are singular.
    """
    return {name: error_at(solution, text, s) for name, text, s in _formulas(solution)}


def error_at(solution: Solution, text: str, s: float) -> float:
    """Bar of a formula of named outputs at an arclength; see `recorded_errors`."""
    found = analyse(solution)
    better = replace(solution, trajectory=found.other)
    bar = SAFETY * found.more if found.known else math.nan
    places = _near(solution, s)
    ours, theirs = (each.sample(places, text) for each in (solution, better))
    gap, size = (float(np.abs(v).max()) for v in (ours - theirs, ours))
    return bar * max(gap, ROUNDING * size)


def _formulas(solution: Solution) -> list[tuple[str, str, float]]:
    scene = solution.scene
    return [(name, *parse_record(text, scene)) for name, text in scene.record.items()]


def _near(solution: Solution, s: float) -> Array:
    """Arclengths (k,) in the element of a place."""
    nodes = solution.nodes
    element = min(max(int(np.searchsorted(nodes, s)) - 1, 0), len(nodes) - 2)
    a, b = nodes[element], nodes[element + 1]
    return np.asarray(np.clip(s + (b - a) * AROUND, a, b))
