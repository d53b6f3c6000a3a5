"""Outputs of a solution at many places, as pictures and files want them: `outputs`, but soon."""

from __future__ import annotations

from collections.abc import Mapping

from ribbonopt.arrays import Array

from .named import Each
from .solution import Solution


def many_outputs(solution: Solution, s: Array) -> Mapping[str, Array]:
    """Named outputs at arclengths s (k,) in the interval, in the units of the scene, lab frame.

    As `Solution.outputs`, to rounding or the error of the solution itself; the first call costs
    what makes the others cheap.
    """
    start, end = solution.scene.interval
    values = solution.trajectory.outputs((s - start) / (end - start), many=True)
    same, unit_of = solution.posed.given is solution.posed.scene, solution.units.of
    return values if same else Each(values, lambda name, value: value * unit_of(name))
