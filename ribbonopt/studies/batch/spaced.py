"""Numbers evenly spaced between two, made when they are asked for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, overload

from ribbonopt.classes import dataclass
from ribbonopt.plain import is_number
from ribbonopt.scene.limits import VALUES


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
        if not (all(is_number(end) for end in ends) and counts and 1 <= self.size <= VALUES):
            return False
        return bool(self.scale == "linear" or (self.scale == "log" and min(ends) > 0))

    def value(self, index: int) -> float:
        """Return one of them; the ends are the numbers given, to the last digit."""
        a, b = float(self.first), float(self.last)
        if index in (0, self.size - 1):
            return b if index else a
        t = float(index / (self.size - 1))
        if self.scale == "log":
            return math.exp(math.log(a) * (1 - t) + math.log(b) * t)
        return float(a * (1 - t) + b * t)

    def __len__(self) -> int:
        """Return how many there are."""
        return int(self.size)

    @overload
    def __getitem__(self, index: int) -> float: ...
    @overload
    def __getitem__(self, index: slice) -> list[float]: ...
    def __getitem__(self, index: int | slice) -> float | list[float]:
        """Return one of them."""
        found = range(self.size)[index]
        return self.value(found) if isinstance(found, int) else [self.value(i) for i in found]
