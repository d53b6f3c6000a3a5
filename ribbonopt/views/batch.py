"""Figures of a batch: what came out, and columns against each other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.plain import SPECIALS, Rows
from ribbonopt.text import drawn

from .columns import ColumnPair, is_numeric, words
from .histogram import histogram_of
from .paper_style import PLAIN, Style, sized, stroke
from .scatter import MOST, across, plot_scatter
from .style import BENDING, INK, TWIST, blank, draw_all, tidy
from .symbols import symbol

if TYPE_CHECKING:
    from matplotlib.figure import Figure

OUTCOMES = ("energy", "error", "seconds", "H0", "u2")  # those that vary, three of them


def save_batch_figures(
    rows: Rows,
    inputs: Sequence[str],
    folder: str | Path,
    pairs: Sequence[ColumnPair] = (),
    labels: Mapping[str, str] = MappingProxyType({}),
    style: Style = PLAIN,
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
    labels
        What columns are called beside axes, where the study says it.
    style
        Size, type, files, and the column that colours panels.

    Raises
    ------
    OutputError
        If a file cannot be drawn or written.
    """
    chosen, labels = list(pairs) or usual_pairs(rows, inputs), {**labels, **style.labels}
    drawings = {
        "outcomes.png": partial(plot_outcomes, rows, labels, style),
        "scatter.png": partial(plot_scatter, rows, chosen, inputs, labels, style),
    }
    if any(row.get(SPECIALS) for row in rows):
        from .special import plot_special

        drawings["special.png"] = partial(plot_special, rows, inputs, labels, style)
    return draw_all(drawings, Path(folder), style).paths


def usual_pairs(rows: Rows, inputs: Sequence[str]) -> list[ColumnPair]:
    """Return what is worth seeing: the inputs against the energy, and against each other."""
    swept = [key for key in inputs if is_numeric(rows, key)]
    if any(row.get(SPECIALS) for row in rows):
        return [((swept or ["number"])[0], "special1")]
    if not swept:
        return [(next((key for key in inputs if words(rows, key)[1:]), "number"), "energy")]
    return [*((key, "energy") for key in swept[:2]), *([(swept[0], swept[1])] if swept[1:] else [])]


def plot_outcomes(
    rows: Rows, labels: Mapping[str, str] = MappingProxyType({}), style: Style = PLAIN
) -> Figure:
    """Draw how many ribbons ended how, and distributions of what varies; failed ones in orange."""
    from matplotlib.ticker import MaxNLocator

    counts = Counter((bool(row["verified"]), str(row["status"])) for row in rows)
    histograms = [found for name in OUTCOMES if (found := histogram_of(rows, name))][: MOST - 1]
    width, height = across(len(histograms) + 1, style)
    figure = blank(3.2 * width, 3.2 * height, style)
    axes, *others = figure.subplots(height, width, squeeze=False).flat
    for spare in others[len(histograms) :]:
        spare.remove()
    others = others[: len(histograms)]
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
        look: dict[str, Any] = {"align": "edge", "edgecolor": "white", "lw": stroke(0.5)}
        other.bar(edges[:, 0], good, np.diff(edges)[:, 0], color=BENDING, **look)
        other.bar(edges[:, 0], bad, np.diff(edges)[:, 0], good, color=TWIST, **look)
        other.set(
            xlabel=symbol(histogram.name, labels), xscale="log" if histogram.log else "linear"
        )
        other.yaxis.set_major_locator(MaxNLocator(5, integer=True))
    for each in (axes, *others):
        tidy(each)
    return figure
