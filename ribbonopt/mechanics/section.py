"""A cross section of a rod, symbolic, and the fields along a ribbon as numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from functools import cached_property

import casadi as ca

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from .laws.law import Stress


@dataclass(frozen=True, eq=False)
class Section:
    """One cross section: lab-frame vectors (3,), arclength, and the law's own states (k,).

    `stepped` is the force (3,) of what acts at single places up to here, if anything does;
    `extension` is that of the centre line, so that r' is `tangent`.
    """

    r: ca.SX
    d1: ca.SX
    d2: ca.SX
    d3: ca.SX
    n: ca.SX
    m: ca.SX
    s: ca.SX
    own: ca.SX
    stepped: ca.SX | None = None
    extension: ca.SX | float = 0.0

    @property
    def stretched(self) -> ca.SX:
        """Length of the centre line over what it is without stretch, 1 where nothing does."""
        return 1 + ca.SX(self.extension)

    @property
    def tangent(self) -> ca.SX:
        """The derivative r' (3,), lab frame."""
        return self.stretched * self.d3

    def along(self, vector: ca.SX) -> ca.SX:
        """Components (3,) of a lab vector along the directors."""
        return ca.vertcat(*(ca.dot(vector, d) for d in (self.d1, self.d2, self.d3)))

    @cached_property
    def stress(self) -> Stress:
        """What a law may read of this section."""
        return Stress(self.along(self.n), self.along(self.m), self.own)


@dataclass(frozen=True, eq=False)
class RodFields:
    """Numbers along a ribbon, rows along s: r, n, m (k, 3) and frames (k, 3, 3), lab frame.

    Column i of a frame is the director d_i. `own` are states (k,) of a law, by name, where known.
    """

    r: Array
    frames: Array
    n: Array
    m: Array
    own: Mapping[str, Array] = field(default_factory=dict)
