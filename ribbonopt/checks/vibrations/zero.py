"""Zero modes: motions at no cost, named; no vibrations."""

from __future__ import annotations

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass

from ..variation import Variation
from .kinetic import Kinetic
from .lowest import Spectrum
from .stated import Vibrating


@dataclass(frozen=True, eq=False)
class Neutral:
    """Motions that may cost nothing."""

    most: int = 0

    @classmethod
    def of(cls, what: Vibrating, variation: Variation, energy: Kinetic) -> "Neutral":
        return cls()

    def others(self, found: Spectrum, scale: float) -> Array:
        return np.ones(len(found.squared), dtype=bool)

    def names(self, count: int) -> tuple[str, ...]:
        return ()
