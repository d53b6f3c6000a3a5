"""Numbers evenly spaced between two, made when they are asked for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, overload

from ribbonopt.plain import is_number

MOST = 10**12  # values of a key


@dataclass(frozen=True)
class Spaced(Sequence[float]):
    """Numbers evenly spaced between two, or between two powers."""

    first: Any
    last: Any
    size: Any
    scale: Any

    @property
    def sound(self) -> bool:
        """Whether they can be made."""
        ends = (self.first, self.last)
        counts = isinstance(self.size, int) and not isinstance(self.size, bool)
        if not (all(is_number(end) for end in ends) and counts and 1 <= self.size <= MOST):
            return False
        return bool(self.scale == "linear" or (self.scale == "log" and min(ends) > 0))

    @cached_property
    def values(self) -> list[float]:
        """The numbers."""
        a, b = float(self.first), float(self.last)
        inside = [i / (self.size - 1) for i in range(1, self.size - 1)]
        if self.scale == "log":
            inside = [math.exp(math.log(a) * (1 - t) + math.log(b) * t) for t in inside]
        else:
            inside = [a * (1 - t) + b * t for t in inside]
        # The ends are the numbers given, to the last digit.
        return [a, *inside, b][: self.size]

    def __len__(self) -> int:
        """Return how many there are."""
        return int(self.size)

    @overload
    def __getitem__(self, index: int) -> float: ...
    @overload
    def __getitem__(self, index: slice) -> list[float]: ...
    def __getitem__(self, index: int | slice) -> float | list[float]:
        """Return one of them."""
        return self.values[index]
