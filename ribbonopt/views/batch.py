"""Figures of a batch: what came out, and columns against each other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.plain import SPECIALS, Rows, is_number
from ribbonopt.text import drawn

from .branch_style import COLOURS
from .columns import ColumnPair, as_text, is_logarithmic, is_numeric, numbers, varied, words
from .histogram import histogram_of
from .paper_style import sized, stroke
from .style import BENDING, FAINT, INK, TWIST, blank, draw_all, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

OUTCOMES = ("energy", "error", "seconds", "H0", "u2")  # those that vary, three of them
MOST = 4  # panels of a figure
PALETTE = tuple(colour for colour in COLOURS if colour != TWIST)  # which tells what failed


def save_batch_figures(
    rows: Rows, inputs: Sequence[str], folder: str | Path, pairs: Sequence[ColumnPair] = ()
) -> list[Path]:
    """Write outcomes.png and scatter.png, of branches special.png, into a folder; return where.

    Parameters
    ----------
    rows
        What came out, as in `rows.jsonl`.
    inputs
        Columns that were swept.
    folder
        Where, an existing one; files of these names are replaced.
    pairs
        Columns (x, y) of the first four panels of the scatter; the usual ones if there are none.

    Raises
    ------
    OutputError
        If a file cannot be drawn or written.
    """
    chosen = list(pairs) or usual_pairs(rows, inputs)
    drawings = {
        "outcomes.png": partial(plot_outcomes, rows),
        "scatter.png": partial(plot_scatter, rows, chosen, inputs),
    }
    if any(row.get(SPECIALS) for row in rows):
        from .special import plot_special

        drawings["special.png"] = partial(plot_special, rows, inputs)
    return draw_all(drawings, Path(folder)).paths


def usual_pairs(rows: Rows, inputs: Sequence[str]) -> list[ColumnPair]:
    """Return what is worth seeing: the inputs against the energy, and against each other."""
    swept = [key for key in inputs if is_numeric(rows, key)]
    if any(row.get(SPECIALS) for row in rows):
        return [((swept or ["number"])[0], "special1")]
    if not swept:
        return [(next((key for key in inputs if words(rows, key)[1:]), "number"), "energy")]
    return [*((key, "energy") for key in swept[:2]), *([(swept[0], swept[1])] if swept[1:] else [])]


def plot_outcomes(rows: Rows) -> Figure:
    """Draw how many ribbons ended how, and distributions of what varies; failed ones in orange."""
    from matplotlib.ticker import MaxNLocator

    counts = Counter((bool(row["verified"]), str(row["status"])) for row in rows)
    histograms = [found for name in OUTCOMES if (found := histogram_of(rows, name))][: MOST - 1]
    figure = blank(3.2 * (len(histograms) + 1), 3.2)
    axes, *others = np.atleast_1d(figure.subplots(1, len(histograms) + 1))
    # What is verified, and then what is frequent, at the top.
    for (verified, status), count in sorted(counts.items(), key=lambda item: (item[0][0], item[1])):
        bar = axes.barh(drawn(status), count, color=BENDING if verified else TWIST)
        axes.bar_label(bar, padding=3, fontsize=sized(9), color=INK)
    axes.margins(x=0.2)
    axes.set_xlabel("ribbons")
    axes.xaxis.set_major_locator(MaxNLocator(4, integer=True))
    for other, histogram in zip(others, histograms, strict=True):
        edges = np.array([histogram.edges(bar) for bar in histogram.bars]).reshape(-1, 2)
        good, bad = np.array([(bar.verified, bar.failed) for bar in histogram.bars]).T
        style = {"align": "edge", "edgecolor": "white", "lw": stroke(0.5)}
        other.bar(edges[:, 0], good, np.diff(edges)[:, 0], color=BENDING, **style)
        other.bar(edges[:, 0], bad, np.diff(edges)[:, 0], good, color=TWIST, **style)
        other.set(xlabel=drawn(histogram.name), xscale="log" if histogram.log else "linear")
        other.yaxis.set_major_locator(MaxNLocator(5, integer=True))
    for each in (axes, *others):
        tidy(each)
    return figure


def plot_scatter(rows: Rows, pairs: Sequence[ColumnPair], inputs: Sequence[str] = ()) -> Figure:
    """Draw pairs of columns, a panel each, the first four; failed ribbons as crosses.

    Where x is an input, colour tells another input; where x and y are both, the energy.
    """
    pairs = pairs[:MOST]
    width = len(pairs) if len(pairs) < MOST else 2
    height = -(-len(pairs) // width)
    figure = blank((5.6 if width < 3 else 4.7) * width, 4.2 * height)
    for i, pair in enumerate(pairs):
        axes = figure.add_subplot(height, width, i + 1)
        _panel(figure, axes, rows, pair, _shade(rows, pair, inputs))
    return figure


def _shade(rows: Rows, pair: ColumnPair, inputs: Sequence[str]) -> str:
    """Return the column that colours a panel; "" for none."""
    numeric = [key for key in inputs if varied(rows, key)]
    few = [key for key in inputs if 1 < len(words(rows, key)) <= len(PALETTE)]
    others = [key for key in dict.fromkeys((*numeric, *few)) if key not in pair]
    chosen = (*others, "energy") if not set(pair) <= set(inputs) else ("energy", *others)
    good = [row for row in rows if row["verified"]]
    return next((name for name in chosen if name not in pair and words(good, name)[1:]), "")


def _panel(figure: Figure, axes: Axes, rows: Rows, pair: ColumnPair, shade: str) -> None:
    good = [row for row in rows if row["verified"]]
    bad = [row for row in rows if not row["verified"]]
    scales = [_scale(rows, name) for name in pair]
    _draw(figure, axes, good, _points(good, pair, scales), shade)
    crosses = _points(bad, pair, scales)
    known = np.isfinite(crosses)
    marks: dict[str, Any] = {"marker": "x", "color": TWIST, "s": 22, "lw": stroke(1.2), "zorder": 3}
    axes.scatter(*crosses[known.all(axis=1)].T, **marks)
    # Those that have no answer are on the axis, which autoscaling knows nothing of.
    places = (axes.get_xaxis_transform(), axes.get_yaxis_transform())
    for k, transform in enumerate(places):
        alone = crosses[known[:, k] & ~known[:, 1 - k], k]
        if len(alone):
            ends = np.zeros((2, len(alone)))
            ends[k] = alone
            axes.scatter(*ends, transform=transform, clip_on=False, **marks)
            axes.update_datalim(np.column_stack([alone, alone]), updatex=k == 0, updatey=k == 1)
    axes.autoscale_view()
    if known.any():
        title = f"{int(known.any(axis=1).sum())} failed"
        axes.set_title(title, fontsize=sized(9), color=TWIST, loc="right")
    for axis, name, scale in zip("xy", pair, scales, strict=True):
        axes.set(**{f"{axis}label": drawn(name)})
        if isinstance(scale, list):
            labels = [drawn(word) for word in scale]
            axes.set(**{f"{axis}ticks": range(len(scale)), f"{axis}ticklabels": labels})
        else:
            axes.set(**{f"{axis}scale": scale})
    axes.grid(True, which="major", color=FAINT, alpha=0.2)
    tidy(axes)


def _draw(figure: Figure, axes: Axes, rows: Rows, points: np.ndarray, shade: str) -> None:
    """Draw the verified ribbons, coloured by a column of numbers or of a few words."""
    from matplotlib.colors import LogNorm
    from matplotlib.ticker import FuncFormatter, LogLocator

    style: dict[str, Any] = {"s": 9 if len(points) > 500 else 18, "lw": 0}
    if shade and is_numeric(rows, shade):
        values = np.array([_place(row.get(shade), "") for row in rows])
        norm = LogNorm() if is_logarithmic(numbers(rows, shade)) else None
        style |= {"c": values, "cmap": "viridis", "norm": norm, "plotnonfinite": True}
        dots = axes.scatter(*points.T, **style)
        bar = figure.colorbar(dots, ax=axes, label=drawn(shade), aspect=30, pad=0.02)
        if norm is not None:
            few = max(values[np.isfinite(values)]) < 1e3 * min(values[np.isfinite(values)])
            bar.ax.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5) if few else (1,)))
            bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            bar.minorticks_off()
        bar.outline.set_visible(False)
        bar.ax.tick_params(labelsize=sized(9))
    elif shade:
        known = words(rows, shade)
        which = np.array([as_text(row.get(shade)) for row in rows])
        for word, colour in zip(known, PALETTE, strict=False):
            axes.scatter(*points[which == word].T, color=colour, label=drawn(word), **style)
        axes.scatter(*points[which == ""].T, color=FAINT, **style)
        axes.legend(fontsize=sized(8), frameon=False, title=drawn(shade), title_fontsize=sized(8))
    else:
        axes.scatter(*points.T, color=BENDING, **style)


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
