"""The surface coloured by a field, and its bar of colours: one scale for all of a figure."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.errors import ModelError, ViewError
from ribbonopt.scene.faults import shown, suggestion

from .paper_style import sized
from .pieces import Array, Piece
from .style import INK
from .subject import Subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: what a surface can be coloured by: how a bar calls it, and its SI unit
FIELDS = {
    "u2": (r"bending strain $u_2$", "1/m"),
    "u3": (r"twisting strain $u_3$", "1/m"),
    "eta": (r"$\eta = u_3/u_2$", ""),
    "energy": ("energy per length", "J/m"),
}
BOTH_SIGNS, ONE_SIGN = "coolwarm", "viridis"  # colours of fields that change sign, and of others
LARGEST_RATIO = 1.0  # |eta| from which on colours are the same: there Sadowsky's ribbon ends
TINTS = 256
DARKEST = 0.72  # of a colour, where the light is least: the bar has to be found again


@dataclass(frozen=True, eq=False)
class Tint:
    """Colours of a field.

    Attributes
    ----------
    field : str
        One of `FIELDS`.
    low, high : float
        Values at the ends of the scale.
    table : (TINTS, 3) array
        Red, green and blue, from 0 to 1, from low to high.
    cut : tuple of bool
        Whether there are values below, and above.
    si : bool
        Whether values are in SI units.
    """

    field: str
    low: float
    high: float
    table: Array
    cut: tuple[bool, bool]
    si: bool

    def colours(self, piece: Piece) -> Array:
        """Return the colours (k - 1, 3) between the rows (k) of a piece."""
        values = getattr(piece, self.field)
        middle = (values[:-1] + values[1:]) / 2
        place = (middle - self.low) / (self.high - self.low) * (TINTS - 1)
        return np.asarray(self.table[np.clip(np.rint(place), 0, TINTS - 1).astype(int)])

    def bar(self, axes: Sequence[Axes], below: bool = False) -> None:
        """Draw the bar of colours beside axes, or below them."""
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import ListedColormap, Normalize
        from matplotlib.ticker import MaxNLocator

        words, unit = FIELDS[self.field]
        shades = ScalarMappable(Normalize(self.low, self.high), ListedColormap(self.table.tolist()))
        extend = {(True, True): "both", (True, False): "min", (False, True): "max"}
        bar = axes[0].figure.colorbar(
            shades,
            ax=list(axes),
            location="bottom" if below else "right",
            shrink=0.7,
            aspect=25,
            pad=0.02,
            extend=extend.get(self.cut, "neither"),
            label=f"{words}  [{unit}]" if self.si and unit else words,
            ticks=MaxNLocator(5),
        )
        bar.outline.set_visible(False)
        bar.ax.tick_params(labelsize=sized(9), colors=INK)


def check_field(field: str) -> None:
    """Refuse what no surface can be coloured by; ModelError."""
    if field and field not in FIELDS:
        near = suggestion(field, FIELDS)
        raise ModelError(f"color: found {shown(field)}, expected one of {', '.join(FIELDS)}{near}")


def tint_of(field: str, subjects: Sequence[Subject]) -> Tint | None:
    """Return the colours of a field on one scale for some ribbons; None for no field.

    Raises
    ------
    ModelError
        If no surface has such a field.
    ViewError
        If one of these has not.
    """
    check_field(field)
    if not field:
        return None
    if field == "eta":
        for subject in subjects:
            subject.demand_generatrices()
    pieces = [piece for subject in subjects for piece in subject.pieces]
    values = np.concatenate([getattr(piece, field) for piece in pieces])
    if not np.isfinite(values).all():
        raise ViewError(f"{subjects[0].name}: its law has no energy that it could be coloured by")
    least, most = float(values.min()), float(values.max())
    low, high, name = _scale(field, least, most)
    from matplotlib import colormaps

    table = colormaps[name](np.linspace(0, 1, TINTS))[:, :3]
    return Tint(field, low, high, table, (least < low, most > high), subjects[0].units.si)


def _scale(field: str, least: float, most: float) -> tuple[float, float, str]:
    """Return the ends of the scale and its colours: even about zero where both signs are there."""
    size = max(abs(least), abs(most))
    if field == "eta":
        size = min(size, LARGEST_RATIO)
    if size == 0:
        return -1.0, 1.0, BOTH_SIGNS
    noise = 1e-9 * size
    if least < -noise and most > noise:
        return -size, size, BOTH_SIGNS
    low, high = max(least, -size), min(most, size)
    if high - low <= 1e-6 * size:  # the same everywhere, but for rounding
        low, high = (0.0, size) if most > 0 else (-size, 0.0)
    return low, high, ONE_SIGN
