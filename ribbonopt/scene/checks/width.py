"""What is wrong with the width of a ribbon along its length."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ribbonopt.scene.faults import Problem
from ribbonopt.scene.limits import NARROW

from .along import Sample


def check_width(samples: Sequence[Sample]) -> Iterator[Problem]:
    """Yield where a width vanishes, or is next to nothing beside what it is elsewhere."""
    least, widest = min(samples), max(samples)
    where = f"at s = {least.s:.6g}, " if len(samples) > 1 else ""
    if least.value <= 0:
        message = f"{where}expected a width > 0 all along; end the interval before it vanishes"
        yield Problem(("width",), message, f"{least.value:.6g}")
    elif least.value < NARROW * widest.value:
        message = f"{where}expected at least {NARROW:g} of the largest width, {widest.value:g}"
        yield Problem(("width",), message, f"{least.value:.6g}")
