"""What files hold of a shape: names, meanings and units, one list for all formats.

Tables have a column for each component: `x`, `y`, `z` of the position, `d1x` ... of what else is
a vector in the lab frame.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ribbonopt.arrays import Array
from ribbonopt.scene.quantities import QUANTITIES
from ribbonopt.scene.units import Units
from ribbonopt.views.shape import Shape

AXES = "xyz"

#: units by exponents of (length, force): in SI, and where L and Dw are 1
_NAMES = {
    (0, 0): ("1", "1"),
    (1, 0): ("m", "L"),
    (-1, 0): ("1/m", "1/L"),
    (0, 1): ("N", "Dw/L^2"),
    (1, 1): ("N m", "Dw/L"),
}


class Quantity(NamedTuple):
    """What a name stands for, with the exponents of its dimension."""

    name: str
    means: str
    length: int = 0
    force: int = 0
    vector: bool = False

    def unit(self, units: Units) -> str:
        """Return its unit in words."""
        return _NAMES[self.length, self.force][not units.si]

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of its components in a table."""
        if not self.vector:
            return (self.name,)
        return tuple(AXES) if self.name == "r" else tuple(f"{self.name}{axis}" for axis in AXES)


def _known(name: str) -> Quantity:
    """Return a quantity that formulas know too."""
    found = QUANTITIES[name]
    return Quantity(name, found.means, found.length, found.force, found.shape == "vector")


S = Quantity("s", "arclength", length=1)
R = _known("r")
MIRRORED = Quantity("mirrored", "1 where it follows by symmetry from what was solved, else 0")
PIECE = Quantity("piece", "number of the piece; eta, n and strains may leap between two")
B = Quantity("b", "generatrix as drawn: the surface is r + v b", vector=True)
HALF_WIDTH = Quantity("half_width", "v goes from minus this to this", length=1)

#: at each point of a surface, and along the centre line
FIELDS = (
    S,
    *map(_known, ("u1", "u2", "u3", "eta", "n", "m", "d1", "d2", "d3", "energy")),
    MIRRORED,
)

#: along the directors
COMPONENTS = tuple(map(_known, ("n1", "n2", "n3", "m1", "m2", "m3")))

#: in each row of a table
ROWS = (S, R, *FIELDS[1:-1], *COMPONENTS, B, HALF_WIDTH, MIRRORED, PIECE)

SCALARS = tuple(field.name for field in (*FIELDS, *COMPONENTS) if not field.vector)


def values_of(shape: Shape, name: str) -> Array:
    """Return a quantity in all rows of a shape: (k,), or (k, 3) of a vector."""
    if name == HALF_WIDTH.name:
        return shape.half_widths
    if name == PIECE.name:
        return np.asarray(
            np.searchsorted(shape.starts, np.arange(len(shape.s)), "right") - 1, float
        )
    if name in (c.name for c in COMPONENTS):
        along = {1: shape.d1, 2: shape.d2, 3: shape.d3}[int(name[1])]
        vector = shape.n if name[0] == "n" else shape.m
        return np.asarray((vector * along).sum(axis=1))
    return np.asarray(getattr(shape, name), float)


def known_of(shape: Shape, wanted: tuple[Quantity, ...]) -> dict[str, Array]:
    """Return those quantities of a shape that have a value somewhere, by name."""
    found = {quantity.name: values_of(shape, quantity.name) for quantity in wanted}
    return {name: values for name, values in found.items() if not np.isnan(values).all()}
