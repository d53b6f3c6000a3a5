"""Panels of measured orders: error against mesh, one for each transcription."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from ribbonopt.plain import Row, Rows
from ribbonopt.text import drawn

from .comparison_rows import grouped, shown
from .comparison_style import Look, looks
from .naming import Name, Names
from .style import INK, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

WIDEST, THINNER = 6.0, 0.62  # lines that lie on each other show: each thinner than that below it


class Line(NamedTuple):
    """The rows of a pair at a degree, from coarse to fine, and the slope they show."""

    formulation: str
    degree: int
    order: float
    rows: tuple[Row, ...]


Orders = dict[str, list[Line]]


def ordered(slopes: Rows | Sequence[Row], rows: Rows) -> Orders:
    """Return the lines of each transcription; those of reduced states, where there are any."""
    good = shown(rows)
    states = "reduced" if any(row["states"] == "reduced" for row in good) else "full"
    found: Orders = {}
    pairs = grouped([row for row in good if row["states"] == states], "pair")
    for slope in slopes:
        own = [row for row in pairs.get(slope["name"], ()) if row["degree"] == slope["degree"]]
        if own:
            own.sort(key=_cells)
            line = Line(own[0]["formulation"], slope["degree"], slope["order"], tuple(own))
            found.setdefault(own[0]["transcription"], []).append(line)
    return found


def draw_orders(figure: Figure | SubFigure, orders: Orders, columns: int) -> Names:
    """Draw a panel for each transcription; the names of degrees, with their orders."""
    columns = min(columns, len(orders))
    grid = figure.subplots(
        math.ceil(len(orders) / columns), columns, sharex=True, sharey=True, squeeze=False
    )
    panels = list(grid.ravel())
    colours = looks(
        [row for lines in orders.values() for line in lines for row in line.rows], "formulation"
    )
    names: Names = {}
    for axes, (name, lines) in zip(panels, orders.items(), strict=False):
        _axes(axes, drawn(name))
        names[axes] = _lines(axes, lines, colours)
    for axes in panels[len(orders) :]:
        axes.set_axis_off()
    for i, axes in enumerate(panels[: len(orders)]):
        below = i + columns >= len(orders)
        axes.tick_params(labelleft=i % columns == 0, labelbottom=below)
        if below:
            axes.set_xlabel("intervals (explicit shooting: steps)", color=INK)
    cells = [_cells(row) for lines in orders.values() for line in lines for row in line.rows]
    panels[0].set_xlim(min(cells) / 1.3, max(cells) * 2.2)  # names of degrees stand at the right
    words = "measured orders: slopes, of each degree the median over formulations"
    figure.suptitle(words, x=0.01, ha="left", fontsize=12, fontweight="bold", color=INK)
    figure.supylabel("relative error of n(0), m(0)", fontsize=10, color=INK)
    _legend(figure, colours)
    return names


def _lines(axes: Axes, lines: Sequence[Line], colours: dict[str, Look]) -> list[Name]:
    names: list[Name] = []
    by_degree: dict[int, list[Line]] = {}
    for line in lines:
        by_degree.setdefault(line.degree, []).append(line)
    for degree, own in by_degree.items():
        for i, line in enumerate(own):
            colour, marker = colours[line.formulation]
            axes.plot(
                [_cells(row) for row in line.rows],
                [row["error"] for row in line.rows],
                color=colour,
                marker=marker,
                lw=WIDEST * THINNER**i,
                ms=2.5 + WIDEST * THINNER**i,
                alpha=0.85,
                zorder=2 + i,
            )
        middle = sorted(own, key=lambda line: line.order)[len(own) // 2]
        words = f"degree {degree}: {middle.order:.1f}" if degree else f"order {middle.order:.1f}"
        names.append(Name(words, (_cells(middle.rows[-1]), middle.rows[-1]["error"]), bold=True))
    return names


def _axes(axes: Axes, name: str) -> None:
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    axes.set(xscale="log", yscale="log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_major_locator(LogLocator(base=100, numticks=12))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_locator(NullLocator())
    axes.set_title(name, loc="left", fontsize=10.5, fontweight="bold", color=INK)
    axes.grid(True, which="major", alpha=0.25)
    tidy(axes)


def _legend(figure: Figure | SubFigure, colours: dict[str, Look]) -> None:
    from matplotlib.lines import Line2D

    figure.legend(
        [Line2D([], [], color=c, marker=marker, lw=1.5, ms=5) for c, marker in colours.values()],
        [drawn(name) for name in colours],
        loc="outside lower center",
        ncols=min(len(colours), 5),
        frameon=False,
        fontsize=9,
        labelcolor=INK,
    )


def _cells(row: Row) -> int:
    return int(row["intervals"] * row["steps"])
