"""Colours of a surface by a field: two hues on either side of zero, or one where there is no sign.

They are made to be told apart in grey too: pale at zero, darker away from it.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.classes import dataclass
from ribbonopt.views.shape import Shape

from .quantities import values_of

FIELD = "u2"
#: linear RGB at minus the largest value, half of it, 0, half, the largest
_SCALE = np.array(
    [
        [0.020, 0.110, 0.300],
        [0.110, 0.380, 0.640],
        [0.850, 0.850, 0.820],
        [0.800, 0.300, 0.110],
        [0.360, 0.045, 0.020],
    ]
)
_AT = np.linspace(-1.0, 1.0, len(_SCALE))
_NONE = np.array([0.5, 0.5, 0.5])


@dataclass(frozen=True)
class Colours:
    """What colours mean: a field, and the size at which they are darkest."""

    field: str
    largest: float

    def of(self, shape: Shape) -> Array:
        """Return linear red, green and blue (n, 3), each from 0 to 1, in all rows of a shape."""
        values = values_of(shape, self.field)
        known = np.isfinite(values)
        share = np.where(known, values, 0.0) / (self.largest or 1.0)
        found = np.stack([np.interp(share, _AT, channel) for channel in _SCALE.T], axis=1)
        return np.asarray(np.where(known[:, None], found, _NONE))


def colours_of(field: str, shapes: Iterable[Shape]) -> Colours:
    """Return one scale of colours for all of some shapes."""
    sizes = [np.abs(values_of(shape, field)) for shape in shapes]
    return Colours(field, max((float(np.nanmax(v, initial=0.0)) for v in sizes), default=0.0))


def as_seen(linear: Array) -> Array:
    """Return colours as screens and most files have them (sRGB, IEC 61966-2-1), as whole bytes."""
    curved = 1.055 * np.power(linear, 1 / 2.4) - 0.055
    return np.round(255 * np.where(linear <= 0.0031308, 12.92 * linear, curved))
