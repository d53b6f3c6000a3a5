"""What the figures show: the scenes of `configs/paper`, solved and followed, as rows along s."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ribbonopt import Continuation, Solution, load_scene, solve, summarize

from .numbers import Number

Array = NDArray[np.float64]

CONFIGS = Path(__file__).resolve().parents[2] / "configs" / "paper"
NAMES = ("u2", "u3", "m2", "m3")
MIDDLE = 0.5  # of the band: its only inflection


class Rows(NamedTuple):
    """Rows (k,) along a stretch of the band."""

    s: Array
    u2: Array
    u3: Array
    m2: Array
    m3: Array

    def mirrored(self) -> Rows:
        """Return the other half: u2(1 - s) = -u2(s), u3(1 - s) = u3(s), section 5; m likewise."""
        s, u2, u3, m2, m3 = (values[::-1] for values in self)
        return Rows(1 - s, -u2, u3, -m2, m3)


class Found:
    """Solutions of the scenes of the paper, each found when first asked for."""

    @cached_property
    def sadowsky(self) -> Solution:
        """Half of the band, figure 4."""
        return _solved("moebius_sadowsky")

    @cached_property
    def regularized(self) -> Solution:
        """All of the band under (6.1), figure 5."""
        return _solved("moebius_regularized")

    @cached_property
    def wunderlich(self) -> Solution:
        """Half of a band of finite width, figure 5."""
        return _solved("moebius_wunderlich")

    @cached_property
    def printed_whole(self) -> Solution:
        """What the ends (6.2) lead to as they are printed."""
        return _solved("printed_whole")

    @cached_property
    def branch(self) -> list[dict[str, Any]]:
        """Points along epsilon, figure 5d: rows of the continuation."""
        continuation = Continuation(load_scene(CONFIGS / "moebius_epsilon.yaml"))
        rows = [dict(point.row) for point in continuation]
        if not continuation.ending.reached:
            raise SystemExit(f"moebius_epsilon: {continuation.ending.reason}")
        return [row for row in rows if row["kind"] == "point"]


def half_of(solution: Solution) -> Rows:
    """Sample the first half of a band; the rows crowd towards its inflection."""
    even = np.linspace(0, MIDDLE, 301)
    near = MIDDLE - np.geomspace(1e-9, even[1], 60)
    s = np.unique(np.concatenate([even[:-1], near]))
    return Rows(s, *(solution.sample(s, name) for name in NAMES))


class Answers:
    """Numbers of a solution, with their bars.

    Keys are n0x ... m0z (lab frame), u1, u2, u3 (directors), H0, at the start; energy; whole, the
    energy of a band of which the solution is half.
    """

    def __init__(self, solution: Solution) -> None:
        summary = summarize(solution)
        self.bars: Mapping[str, float | None] = summary["error_estimate"]
        self._found = {"H0": (summary["H0"], "H0", 1), "energy": (summary["energy"], "energy", 1)}
        self._found["whole"] = (summary["energy"], "energy", 2)
        for group, names in (
            ("n0", ("n0x", "n0y", "n0z")),
            ("m0", ("m0x", "m0y", "m0z")),
            ("u0", ("u1", "u2", "u3")),
        ):
            for name, value in zip(names, summary[group], strict=True):
                self._found[name] = (value, group, 1)

    def number(self, name: str, key: str, paper: str = "") -> Number:
        """Return the number of a key under the name that is written beside it."""
        value, group, times = self._found[key]
        bar = self.bars[group]
        return Number(name, times * value, paper, None if bar is None else times * bar)

    def value(self, key: str) -> float:
        """Return the number of a key alone."""
        return self.number("", key).value


def where(function: Callable[[float], float], low: float, high: float) -> float:
    """Return where a function changes sign between two places, by bisection."""
    sign = function(low) > 0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if (function(middle) > 0) == sign else (low, middle)
    return (low + high) / 2


def _solved(name: str) -> Solution:
    solution = solve(load_scene(CONFIGS / f"{name}.yaml"))
    if not solution.verified:
        raise SystemExit(f"{name}: {solution.message}")
    return solution
