"""Columns of a batch against each other: dots, coloured by another, or cells of a full grid."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.classes import dataclass
from ribbonopt.plain import Rows, is_number
from ribbonopt.text import drawn

from .branch_style import COLOURS
from .columns import ColumnPair, as_text, is_logarithmic, is_numeric, numbers, varied, words
from .heat import draw_heat, grid_of
from .paper_style import PLAIN, Style, area, sized, stroke
from .style import BENDING, FAINT, TWIST, blank, tidy
from .symbols import symbol

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.collections import PathCollection, QuadMesh
    from matplotlib.colors import LogNorm
    from matplotlib.figure import Figure

MOST = 4  # panels of a figure
PANEL = 2.4  # inches of one at least, where a page has a width
PALETTE = tuple(colour for colour in COLOURS if colour != TWIST)  # which tells what failed


def plot_batch(
    rows: Rows,
    x: str,
    y: str,
    *,
    inputs: Sequence[str] = (),
    labels: Mapping[str, str] | None = None,
    style: Style = PLAIN,
) -> Figure:
    """Plot column y of a batch against x; a full grid of two `inputs`, as cells.

    Colour tells `style.color`, a column, or else another input or the energy. `labels` are what
    columns are called beside axes, with formulas between $.
    """
    with style.applied():
        return plot_scatter(rows, [(x, y)], inputs, {**(labels or {}), **style.labels}, style)


def plot_scatter(
    rows: Rows,
    pairs: Sequence[ColumnPair],
    inputs: Sequence[str] = (),
    labels: Mapping[str, str] = MappingProxyType({}),
    style: Style = PLAIN,
) -> Figure:
    """Draw pairs of columns, a panel each, the first four; failed ribbons as crosses.

    Where x is an input, colour tells another input; where x and y are both, the energy, and a full
    grid of them is drawn as cells.
    """
    pairs = pairs[:MOST]
    width, height = across(len(pairs), style) if style.width else (len(pairs), 1)
    if len(pairs) == MOST:
        width, height = (1, MOST) if style.narrow else (2, 2)
    figure = blank((5.6 if width < 3 else 4.7) * width, 4.2 * height, style)
    for i, pair in enumerate(pairs):
        axes = figure.add_subplot(height, width, i + 1)
        shade = style.color or _shade(rows, pair, inputs)
        _panel(figure, axes, rows, pair, Coloured(shade, inputs, labels))
    return figure


@dataclass(frozen=True)
class Coloured:
    """The column that colours a panel, "" for none; what was swept; what columns are called."""

    shade: str
    inputs: Sequence[str]
    labels: Mapping[str, str]


def _shade(rows: Rows, pair: ColumnPair, inputs: Sequence[str]) -> str:
    """Return the column that colours a panel; "" for none."""
    numeric = [key for key in inputs if varied(rows, key)]
    few = [key for key in inputs if 1 < len(words(rows, key)) <= len(PALETTE)]
    others = [key for key in dict.fromkeys((*numeric, *few)) if key not in pair]
    chosen = (*others, "energy") if not set(pair) <= set(inputs) else ("energy", *others)
    good = [row for row in rows if row["verified"]]
    return next((name for name in chosen if name not in pair and words(good, name)[1:]), "")


def _panel(figure: Figure, axes: Axes, rows: Rows, pair: ColumnPair, look: Coloured) -> None:
    grid = grid_of(rows, pair, look.inputs)
    if grid is not None and is_numeric(rows, look.shade):
        norm = _norm(rows, look.shade)
        _bar(figure, axes, draw_heat(axes, grid, look.shade, norm), look)
        for axis, name in zip("xy", pair, strict=True):
            axes.set(**{f"{axis}label": symbol(name, look.labels)})
        failed = grid.failed.shape[1]
    else:
        failed = _scatter(figure, axes, rows, pair, look)
    if failed:
        axes.set_title(f"{failed} failed", fontsize=sized(9), color=TWIST, loc="right")
    tidy(axes)


def _scatter(figure: Figure, axes: Axes, rows: Rows, pair: ColumnPair, look: Coloured) -> int:
    """Draw ribbons as dots and crosses; return how many failed and are shown."""
    good = [row for row in rows if row["verified"]]
    bad = [row for row in rows if not row["verified"]]
    scales = [_scale(rows, name) for name in pair]
    _draw(figure, axes, good, _points(good, pair, scales), look)
    crosses = _points(bad, pair, scales)
    known = np.isfinite(crosses)
    marks: dict[str, Any] = {"marker": "x", "color": TWIST, "s": area(22), "lw": stroke(1.2)}
    axes.scatter(*crosses[known.all(axis=1)].T, zorder=3, **marks)
    # Those that have no answer are on the axis, which autoscaling knows nothing of.
    places = (axes.get_xaxis_transform(), axes.get_yaxis_transform())
    for k, transform in enumerate(places):
        alone = crosses[known[:, k] & ~known[:, 1 - k], k]
        if len(alone):
            ends = np.zeros((2, len(alone)))
            ends[k] = alone
            axes.scatter(*ends, transform=transform, clip_on=False, zorder=3, **marks)
            axes.update_datalim(np.column_stack([alone, alone]), updatex=k == 0, updatey=k == 1)
    axes.autoscale_view()
    for axis, name, scale in zip("xy", pair, scales, strict=True):
        axes.set(**{f"{axis}label": symbol(name, look.labels)})
        if isinstance(scale, list):
            labels = [drawn(word) for word in scale]
            axes.set(**{f"{axis}ticks": range(len(scale)), f"{axis}ticklabels": labels})
        else:
            axes.set(**{f"{axis}scale": scale})
    axes.grid(True, which="major", color=FAINT, alpha=0.2)
    return int(known.any(axis=1).sum())


def _draw(figure: Figure, axes: Axes, rows: Rows, points: np.ndarray, look: Coloured) -> None:
    """Draw the verified ribbons, coloured by a column of numbers or of a few words."""
    shade = look.shade
    style: dict[str, Any] = {"s": area(9 if len(points) > 500 else 18), "lw": 0}
    if shade and is_numeric(rows, shade):
        values = np.array([_place(row.get(shade), "") for row in rows])
        norm = _norm(rows, shade)
        style |= {"c": values, "cmap": "viridis", "norm": norm, "plotnonfinite": True}
        _bar(figure, axes, axes.scatter(*points.T, **style), look)
    elif shade:
        known = words(rows, shade)
        which = np.array([as_text(row.get(shade)) for row in rows])
        for word, colour in zip(known, PALETTE, strict=False):
            axes.scatter(*points[which == word].T, color=colour, label=drawn(word), **style)
        axes.scatter(*points[which == ""].T, color=FAINT, **style)
        called = symbol(shade, look.labels)
        axes.legend(fontsize=sized(8), frameon=False, title=called, title_fontsize=sized(8))
    else:
        axes.scatter(*points.T, color=BENDING, **style)


def _norm(rows: Rows, shade: str) -> LogNorm | None:
    """Return the scale of colours, None for an even one."""
    from matplotlib.colors import LogNorm

    good = [row for row in rows if row["verified"]]
    return LogNorm() if is_logarithmic(numbers(good, shade)) else None


def _bar(figure: Figure, axes: Axes, coloured: PathCollection | QuadMesh, look: Coloured) -> None:
    """Draw the bar of colours of what has some."""
    from matplotlib.colors import LogNorm
    from matplotlib.ticker import FuncFormatter, LogLocator

    called = symbol(look.shade, look.labels)
    bar = figure.colorbar(coloured, ax=axes, label=called, aspect=30, pad=0.02)
    if isinstance(coloured.norm, LogNorm):
        low, high = coloured.get_clim()
        few = high < 1e3 * low
        bar.ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if few else (1,)))
        bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        bar.minorticks_off()
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=sized(9))


def _scale(rows: Rows, name: str) -> str | list[str]:
    """Return the scale of an axis, or the words along it."""
    if is_numeric(rows, name) or not words(rows, name):
        wide = name != "number" and is_logarithmic(numbers(rows, name))
        return "log" if wide else "linear"
    return words(rows, name)


def _points(rows: Rows, pair: ColumnPair, scales: Sequence[str | list[str]]) -> np.ndarray:
    """Places (k, 2) of rows, NaN where there are none."""
    places = [
        {word: i for i, word in enumerate(scale)} if isinstance(scale, list) else scale
        for scale in scales
    ]
    found = [[_place(row.get(n), p) for n, p in zip(pair, places, strict=True)] for row in rows]
    return np.array(found, dtype=float).reshape(-1, 2)


def _place(value: Any, places: str | dict[str, int]) -> float:
    if isinstance(places, dict):
        return places.get(as_text(value), np.nan)
    return float(value) if is_number(value) else np.nan


def across(count: int, style: Style) -> tuple[int, int]:
    """Return how many panels stand beside each other, and below: few where a page is narrow."""
    most = count if style.width is None else max(1, int(style.width / PANEL))
    height = -(-count // most)
    return -(-count // height), height
