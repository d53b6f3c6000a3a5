"""A ribbon with states of its own as steps between joints, on meshes graded to inflections."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.integrate._ivp import dop853_coefficients as dop853

from .rod import STAGES, Array
from .wide import ROWS, E, Wide

NEAREST = 1e-9  # of the length: the first step beside an inflection
RATIO = 1.4  # of distances to it from one step to the next


@dataclass(frozen=True, eq=False)
class Joints:
    """States (22, K + 1) between which steps lead; `ends` of the phases, in which phase a step is.

    `fractions` (K,) are parts of the phases.
    """

    law: Wide
    ends: Array
    fractions: Array
    phases: Array
    y: Array

    @cached_property
    def h(self) -> Array:
        """Lengths (K,) of the steps."""
        return self.fractions * np.diff(self.ends)[self.phases]

    @cached_property
    def s(self) -> Array:
        """Arclengths (K + 1,)."""
        s = self.ends[0] + np.concatenate([[0.0], np.cumsum(self.h)])
        first = np.flatnonzero(np.diff(self.phases)) + 1
        s[first], s[-1] = self.ends[1:-1], self.ends[-1]
        return s

    @cached_property
    def energy(self) -> float:
        """Energy of the ribbon."""
        return float(self.steps()[E].sum())

    def steps(self) -> Array:
        """States (22, K) at the ends of all steps, energies from zero."""
        start = self.y[:, :-1].copy()
        start[E] = 0
        return step(self.law, self.s[:-1], start, self.h)

    def split(self, parts: Array) -> Joints:
        """Return it with every step in equal parts (K,)."""
        owner = np.repeat(np.arange(len(parts)), parts)
        first = np.concatenate([[0], np.cumsum(parts)])
        within = np.arange(len(owner)) - first[owner]
        y = np.empty((ROWS, len(owner) + 1))
        part = self.h[owner] * within / parts[owner]
        y[:, :-1] = step(self.law, self.s[owner], self.y[:, owner], part)
        y[:, first] = self.y
        widths = np.repeat(self.fractions / parts, parts)
        return replace(self, fractions=widths, phases=np.repeat(self.phases, parts), y=y)

    def at(self, s: Array) -> Array:
        """States (22, k) at arclengths (k,), each from the joint in front of it."""
        k = np.clip(np.searchsorted(self.s, s, side="right") - 1, 0, len(self.h) - 1)
        return step(self.law, self.s[k], self.y[:, k], s - self.s[k])


def step(law: Wide, s: Array, y: Array, h: Array) -> Array:
    """One step of DOP853 of length h (...) from states (22, ...) at arclengths s (...)."""
    k = np.empty((STAGES, *y.shape), y.dtype)
    for i in range(STAGES):
        at = y + h * np.tensordot(dop853.A[i, :i], k[:i], 1) if i else y
        k[i] = law.rates(np.broadcast_to(s + dop853.C[i] * h.real, y.shape[1:]), at)
    return y + h * np.tensordot(dop853.B, k, 1)


def graded(width: float, first: bool, last: bool) -> Array:
    """Joints (k,) in 0 ... 1 of a phase of which one or both ends are inflections.

    `width` is the ribbon's over the length of the phase; steps grow with the distance to an
    inflection, and to clamps, where the strains change along width / sqrt(24).
    """
    longest = min(1 / 24, 0.2 * width)
    halves = []
    for inflection in (first, last):
        nearest = NEAREST if inflection else width / 40
        x = [0.0, nearest]
        while x[-1] < 0.5:
            grown = (RATIO - 1) * x[-1] if inflection else nearest + 0.2 * x[-1]
            x.append(x[-1] + min(longest, grown))
        halves.append(np.array(x) / (2 * x[-1]))
    return np.concatenate([halves[0], 1 - halves[1][-2::-1]])
