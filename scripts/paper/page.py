"""A figure as a page of panels, two in a row, each above the table of its numbers (inches)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ribbonopt.views.style import BENDING, FAINT, INK, TWIST

from .numbers import Number, Table

GREEN, ORANGE = "#7fbf7b", "#f2a65a"  # the paper's: |eta| <= 1, and beyond
PALE_GREEN, PALE_ORANGE = "#e2f2df", "#fde6cc"
SOFT = (0, (5, 2.5))  # dashes of what follows by symmetry
DPI = 180
MINUS = "\N{MINUS SIGN}"
CELL, PANEL, ROW = 5.4, 3.7, 0.205  # inches: width of a cell, height of a panel, of a row
TOP, HEADING, GAP = 0.42, 0.34, 0.62  # over all panels, over each, between panel and table
LEFT, RIGHT = 0.72, 0.22  # margins of a panel in its cell
COLUMNS = (0.0, 0.5, 0.85)  # of a table, as shares of its width

__all__ = ["BENDING", "FAINT", "GREEN", "INK", "ORANGE", "SOFT", "TWIST", "Panel", "draw_page"]


@dataclass(frozen=True)
class Panel:
    """One panel of a figure.

    Attributes
    ----------
    letter, title
        As in the paper, and what it shows.
    draw
        Draws it into axes, of three dimensions where `solid`, without frame where `bare`.
    rows
        The numbers below it.
    """

    letter: str
    title: str
    draw: Callable[[Any], None]
    rows: Sequence[Number] = ()
    solid: bool = False
    bare: bool = False


def tables(figure: str, panels: Sequence[Panel]) -> list[Table]:
    """Return the numbers of a figure."""
    return [Table(figure, panel.letter, panel.rows) for panel in panels]


def draw_page(title: str, panels: Sequence[Panel], path: Path) -> None:
    """Draw panels and tables to files of a name, `.png` and `.pdf`."""
    lines = -(-len(panels) // 2)
    most = [max(len(p.rows) for p in panels[2 * i : 2 * i + 2]) for i in range(lines)]
    heights = [HEADING + PANEL + GAP + ROW * (rows + 1) + 0.2 for rows in most]
    width, height = 2 * CELL, TOP + sum(heights)
    figure = Figure(figsize=(width, height), facecolor="white")
    FigureCanvasAgg(figure)
    figure.text(0.3 / width, 1 - 0.24 / height, title, fontsize=12.5, weight="bold", va="center")
    for i, panel in enumerate(panels):
        below = height - TOP - sum(heights[: i // 2])
        left = CELL * (i % 2)
        foot = below - HEADING - PANEL
        heading = f"({panel.letter})  {panel.title}"
        figure.text((left + 0.3) / width, (below - 0.16) / height, heading, fontsize=10.5)
        margin = (0.15, 0.15, 0.28) if panel.solid or panel.bare else (LEFT, RIGHT, 0.0)
        box = (left + margin[0], foot - margin[2], CELL - margin[0] - margin[1], PANEL + margin[2])
        axes = figure.add_axes(
            (box[0] / width, box[1] / height, box[2] / width, box[3] / height),
            projection="3d" if panel.solid else None,
        )
        panel.draw(axes)
        if not (panel.solid or panel.bare):
            _tidy(axes)
        tall = ROW * (len(panel.rows) + 1)
        place = (left + LEFT - 0.3, foot - GAP - tall, CELL - LEFT - RIGHT + 0.3, tall)
        if panel.rows:
            _table(
                figure.add_axes(
                    (place[0] / width, place[1] / height, place[2] / width, place[3] / height)
                ),
                panel.rows,
            )
    if any(number.paper not in ("", number.as_printed) for p in panels for number in p.rows):
        words = "(!) the paper's last digit is another: see docs/paper.md"
        figure.text(1 - RIGHT / width, 0.1 / height, words, fontsize=8, ha="right", color=FAINT)
    for suffix in (".png", ".pdf"):
        figure.savefig(path.with_suffix(suffix), dpi=DPI)


def _tidy(axes: Axes) -> None:
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=9)


def _table(axes: Axes, rows: Sequence[Number]) -> None:
    """Write a head and the rows: name, value with its bar, what the paper prints."""
    axes.set(xlim=(0, 1), ylim=(len(rows) + 1, 0))
    axes.set_axis_off()
    printed = any(number.paper for number in rows)
    heads = ("", "computed", "paper" if printed else "")
    cells = [heads, *((n.name, n.written.replace("-", MINUS), _paper(n)) for n in rows)]
    for i, line in enumerate(cells):
        for x, text in zip(COLUMNS, line, strict=True):
            axes.text(x, i + 0.5, text, fontsize=8.6, va="center", color=INK if i else FAINT)
    axes.axhline(0.97, color=FAINT, lw=0.6)


def _paper(number: Number) -> str:
    if not number.paper:
        return ""
    agrees = number.as_printed == number.paper
    return number.paper.replace("-", MINUS) + ("" if agrees else "  (!)")
