"""Phases where m2 changes sign: a solution of the law as it is, posed again so that it is smooth.

Without phases a law with a kink costs every scheme its order, and with a jump Newton's method may
report success on a wrong answer. Arcs are read from a solution without phases, or from those of the
smooth law on the way to it; what comes out must have the sign of m2 that each phase assumes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np

from ribbonopt.accuracy.arcs import Arcs, sign_changes, with_mixtures
from ribbonopt.attempts import Attempts
from ribbonopt.scene import Scene
from ribbonopt.solution import Solution

#: attempts on phases of these kinds that meet at these fractions
Posed = Callable[[Arcs], Attempts]


def in_phases(
    solution: Solution | None, smooth: list[Solution], scene: Scene, posed: Posed
) -> Attempts | None:
    """Return successful attempts in phases, or None where none was found or none is needed.

    Parameters
    ----------
    solution
        What was found without phases, if it converged.
    smooth
        Solutions of the smooth law, delta decreasing.
    scene
        What is asked; `switching` may name the arclengths of the switches.
    posed
        Gives attempts in phases.
    """
    for arcs, source in _candidates(solution, smooth, scene):
        if len(arcs.kinds) == 1:
            continue
        attempts = posed(arcs)
        if attempts.run(source, quick=True):
            return attempts
    return None


def _candidates(
    solution: Solution | None, smooth: list[Solution], scene: Scene
) -> Iterator[tuple[Arcs, Solution]]:
    sources = ([solution] if solution else []) + smooth[::-1][:1]
    if isinstance(scene.switching, tuple):
        yield from ((_given(source, scene), source) for source in sources[:1])
        return
    yield from ((sign_changes(source), source) for source in sources)
    for blunt, sharp in reversed(list(pairwise(smooth))):
        yield with_mixtures(sharp, blunt), sharp
        return


def _given(source: Solution, scene: Scene) -> Arcs:
    """Phases that meet where the scene says, of alternating sign."""
    assert isinstance(scene.switching, tuple)
    start, end = scene.interval
    switches = (np.array(scene.switching) - start) / (end - start)
    ends = np.concatenate([[0.0], switches, [1.0]])
    start, end = source.scene.interval  # in its own units
    middle = start + (end - start) * (ends[:1] + ends[1:2]) / 2
    first = 1 if source.outputs(middle)["m2"][0] > 0 else -1
    return Arcs(tuple(first * (-1) ** i for i in range(len(switches) + 1)), switches)
