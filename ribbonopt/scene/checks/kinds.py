"""Numbers of a scene by their place: dimension, limit in units L = 1, Dw = 1, and its reason."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from ribbonopt.scene import limits
from ribbonopt.scene.faults import KeyPath
from ribbonopt.scene.units import Units


class Kind(NamedTuple):
    """What numbers at a place are: dimension, limit in units L = 1, Dw = 1, and what sets it."""

    length: int
    force: int
    limit: float
    unit: str
    reason: str

    def unit_of(self, units: Units) -> float:
        """Return what 1 of the limit is in the units of the scene."""
        return units.length**self.length * units.force**self.force


_LENGTH = Kind(1, 0, limits.REACH, "L", "so far away, rounding is seen in the shape")
_FORCE = Kind(0, 1, limits.FORCE, "D w / L^2", "it acts on a millionth of the length")
_MOMENT = Kind(1, 1, limits.MOMENT, "D w / L", "it bends to a millionth of the length")
_STRAIN = Kind(-1, 0, limits.STRAIN, "1 / L", "it bends to a millionth of the length")
_PER_LENGTH = Kind(
    -1, 1, limits.FORCE_PER_LENGTH, "D w / L^3", "it acts on a millionth of the length"
)
_COUPLE = Kind(0, 1, limits.FORCE, "D w / L^2", "it bends to a millionth of the length")
_ANGLE = Kind(0, 0, limits.ANGLE, "rad", "angles so large lose their digits")
_TURNS = Kind(0, 0, limits.ANGLE / 6, "turns", "angles so large lose their digits")
_WIDTH = Kind(0, 0, limits.WIDTH, "", "it is in units of the ribbon's own width")
_SMOOTHING = Kind(0, 0, limits.SMOOTHING, "", "nothing is left of the law")

KINDS: Mapping[KeyPath, Kind] = {
    **{
        ("boundary", end, *key): kind
        for end in ("start", "end")
        for key, kind in {
            ("position",): _LENGTH,
            ("distance",): _LENGTH,
            ("force",): _FORCE,
            ("moment",): _MOMENT,
            ("directors", "rotation_vector"): _ANGLE,
            ("directors", "turns"): _ANGLE,
        }.items()
    },
    ("loads", "force"): _PER_LENGTH,
    ("loads", "couple"): _COUPLE,
    ("loads", "pressure"): _PER_LENGTH,
    ("loads", "points", "at"): _LENGTH,
    ("loads", "points", "force"): _FORCE,
    ("loads", "points", "moment"): _MOMENT,
    ("supports", "at"): _LENGTH,
    ("supports", "position"): _LENGTH,
    ("natural", "curvature"): _STRAIN,
    ("natural", "twist"): _STRAIN,
    ("natural", "across"): _STRAIN,
    ("guess", "force"): _FORCE,
    ("guess", "moment"): _MOMENT,
    ("guess", "strains"): _STRAIN,
    ("guess", "arc"): _ANGLE,
    ("guess", "helix", "turns"): _TURNS,
    ("reference", "n0"): _FORCE,
    ("reference", "m0"): _MOMENT,
    ("law", "epsilon"): _SMOOTHING,
    ("law", "natural"): _STRAIN,
    ("law", "width"): _LENGTH,
    ("law", "thickness"): _LENGTH,
    ("law", "zeta"): _LENGTH,
    ("width",): _WIDTH,
}
