"""Axes of the figures of a branch: what they are called, in which units, on which scale."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

from ribbonopt.scene.quantities import START_VECTORS

from .branch_rows import VALUE, Plane
from .columns import LEAST, NOISE
from .symbols import symbol

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis

COUNTS = ("number", "stage", "branch", "negative", "intervals", "iterations")
MARGIN = 0.08  # of the axes, beside what is drawn: room for numbers
LABELS = {"number": "point", "negative": "negative directions", "error": "estimated error"}
UNITS = {"energy": "J", "potential": "J", "H0": "N"} | {
    name: unit
    for names, unit in zip(START_VECTORS, ("N", "N m", "1/m"), strict=True)
    for name in names
}
#: SI units of numbers of a scene, by a word of their path; a load is a force per length
PARTS = {
    **dict.fromkeys(("position", "distance", "interval", "length", "width", "thickness"), "m"),
    **{"force": "N", "moment": "N m", "youngs_modulus": "Pa"},
}


#: columns of small vibrations along a branch: the symbol and its unit in SI
VIBRATIONS = {
    "frequency": {False: (r"$\omega_{{{}}}$", ""), True: ("$f_{{{}}}$", "Hz")},
    "squared": {False: (r"$\omega_{{{}}}^2$", ""), True: (r"$\omega_{{{}}}^2$", "1/s²")},
}
NUMBERED = re.compile(r"(frequency|squared)([1-9][0-9]*)")


def unit_of(column: str, si: bool) -> str:
    """Return the unit of a column; "" where it has none, or none that is known."""
    if not si:
        return ""
    if found := NUMBERED.fullmatch(column):
        return VIBRATIONS[found[1]][si][1]
    parts = column.split(".")
    if parts[0] == "loads":
        return "N/m" if "force" in parts else ""
    if parts[0] not in ("boundary", "interval", "ribbon"):
        return UNITS.get(column, "")
    return next((PARTS[part] for part in parts if part in PARTS), "")


def label(column: str, si: bool, labels: Mapping[str, str] = MappingProxyType({})) -> str:
    """Return the words for a column, with its unit; `labels` are those that a scene gives."""
    unit = unit_of(column, si)
    if (found := NUMBERED.fullmatch(column)) and column not in labels:
        return VIBRATIONS[found[1]][si][0].format(found[2]) + (f" ({unit})" if unit else "")
    words = symbol(column, labels) if column in labels else LABELS.get(column)
    return (words or symbol(column, labels)) + (f" ({unit})" if unit else "")


def dress(axes: Axes, plane: Plane) -> None:
    """Label and scale both axes."""
    for k in range(2):
        axis, name = (axes.xaxis, axes.yaxis)[k], plane.name(k)
        axis.set_label_text(label(name, plane.figure.si, plane.figure.labels) + _stages(plane, k))
        if name in COUNTS:
            from matplotlib.ticker import MaxNLocator

            axis.set_major_locator(MaxNLocator("auto", integer=True))
        if plane.flat(k):
            low, high = plane.points(plane.rows)[k].min(), plane.points(plane.rows)[k].max()
            room = abs(low + high) / 4 if abs(low + high) > NOISE * LEAST else 1.0
            # Before the scale, of whose change older matplotlib would make no room, but a warning.
            axes.set(**{f"{'xy'[k]}lim": (low - room, high + room)})
        else:
            (axes.set_xmargin, axes.set_ymargin)[k](MARGIN)
        if plane.log[k]:
            axes.set(**{f"{'xy'[k]}scale": "log"})
            _decades(axis)


def _stages(plane: Plane, k: int) -> str:
    """Return the stages of one parameter among several, "" where there is one for all."""
    if plane.pair[k] != VALUE or not plane.parameter:
        return ""
    rows = plane.figure.rows
    stages = sorted({row["stage"] + 1 for row in rows if row["parameter"] == plane.parameter})
    return f"\nstage{'s' * (len(stages) > 1)} {', '.join(map(str, stages))}"


def _decades(axis: Axis) -> None:
    """Few ticks in plain digits."""
    from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator

    low, high = sorted(axis.get_view_interval())
    few = LogLocator(subs=(1, 2, 5)) if high < 1e3 * low else LogLocator()
    axis.set_major_locator(few if high > 10 * low else MaxNLocator(5))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())
