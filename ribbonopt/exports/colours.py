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
#: sRGB bytes at minus the largest value, half of it, 0, half, the largest
_SCALE = np.array([[38, 86, 158], [118, 168, 214], [240, 238, 232], [234, 158, 108], [188, 70, 36]])
_AT = np.linspace(-1.0, 1.0, len(_SCALE))
_NONE = np.array([128.0, 128.0, 128.0])  # where a value is not known


@dataclass(frozen=True)
class Colours:
    """What colours mean: a field, and the size at which they are darkest."""

    field: str
    largest: float

    def of(self, shape: Shape) -> Array:
        """Return red, green and blue (n, 3) as screens have them (sRGB), 0 to 255, in all rows."""
        values = values_of(shape, self.field)
        known = np.isfinite(values)
        share = np.where(known, values, 0.0) / (self.largest or 1.0)
        found = np.stack([np.interp(share, _AT, channel) for channel in _SCALE.T], axis=1)
        return np.asarray(np.round(np.where(known[:, None], found, _NONE)))


def colours_of(field: str, shapes: Iterable[Shape]) -> Colours:
    """Return one scale of colours for all of some shapes."""
    sizes = [np.abs(values_of(shape, field)) for shape in shapes]
    return Colours(field, max((float(np.nanmax(v, initial=0.0)) for v in sizes), default=0.0))


def as_light(seen: Array) -> Array:
    """Return colours of sRGB, 0 to 255, as amounts of light from 0 to 1 (IEC 61966-2-1)."""
    share = seen / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
