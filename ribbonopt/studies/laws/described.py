"""What is compared of two solutions: energy, loads and shape, each difference with a bar.

A bar of a difference is that of both: the solutions are wrong independently of each other.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.output.summary import bars_of
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.comparison.profile import Profile, load_sizes

POINTS = 401  # places at which centre lines are compared first
FINER, ROUNDS = 33, 2  # and between the neighbours of the largest gap, again and again
BESIDE = 1e-9  # of the length: from either side of a jump
CORNER = np.sqrt(3)  # a bar is that of each component; this is of the vector
CURVES = ("u2", "u3", "m2", "m3")

Value = tuple[float, float | None]
"""A number with its bar, None where that is not known."""


@dataclass(frozen=True, eq=False)
class Described:
    """A solution, its bars found once."""

    solution: Solution

    @cached_property
    def bars(self) -> Mapping[str, float | None]:
        """Bars of the answer."""
        return bars_of(self.solution)

    @property
    def length(self) -> float:
        """Of the interval."""
        start, end = self.solution.scene.interval
        return end - start

    @cached_property
    def values(self) -> dict[str, Value]:
        """Energy, and the sizes |n(0)|, |m(0)|, |u(0)|, in the units of the scene."""
        found, bars = self.solution, self.bars
        vectors = {"n0": found.n0, "m0": found.m0, "u0": found.u0}
        sizes = {name: float(np.linalg.norm(vector)) for name, vector in vectors.items()}
        wide = {name: _times(CORNER, bars[name]) for name in sizes}
        return {"energy": (found.energy, bars["energy"])} | {
            name: (size, wide[name]) for name, size in sizes.items()
        }

    @cached_property
    def sizes(self) -> dict[str, float]:
        """What differences are relative to: energy, and loads, of which one may vanish."""
        found, units = self.solution, self.solution.units
        force, moment = load_sizes(Profile(found.n0, found.m0, found.u0, units))
        return {"energy": abs(found.energy) or units.moment, "n0": force, "m0": moment}

    @cached_property
    def curves(self) -> dict[str, list[float] | list[list[float]]]:
        """Centre line, strains and moments along the ribbon; two rows where strains jump."""
        start, end = self.solution.scene.interval
        inset = BESIDE * (end - start)
        jumps = self.solution.switch_points
        s = np.linspace(start + inset, end - inset, 201)
        s = np.unique(np.concatenate([s, jumps - inset, jumps + inset]).clip(start, end))
        outputs = self.solution.outputs(s)
        return {"s": s.tolist(), **{name: outputs[name].tolist() for name in ("r", *CURVES)}}


def differences(found: Described, other: Described) -> dict[str, Value]:
    """Return how far a solution is from another, relative to that one.

    `shape` is the largest distance of the centre lines at equal arclength, over the length;
    `energy` has a sign; `n0` and `m0` are the sizes of the differences of loads at the start.
    """
    a, b = found.solution, other.solution
    unit = a.units.length / found.length  # bars of positions are over the unit of length
    states = _sum(found.bars["states"], other.bars["states"])
    gaps = {
        "energy": a.energy - b.energy,
        "n0": float(np.linalg.norm(a.n0 - b.n0)),
        "m0": float(np.linalg.norm(a.m0 - b.m0)),
    }
    result = {"shape": (line_gap(a, b), _times(CORNER * unit, states))}
    for name, gap in gaps.items():
        size, corner = other.sizes[name], 1.0 if name == "energy" else CORNER
        own = _times(corner, other.bars[name])
        bar = _sum(_times(corner, found.bars[name]), own, _times(abs(gap) / size, own))
        result[name] = gap / size, _times(1 / size, bar)
    return result


def line_gap(a: Solution, b: Solution) -> float:
    """Return the largest distance of two centre lines at equal arclength, over the length."""
    start, end = a.scene.interval
    length, count = end - start, POINTS
    gaps = np.zeros(1)
    for _ in range(1 + ROUNDS):
        s = np.linspace(start, end, count)
        gaps = np.linalg.norm(a.outputs(s)["r"] - b.outputs(s)["r"], axis=1)
        i, count = int(gaps.argmax()), FINER
        start, end = float(s[max(i - 1, 0)]), float(s[min(i + 1, len(s) - 1)])
    return float(gaps.max()) / length


def _sum(*bars: float | None) -> float | None:
    known = [bar for bar in bars if bar is not None]
    return sum(known) if len(known) == len(bars) else None


def _times(factor: float, bar: float | None) -> float | None:
    return None if bar is None else float(factor * bar)
