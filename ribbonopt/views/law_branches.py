"""Figure of a branch under several laws, one diagram over the other, with special points.

It takes laws as plain mappings, as `laws.json` holds them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.plain import Row
from ribbonopt.text import drawn

from .branch_axes import label
from .branch_style import mark_of
from .columns import varied
from .curves import Array, curves_through
from .laws import COLOURS
from .style import INK, SI, SPECIAL, blank, tidy, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST = 4  # panels
POINT, FOLD, KINK = "point", "fold", "kink"
MARKS = {"fold": "s", "branch point": "o", "buckling point": "D", "kink": "v"}
WIDTHS = 3.0, 1.3  # of the lines of the first law and of the last, so that both are seen


def plot_law_branches(study: Mapping[str, Any]) -> Figure:
    """Plot what varies along the branches of all laws, a panel for each quantity."""
    laws = [law for law in study["laws"] if law["points"]]
    rows = [row for law in laws for row in law["points"]]
    pairs = [tuple(p) for p in study["pairs"] if varied(rows, p[1])] or list(study["pairs"])
    pairs = pairs[:MOST]
    columns = 1 if len(pairs) == 1 else 2
    lines = max(1, math.ceil(len(pairs) / columns))
    figure = blank(7.6 if columns == 1 else 11.5, 3.9 * lines + 1.0)
    grid = figure.add_gridspec(lines, columns)
    si = str(study["units"]).startswith("SI")
    for k, (x, y) in enumerate(pairs):
        axes = figure.add_subplot(grid[divmod(k, columns)])
        for i, law in enumerate(laws):
            _branch(axes, law["points"], (x, y), i, len(laws))
        if x in study["log"] and all(row[x] > 0 for row in rows):
            axes.set_xscale("log")
        axes.set_xlabel(drawn("parameter of the stage") if x == "value" else label(x, si))
        axes.set_ylabel(label(y, si))
        axes.grid(True, alpha=0.25)
        tidy(axes)
    if figure.axes:
        title(figure.axes[0], study["name"])
        last = figure.axes[min(columns, len(figure.axes)) - 1]
        last.set_title(SI if si else SPECIAL, loc="right", fontsize=9)
    _legend(figure, laws)
    return figure


def _branch(
    axes: Axes, rows: Sequence[Row], pair: tuple[str, str], number: int, count: int
) -> None:
    """Draw the pieces of one law's branches: full where stable or not known, else dashed."""
    colour = COLOURS[number % len(COLOURS)]
    width = WIDTHS[0] + (WIDTHS[1] - WIDTHS[0]) * number / max(count - 1, 1)
    order = 2 + 0.1 * number
    for piece in _pieces(rows):
        points = np.array([_point(row, pair) for row in piece], dtype=float).T
        good = np.isfinite(points).all(axis=0)
        points, piece = points[:, good], [row for row, ok in zip(piece, good, strict=True) if ok]
        for curve, stable in _curves(piece, points):
            dash: Any = "-" if stable else (0, (3.5, 1.8))
            axes.plot(*curve, color=colour, lw=width, ls=dash, zorder=order)
    for row in rows:
        if row["kind"] != POINT:
            marker = MARKS.get(mark_of(row), "*")
            look: dict[str, Any] = {
                "mfc": "w",
                "mec": colour,
                "mew": 1.4,
                "ms": 7,
                "zorder": 6 + 0.1 * number,
            }
            axes.plot(*[[v] for v in _point(row, pair)], marker, **look)


def _pieces(rows: Sequence[Row]) -> Iterator[list[Row]]:
    """Yield the rows of each branch, that where it leaves another first."""
    numbered = {row["number"]: row for row in rows}
    for _, found in groupby(rows, key=lambda row: (row["stage"], row["branch"])):
        piece = list(found)
        origin = numbered.get(piece[0].get("origin"))
        yield [origin, *piece] if origin is not None else piece


def _curves(rows: Sequence[Row], points: Array) -> Iterator[tuple[Array, bool]]:
    """Yield a curve from each point to the next, and whether it is not known to be unstable."""
    if len(rows) < 2:
        return
    size = np.ptp(points, axis=1)
    size = np.where(size > 0, size, 1.0)[:, None]
    corners = [i for i, row in enumerate(rows) if row["kind"] == KINK]
    found = curves_through(points / size, corners)
    for i, curve in enumerate(found):
        counts = [row["negative"] for row in rows[i : i + 2] if row["negative"] is not None]
        yield curve * size, not (counts and all(counts))


def _point(row: Row, pair: tuple[str, str]) -> tuple[float, float]:
    x, y = (row[row["parameter"]] if name == "value" else row.get(name) for name in pair)
    return tuple(math.nan if v is None else float(v) for v in (x, y))  # type: ignore[return-value]


def _legend(figure: Figure, laws: Sequence[Row]) -> None:
    """Name laws, lines and marks under the figure."""
    from matplotlib.lines import Line2D

    handles = []
    for i, law in enumerate(laws):
        numbers = f" ({law['numbers']})" if law["numbers"] else ""
        text = drawn(law["law"] + numbers, 80)
        handles.append(Line2D([], [], label=text, color=COLOURS[i % len(COLOURS)], lw=3))
    rows = [row for law in laws for row in law["points"]]
    if any(row["negative"] for row in rows):
        handles.append(Line2D([], [], label="unstable", color=INK, ls=(0, (3.5, 1.8))))
    kinds = {mark_of(row) for row in rows if row["kind"] != POINT}
    for kind in sorted(kinds):
        look: dict[str, Any] = {
            "marker": MARKS.get(kind, "*"),
            "mfc": "w",
            "mec": INK,
            "ls": "",
            "ms": 7,
        }
        handles.append(Line2D([], [], label=kind, **look))
    columns = min(3 if figure.get_figwidth() > 9 else 2, max(1, len(handles)))
    figure.legend(
        handles=handles, loc="outside lower center", ncols=columns, frameon=False, fontsize=9
    )
