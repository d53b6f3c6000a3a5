"""A solution in one line, as Python shows it: what it is, verified or not, numbers with bars."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.solution.solution import Solution
from ribbonopt.text import one_line, shortened

from .digits import SMALL, digits, upwards
from .summary import bars_of

LONGEST = 40  # letters of a name


def in_short(solution: Solution) -> str:
    """Return what a solution is, in one line of at most some 300 characters.

    Force and moment at the start are in the lab frame, all in the units of the scene; no digit is
    shown that the bar does not bear.
    """
    scene = solution.scene
    name = shortened(one_line(scene.name), LONGEST)
    status = solution.status.name.lower().replace("_", " ")
    head = f"<Solution {name}: {status}{', verified' if solution.verified else ''}"
    law = f"law {shortened(one_line(scene.law.type), LONGEST)}"
    if not solution.status.converged:
        return f"{head}; {law}>"
    bars = bars_of(solution)
    numbers = [
        f"n(0) = {_vector(solution.n0, bars['n0'])}",
        f"m(0) = {_vector(solution.m0, bars['m0'])}",
        f"energy = {_number(solution.energy, bars['energy'])}",
    ]
    units = "; SI" if solution.units.si else ""
    return f"{head}; {law}; {', '.join(numbers)}{units}>"


def _vector(values: Array, bar: float | None) -> str:
    small = bool(0 < np.abs(values).max() < SMALL)
    return f"({', '.join(digits(float(v), bar, small) for v in values)}){_bar(bar)}"


def _number(value: float, bar: float | None) -> str:
    return f"{digits(value, bar, 0 < abs(value) < SMALL)}{_bar(bar)}"


def _bar(bar: float | None) -> str:
    return " +- unknown" if bar is None else f" +- {upwards(bar)}"
