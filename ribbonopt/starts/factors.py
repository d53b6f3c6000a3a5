"""Shares of a load that is brought on: it grows from nothing, evenly at first, then by factors."""

from __future__ import annotations

import numpy as np

from ribbonopt.classes import dataclass

FIRST_LOADS = 2.0  # size of loads that are brought on evenly before they grow by factors
MOST_GROWTH, LEAST_GROWTH = 1.2, 0.02  # of the logarithm of a load in a step


@dataclass()
class Factors:
    """Where a load of a size (Dw = L = 1) is on its way, and the next step, as logarithms."""

    size: float
    step: float
    at: float = 0.0

    @property
    def last(self) -> float:
        """Where all of it is there."""
        return float(np.arcsinh(self.size / FIRST_LOADS))

    @property
    def done(self) -> bool:
        """Whether all of it is there."""
        return self.at >= self.last

    @property
    def share(self) -> float:
        """The share of it to try next."""
        following = self.at + self.step
        return (
            1.0 if following >= self.last else FIRST_LOADS * float(np.sinh(following)) / self.size
        )

    def taken(self, growth: float) -> None:
        """Go on from there, the step `growth` times as long."""
        self.at = min(self.last, self.at + self.step)
        self.step = min(self.step * growth, MOST_GROWTH)

    def refused(self) -> bool:
        """Take a shorter step; False where it is too short to go on."""
        self.step /= 3
        return self.step >= LEAST_GROWTH
