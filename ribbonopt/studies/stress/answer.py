"""An answer and its bars as plain numbers, to be compared with another of the same ribbon."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from ribbonopt.accuracy.gaps import ROUNDING
from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.output.summary import bars_of
from ribbonopt.scene.units import Units
from ribbonopt.solution.solution import Solution

PLACES = 65  # where states are compared
LEAST = 1e-3  # of loads and strains, in units Dw = L = 1: below that errors count absolutely
LOOSE = 0.3  # relative error of an answer without bars, which claims nothing: that it is one at all
SHARP = 1e-10  # relative: bars of a witness that need not be smaller
IMAGES = ("energy", "size of n", "n . m")
OF = {"size of n": "n0", "n . m": "m0"}


@dataclass(frozen=True, eq=False)
class Answer:
    """What an answer consists of, in units of the scene that it is compared in.

    `values` are arrays by name, `bars` bounds of their errors (None: not known), `sizes` what
    errors are relative to.
    """

    values: Mapping[str, Array]
    bars: Mapping[str, float | None]
    sizes: Mapping[str, float]

    @classmethod
    def of(cls, solution: Solution, units: Units | None = None) -> Answer:
        """Return the answer of a solution; `units` are its units in those of others."""
        units = units or Units()
        start, end = solution.scene.interval
        s = start + (end - start) * np.linspace(0, 1, PLACES)
        o = solution.outputs(np.minimum(s, end))
        inside = solution.units.length
        energy = np.array(solution.energy)
        n0, m0, u0 = solution.n0, solution.m0, solution.u0
        states = np.hstack([o["r"] / inside, o["d1"], o["d2"], o["d3"]])
        found = {"n0": n0 / units.force, "m0": m0 / units.moment, "u0": u0 * units.length}
        found |= {"energy": energy / units.moment, "states": states}
        scale = {
            "n0": units.force,
            "m0": units.moment,
            "u0": 1 / units.length,
            "energy": units.moment,
            "states": 1.0,
        }
        given = bars_of(solution)
        bars = {name: _over(given[name], unit) for name, unit in scale.items()}
        own = solution.units
        force, moment = (x / y for x, y in ((own.force, units.force), (own.moment, units.moment)))
        load = max(float(np.abs(n0).max()) / own.force, float(np.abs(m0).max()) / own.moment, LEAST)
        strain = max(float(np.abs(o["u"]).max()), LEAST / own.length)
        sizes = {"n0": load * force, "m0": load * moment, "u0": strain * units.length}
        sizes |= {"energy": max(abs(float(found["energy"])), LEAST * moment), "states": 1.0}
        return cls(found, bars, sizes)

    def tells(self, other: Answer) -> bool:
        """Whether its own bars are small enough to tell whether those of another one hold."""
        for name, size in self.sizes.items():
            own, bar = self.bars[name], other.bars[name]
            if own is None or math.isnan(own):
                return False
            asked = LOOSE * size if bar is None or math.isnan(bar) else bar
            if own > max(asked, SHARP * size):
                return False
        return True

    @property
    def image(self) -> dict[str, float]:
        """What no turning or mirroring of the ribbon changes."""
        n, m = self.values["n0"], self.values["m0"]
        along = abs(float(n @ m)) / max(float(np.linalg.norm(n)), 1e-300)
        found = (float(self.values["energy"]), float(np.linalg.norm(n)), along)
        return dict(zip(IMAGES, found, strict=True))


class Gap(NamedTuple):
    """How far two answers are apart: over their bars, and relative to sizes; and in what.

    `known` says whether both have bars; without, LOOSE stands for them.
    """

    over_bars: float
    relative: float
    what: str
    known: bool

    @property
    def agree(self) -> bool:
        """Whether they are the same within their bars."""
        return self.over_bars <= 1


def gap_between(one: Answer, other: Answer) -> Gap:
    """Return the gap of two answers of the same ribbon: of the part furthest off over its bars."""
    parts = {k: float(np.abs(v - other.values[k]).max()) for k, v in one.values.items()}
    return _worst(parts, one, other, dict(zip(parts, parts, strict=True)))


def image_gap(one: Answer, other: Answer) -> Gap:
    """Return the gap of two answers, one of which may be turned, shifted or mirrored."""
    ours, theirs = one.image, other.image
    parts = {name: abs(ours[name] - theirs[name]) for name in ours}
    # Bars are of components, of which a size has three.
    parts = {name: gap / (1.0 if name == "energy" else 3**0.5) for name, gap in parts.items()}
    return _worst(parts, one, other, {name: OF.get(name, name) for name in parts})


def _worst(parts: Mapping[str, float], one: Answer, other: Answer, names: Mapping[str, str]) -> Gap:
    over, relative, known = {}, {}, True
    for part, gap in parts.items():
        name = names[part]
        size = max(one.sizes[name], other.sizes[name])
        bars = (one.bars[name], other.bars[name])
        told = [bar for bar in bars if bar is not None and not math.isnan(bar)]
        known = known and len(told) == len(bars)
        bar = sum(told) if len(told) == len(bars) else LOOSE * size
        relative[part] = gap / size
        over[part] = gap / (bar + ROUNDING * size)
        if not math.isfinite(over[part]):
            over[part] = relative[part] = math.inf
    worst = max(over, key=over.__getitem__)
    return Gap(
        over[worst], max(relative[p] for p in relative if names[p] in ("n0", "m0")), worst, known
    )


def _over(bar: float | None, unit: float) -> float | None:
    return None if bar is None else bar / unit
