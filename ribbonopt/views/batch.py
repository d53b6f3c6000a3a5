"""Figures of a batch: what came out, and columns against each other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.errors import OutputError

from .columns import Rows, is_logarithmic, is_number, is_numeric, numbers, varied
from .style import BENDING, FAINT, INK, TWIST, blank, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Pair = tuple[str, str]
OUTCOMES = ("energy", "error", "seconds", "H0", "u2")  # those that vary, three of them
MOST = 4  # panels of a figure


def save_batch_figures(
    rows: Rows, inputs: Sequence[str], folder: str | Path, pairs: Sequence[Pair] = ()
) -> list[Path]:
    """Write outcomes.png and scatter.png into an existing folder and return where.

    Parameters
    ----------
    rows
        What came out, as in `rows.jsonl`.
    inputs
        Columns that were swept.
    folder
        Where; files of these names are replaced.
    pairs
        Columns (x, y) of the first four panels of the scatter; the usual ones if there are none.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    chosen = list(pairs) or usual_pairs(rows, inputs)
    figures = {
        "outcomes.png": plot_outcomes(rows),
        "scatter.png": plot_scatter(rows, chosen, inputs),
    }
    paths = []
    for name, figure in figures.items():
        path = Path(folder) / name
        try:
            figure.savefig(path)
        except OSError as error:
            raise OutputError(f"{path}: cannot be written ({error.strerror})") from error
        paths.append(path)
    return paths


def usual_pairs(rows: Rows, inputs: Sequence[str]) -> list[Pair]:
    """Return what is worth seeing: the inputs against the energy, and against each other."""
    swept = [key for key in inputs if is_numeric(rows, key)]
    if not swept:
        return [("number", "energy")]
    return [*((key, "energy") for key in swept[:2]), *([(swept[0], swept[1])] if swept[1:] else [])]


def plot_outcomes(rows: Rows) -> Figure:
    """Draw how many ribbons ended how, and distributions of what varies."""
    counts = Counter(str(row["status"]) for row in rows).most_common()
    names = [name for name in OUTCOMES if varied(rows, name)][: MOST - 1]
    figure = blank(3.2 * (len(names) + 1), 3.2)
    axes, *others = np.atleast_1d(figure.subplots(1, len(names) + 1))
    words = [status for status, _ in counts]
    colours = [BENDING if status == "converged" else TWIST for status in words]
    axes.barh(words, [count for _, count in counts], color=colours)
    for i, (_, count) in enumerate(counts):
        axes.text(count, i, f" {count}", va="center", fontsize=9, color=INK)
    axes.margins(x=0.2)
    axes.set_xlabel("ribbons")
    for other, name in zip(others, names, strict=True):
        values = numbers(rows, name)
        log = is_logarithmic(values)
        edges = np.geomspace(min(values), max(values), 25) if log else 24
        other.hist(values, edges, color=BENDING)
        other.set(xlabel=name, xscale="log" if log else "linear")
    for each in (axes, *others):
        tidy(each)
    return figure


def plot_scatter(rows: Rows, pairs: Sequence[Pair], inputs: Sequence[str] = ()) -> Figure:
    """Draw pairs of columns, a panel each, the first four; failed ribbons as crosses.

    Where x is an input, colour tells another input; where x and y are both, the energy.
    """
    pairs = pairs[:MOST]
    width = 1 if len(pairs) == 1 else 2
    height = -(-len(pairs) // width)
    figure = blank(5.6 * width, 4.2 * height)
    for i, pair in enumerate(pairs):
        _panel(
            figure, figure.add_subplot(height, width, i + 1), rows, pair, _shade(rows, pair, inputs)
        )
    return figure


def _shade(rows: Rows, pair: Pair, inputs: Sequence[str]) -> str:
    """Return the column that colours a panel; "" for none."""
    others = [key for key in inputs if key not in pair and varied(rows, key)]
    chosen = (*others, "energy") if not set(pair) <= set(inputs) else ("energy", *others)
    return next((name for name in chosen if name not in pair and varied(rows, name)), "")


def _panel(figure: Figure, axes: Axes, rows: Rows, pair: Pair, shade: str) -> None:
    good = [row for row in rows if row["verified"]]
    bad = [row for row in rows if not row["verified"]]
    scales = [_scale(rows, name) for name in pair]
    points = _points(good, pair, scales)
    style: dict[str, Any] = {"s": 9 if len(points) > 500 else 18, "lw": 0}
    if shade:
        values = np.array([row.get(shade) for row in good], dtype=float)
        style |= {"c": values, "cmap": "viridis", "plotnonfinite": True}
        drawn = axes.scatter(points[:, 0], points[:, 1], **style)
        figure.colorbar(drawn, ax=axes, label=shade)
    else:
        axes.scatter(points[:, 0], points[:, 1], color=BENDING, **style)
    crosses = _points(bad, pair, scales)
    inside = crosses[np.isfinite(crosses).all(axis=1)]
    below = crosses[np.isfinite(crosses[:, 0]) & ~np.isfinite(crosses[:, 1])]
    marks: dict[str, Any] = {"marker": "x", "color": TWIST, "s": 22, "lw": 1.2}
    axes.scatter(inside[:, 0], inside[:, 1], **marks)
    if len(below):  # they have inputs, and no answer: on the axis
        foot = axes.get_xaxis_transform()
        axes.scatter(below[:, 0], np.zeros(len(below)), transform=foot, clip_on=False, **marks)
        anywhere = points[np.isfinite(points).all(axis=1), 1]
        level = np.full(len(below), anywhere[0] if len(anywhere) else 0.0)
        axes.update_datalim(np.column_stack([below[:, 0], level]))  # which that has not done
        axes.autoscale_view()
    if len(inside) + len(below):
        axes.set_title(f"{len(inside) + len(below)} failed", fontsize=9, color=TWIST, loc="right")
    for axis, name, scale in zip("xy", pair, scales, strict=True):
        axes.set(**{f"{axis}label": name})
        if isinstance(scale, list):
            axes.set(**{f"{axis}ticks": range(len(scale)), f"{axis}ticklabels": scale})
        else:
            axes.set(**{f"{axis}scale": scale})
    axes.grid(True, which="major", color=FAINT, alpha=0.2)
    tidy(axes)


def _scale(rows: Rows, name: str) -> str | list[str]:
    """Return the scale of an axis, or the words along it."""
    if is_numeric(rows, name) or not any(row.get(name) is not None for row in rows):
        return "log" if is_logarithmic(numbers(rows, name)) else "linear"
    return list(dict.fromkeys(str(row[name]) for row in rows if row.get(name) is not None))


def _points(rows: Rows, pair: Pair, scales: Sequence[str | list[str]]) -> np.ndarray:
    """Places (k, 2) of rows, NaN where there are none."""
    return np.array(
        [
            [_place(row.get(n), scale) for n, scale in zip(pair, scales, strict=True)]
            for row in rows
        ],
        dtype=float,
    ).reshape(-1, 2)


def _place(value: Any, scale: str | list[str]) -> float:
    if isinstance(scale, list):
        return np.nan if value is None else float(scale.index(str(value)))
    return float(value) if is_number(value) else np.nan
