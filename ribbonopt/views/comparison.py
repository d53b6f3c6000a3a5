"""Figures of comparisons: CPU time against error, a panel for each formulation and one of the best.

They take rows as plain mappings, as `comparison.json` and `benchmark.json` hold them; which of them
are on a frontier the rows say.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ribbonopt.classes import dataclass
from ribbonopt.text import drawn

from .comparison_panels import best_of_all, one_formulation, said, time_axes
from .comparison_rows import answered, grouped, limits, shown
from .comparison_style import legend_of
from .naming import Names, write_all
from .orders import draw_orders, ordered
from .style import FAINT, INK, blank, draw_all

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

# Of a figure; of a row of panels, of that of the best, of title and legend (inches).
WIDTH, HEIGHT, LAST, MARGIN = 12.0, 3.4, 5.0, 1.0
COLUMNS = 3


def plot_study(study: Mapping[str, Any]) -> Figure:
    """Plot CPU time against error, frontiers named; of a benchmark, measured orders below."""
    orders = ordered(study.get("slopes", ()), study["rows"])
    shape = Shape.of(study)
    if not orders:
        figure = blank(WIDTH, shape.height)
        names = _times(figure, study, shape)
    else:
        below = HEIGHT * math.ceil(len(orders) / COLUMNS) + MARGIN
        figure = blank(WIDTH, shape.height + below)
        grid = figure.add_gridspec(2, 1, height_ratios=[shape.height, below])
        above = figure.add_subfigure(grid[0, 0])
        under = figure.add_subfigure(grid[1, 0])
        names = _times(above, study, shape) | draw_orders(under, orders, COLUMNS)
    write_all(figure, names)
    return figure


def save_figure(study: Mapping[str, Any], path: str | Path) -> None:
    """Write the figure of a study; OutputError if it cannot be drawn or written."""
    path = Path(path)
    draw_all({path.name: partial(plot_study, study)}, path.parent)


@dataclass(frozen=True)
class Shape:
    """Numbers of panels: of formulations, their rows and columns, and whether one of the best."""

    count: int
    rows: int
    columns: int
    best: bool

    @classmethod
    def of(cls, study: Mapping[str, Any]) -> Shape:
        """Return the panels of a study: the best have one where it says more than the others."""
        count = len({row["formulation"] for row in study["rows"]})
        peers = bool(count and answered(study.get("peers", ())))
        best = peers or (count > 1 and bool(shown(study["rows"])))
        columns = max(1, min(COLUMNS, count))
        return cls(max(1, count), max(1, math.ceil(count / columns)), columns, best)

    @property
    def height(self) -> float:
        """Height of the figure."""
        single = LAST if self.columns == 1 else HEIGHT
        return single * self.rows + self.best * LAST + MARGIN

    def panels(self, figure: Figure | SubFigure) -> tuple[list[Axes], Axes | None, Axes | None]:
        """Make the panels: those of formulations, that of the best, and a place that is left."""
        heights = [HEIGHT] * self.rows + [LAST] * self.best
        grid = figure.add_gridspec(len(heights), self.columns, height_ratios=heights)
        first = figure.add_subplot(grid[0, 0])
        panels, left = [first], None
        for i in range(1, self.rows * self.columns):
            place = grid[i // self.columns, i % self.columns]
            if i < self.count:
                panels.append(figure.add_subplot(place, sharex=first, sharey=first))
            elif left is None:
                left = figure.add_subplot(place)
                left.set_axis_off()
        last = figure.add_subplot(grid[-1, :], sharex=first, sharey=first) if self.best else None
        return panels, last, left


def _times(figure: Figure | SubFigure, study: Mapping[str, Any], shape: Shape) -> Names:
    """Draw all panels of time against error; what is to be named in each."""
    panels, last, left = shape.panels(figure)
    floor = study.get("truth_error") or 0.0
    rows, peers = study["rows"], answered(study.get("peers", ()), floor)
    good = shown(rows, floor)
    names: Names = {}
    for axes, (name, own) in zip(panels, grouped(rows, "formulation").items(), strict=False):
        time_axes(axes, drawn(name))
        names[axes] = one_formulation(axes, own, shown(own, floor), good)
    if not rows:
        time_axes(panels[0], "")
        said(panels[0], rows)
    if last is not None:
        time_axes(last, "the best of each, and peers" if peers else "the best of each")
        names[last] = best_of_all(last, good, peers)
    x, y = limits([*good, *peers])
    panels[0].set(xlim=x, ylim=y)
    for i, axes in enumerate(panels):
        below = i + shape.columns >= shape.count
        axes.tick_params(labelleft=i % shape.columns == 0, labelbottom=below)
    for axes in [*panels, *([last] if last else [])]:
        for tolerance in study.get("tolerances", ()):
            axes.axvline(tolerance, color=FAINT, lw=0.6, ls=":", zorder=0)
    known = f"; the truth is known to {floor:.0e}" if floor else ""
    known += "; dotted: asked for" if study.get("tolerances") else ""
    lowest = [last] if last else panels[-shape.columns :]
    for axes in lowest:
        axes.set_xlabel(f"relative error of n(0), m(0){known}", color=INK)
    figure.supylabel(f"time of one solve ({_clock(study)})", fontsize=10, color=INK)
    figure.suptitle(
        drawn(study["name"], 60), x=0.01, ha="left", fontsize=12, fontweight="bold", color=INK
    )
    if good:
        legend_of(figure, left, good)
    return names


def _clock(study: Mapping[str, Any]) -> str:
    """Say how times were taken."""
    timing = study.get("timing") or {}
    said = ["CPU ms"]
    if timing.get("rounds"):
        said.append(f"median of {timing['rounds']}")
    loads = [timing.get("load_before"), timing.get("load_after")]
    if None not in loads:
        said.append(f"load {' to '.join(dict.fromkeys(f'{load:.1f}' for load in loads))}")
    return ", ".join(said)
