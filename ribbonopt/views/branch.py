"""Figures of a branch of equilibria: quantities against the parameter.

Points are plain mappings, one for each accepted point in order: `stage`, `branch`, `parameter` (a
dotted path), `value`, `kind`, `negative` (negative directions, None unknown) and quantities.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.plain import Row, Rows
from ribbonopt.solution.solution import Solution

from .columns import ColumnPair
from .pieces import Array
from .strip import plot_strip
from .style import BENDING, FAINT, INK, TWIST, Drawn, blank, draw_all, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.gridspec import SubplotSpec

Log = bool | Collection[str]

COLOURS = (BENDING, TWIST, "#009e73", "#cc79a7", "#56b4e9", "#e69f00")  # one for each branch
STABLE, UNSTABLE, UNKNOWN = "stable", "unstable", "stability unknown"
FOLD, BRANCH, BUCKLING, KINK = "fold", "branch point", "buckling point", "kink"
FIRST, LAST = "first point", "last point"
STYLES: dict[str, dict[str, Any]] = {
    STABLE: {"ls": "-", "lw": 2.0},
    UNSTABLE: {"ls": (0, (3.5, 1.8)), "lw": 1.6},
    UNKNOWN: {"ls": "-", "lw": 0.9},
    FIRST: {"ls": "", "marker": ".", "ms": 9, "color": FAINT, "zorder": 4},
    LAST: {"ls": "", "marker": "x", "ms": 5.5, "color": FAINT, "mew": 1.2, "zorder": 4},
    FOLD: {"ls": "", "marker": "s", "ms": 6.5, "mfc": INK, "mec": "w", "mew": 0.8, "zorder": 5},
    BRANCH: {"ls": "", "marker": "o", "ms": 7.5, "mfc": "w", "mec": INK, "mew": 1.4, "zorder": 6},
    KINK: {"ls": "", "marker": "^", "ms": 7.5, "mfc": "w", "mec": INK, "mew": 1.4, "zorder": 6},
    BUCKLING: {"ls": "", "marker": "D", "ms": 6.5, "mfc": "w", "mec": INK, "mew": 1.4, "zorder": 6},
}
SPECIAL = (FOLD, BRANCH, BUCKLING, KINK)
DOT = {"marker": "o", "ms": 3.5, "zorder": 4.5}  # a point alone
LABELS = {"number": "point", "negative": "negative directions", "error": "estimated error"}


def plot_branch(rows: Rows, x: str, y: str, *, log: Log = False, title: str = "") -> Figure:
    """Plot quantity y against x, where "value" is the parameter; rows without either are left out.

    Parameters that differ by stage get axes each. `log` says whether they are logarithmic, or which
    are; with values that are not positive they are not.
    """
    return _plot(rows, [(x, y)], log, title)


def save_branch_figures(
    rows: Rows,
    ribbons: Sequence[Solution],
    captions: Sequence[str],
    folder: str | Path,
    pairs: Sequence[ColumnPair],
    *,
    log: Log = False,
) -> Drawn:
    """Write branch.png, a panel for each of the first four pairs (x, y), and ribbons.png if any.

    That is left out, and it is said why, where a ribbon has no surface.
    """
    drawings = {"branch.png": partial(_plot, rows, pairs[:4], log)}
    if ribbons:
        drawings["ribbons.png"] = partial(plot_strip, ribbons, captions)
    return draw_all(drawings, Path(folder))


def _plot(rows: Rows, pairs: Sequence[ColumnPair], log: Log, title: str = "") -> Figure:
    """Draw a panel for each pair, and one legend under them."""
    most = max(len(_parameters(rows, pair)) for pair in pairs)
    columns = 1 if most > 1 or len(pairs) == 1 else 2
    count = math.ceil(len(pairs) / columns)
    width = min(1.5 + 4.0 * most, 14.0) if most > 1 else (7.2 if columns == 1 else 11.0)
    figure = blank(width, 5.4 if count == 1 else 3.8 * count + 0.6)
    grid = figure.add_gridspec(count, columns)
    for i, pair in enumerate(pairs):
        _panel(figure, grid[divmod(i, columns)], rows, pair, log)
    figure.axes[0].set_title(title, loc="left", fontsize=12, fontweight="bold")
    _legend(figure, rows, pairs)
    return figure


def _panel(figure: Figure, cell: SubplotSpec, rows: Rows, pair: ColumnPair, log: Log) -> None:
    """Draw one pair of quantities, on axes of each parameter if these differ."""
    parameters = _parameters(rows, pair)
    inner, first = cell.subgridspec(1, len(parameters)), None
    for i, parameter in enumerate(parameters):
        beside = first if pair[1] != "value" else None
        axes = figure.add_subplot(inner[i], sharey=beside)
        first = first or axes
        points = _draw(axes, rows, pair, parameter)
        for k in range(2):
            _scale(axes, k, pair[k], points[k], log if isinstance(log, bool) else parameter in log)
        axes.set_xlabel(_label(pair[0], parameter, rows))
        axes.set_ylabel("" if beside else _label(pair[1], parameter, rows))
        axes.grid(True, which="major", alpha=0.25)
        tidy(axes)
        axes.tick_params(labelleft=beside is None)


def _draw(axes: Axes, rows: Rows, pair: ColumnPair, parameter: str) -> Array:
    """Draw and return the points of a parameter; "" stands for all."""
    drawn = _drawn(rows, [pair])
    here = [row for row in drawn if parameter in ("", row["parameter"])]
    runs: dict[tuple[int, int], list[Row]] = {}
    for row in here:
        runs.setdefault((row["branch"], row["stage"]), []).append(row)
    plain = {"lw": 1.6} if all(_state(row) == UNKNOWN for row in rows) else {}
    for (branch, _), run in runs.items():
        for state, stretch in _stretches(run):
            style = STYLES[state] | plain | (DOT if len(stretch) == 1 else {})
            colour = COLOURS[branch % len(COLOURS)]
            axes.plot(*_points(stretch, pair), color=colour, label="_" if plain else state, **style)
    last = {row["branch"]: i for i, row in enumerate(drawn)}.values()
    marked = {name: [row for row in drawn if row["kind"] == name] for name in SPECIAL}
    marked |= {FIRST: drawn[:1], LAST: [drawn[i] for i in last if i]}
    for name, chosen in marked.items():
        chosen = [row for row in chosen if parameter in ("", row["parameter"])]
        if chosen:
            axes.plot(*_points(chosen, pair), label=name, **STYLES[name])
    if not here:
        axes.text(0.5, 0.5, "nothing recorded", ha="center", color=FAINT, transform=axes.transAxes)
    return _points(here, pair)


def _stretches(run: Sequence[Row]) -> list[tuple[str, list[Row]]]:
    """Cut a run of points where stability changes; a fold or branch point ends both stretches."""
    stretches = [(_state(run[0]), [run[0]])] if len(run) == 1 else []
    for a, b in pairwise(run):
        plain = [row for row in (a, b) if row["kind"] not in STYLES]
        states = {_state(row) for row in plain or (a, b)}
        state = states.pop() if len(states) == 1 else UNKNOWN
        if not stretches or stretches[-1][0] != state:
            stretches.append((state, [a]))
        stretches[-1][1].append(b)
    return stretches


def _state(row: Row) -> str:
    return UNKNOWN if row["negative"] is None else UNSTABLE if row["negative"] else STABLE


def _drawn(rows: Rows, pairs: Sequence[ColumnPair]) -> list[Row]:
    """Rows that have both quantities of one of some pairs."""
    return [row for row in rows if any(np.isfinite(_points([row], p)).all() for p in pairs)]


def _points(rows: Rows, pair: ColumnPair) -> Array:
    """Values (2, k) of both quantities, NaN where there are none."""
    return np.array([[row.get(quantity) for row in rows] for quantity in pair], float)


def _parameters(rows: Rows, pair: ColumnPair) -> list[str]:
    """Return the parameters that have axes of their own: "" stands for all."""
    names = list(dict.fromkeys(row["parameter"] for row in rows))
    return names if "value" in pair and names else [""]


def _label(quantity: str, parameter: str, rows: Rows) -> str:
    """Label of an axis; of one parameter among several, with its stages."""
    if quantity != "value" or len({row["parameter"] for row in rows}) < 2:
        return LABELS.get(quantity, parameter if quantity == "value" else quantity)
    stages = sorted({row["stage"] for row in rows if row["parameter"] == parameter})
    return f"{parameter}\nstage{'s' * (len(stages) > 1)} {', '.join(map(str, stages))}"


def _scale(axes: Axes, k: int, quantity: str, values: Array, log: bool) -> None:
    """Logarithmic if asked, for a parameter, and for errors; whole numbers where they count."""
    from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator

    axis = (axes.xaxis, axes.yaxis)[k]
    if quantity in ("number", "negative"):
        axis.set_major_locator(MaxNLocator("auto", integer=True))
    wanted = {"error": True, "value": log}.get(quantity, False)
    if wanted and min(values, default=0) > 0:
        axes.set(**{f"{'xy'[k]}scale": "log"})
        low, high = sorted(axis.get_view_interval())
        few = LogLocator(subs=(1, 2, 5)) if high < 1e3 * low else LogLocator()
        axis.set_major_locator(few if high > 10 * low else MaxNLocator(5))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_locator(NullLocator())


def _legend(figure: Figure, rows: Rows, pairs: Sequence[ColumnPair]) -> None:
    """Entries for branches if there are several, and for the lines and marks that are drawn."""
    from matplotlib.lines import Line2D

    drawn = _drawn(rows, pairs)
    names = {line.get_label() for axes in figure.axes for line in axes.lines}
    branches = sorted({row["branch"] for row in drawn})
    entries: dict[str, dict[str, Any]] = {}
    for branch in branches if len(branches) > 1 else []:
        entries[f"branch {branch}"] = {"color": COLOURS[branch % len(COLOURS)], "lw": 3}
    for name in (name for name in STYLES if name in names):
        count = sum(row["kind"] == name for row in drawn)
        entries[name + (f" ({count})" if count else "")] = {"color": INK} | STYLES[name]
    handles = [Line2D([], [], label=label, **style) for label, style in entries.items()]
    n = math.ceil(len(entries) / max(1, math.ceil(len(entries) / 5)))
    figure.legend(handles=handles, loc="outside lower center", ncols=n, frameon=False, fontsize=9)
