"""Figures of comparisons: time against error, and error against mesh with measured orders.

They take rows as plain mappings, as `comparison.json` and `benchmark.json` hold them.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ribbonopt.plain import Row, Rows
from ribbonopt.text import drawn

from .style import FAINT, INK, blank, draw_all, tidy, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure


# A colour for each formulation, a marker for each transcription, a dash for the states.
COLOURS = ("#1f5fa8", "#c2410c", "#2f7d32", "#7b3fa0", "#8a6d00", "#444444")
MARKERS = "osD^vP*X"
PEERS = ("black", "#777777", "#b0b0b0")
STATES: dict[str, Any] = {"reduced": "-", "full": (0, (3, 1.5))}
FLOOR = 1e-16  # errors that happen to vanish are drawn here


def plot_study(study: Mapping[str, Any]) -> Figure:
    """Plot time against error, one line for each pair; of a benchmark, orders beside it."""
    return _benchmark(study) if "slopes" in study else _comparison(study)


def _comparison(study: Mapping[str, Any]) -> Figure:
    figure = blank(9.5, 6.0)
    axes = figure.subplots()
    _work_precision(axes, study["rows"], study.get("peers", ()))
    for tolerance in study.get("tolerances", ()):
        axes.axvline(tolerance, color=FAINT, lw=0.5, ls=":", zorder=0)
    title(axes, study["name"])
    return figure


def _benchmark(study: Mapping[str, Any]) -> Figure:
    figure = blank(16.0, 6.5)
    left, right = figure.subplots(1, 2)
    _work_precision(left, study["rows"], study["peers"])
    _orders(right, study)
    title(left, study["name"])
    return figure


def save_figure(study: Mapping[str, Any], path: str | Path) -> None:
    """Write the figure of a study; OutputError if it cannot be drawn or written."""
    path = Path(path)
    draw_all({path.name: partial(plot_study, study)}, path.parent)


def _work_precision(axes: Axes, rows: Rows, peers: Rows) -> None:
    rows = _drawn(rows)
    styles = _styles(rows)
    for (pair,), points in _grouped(rows, ("pair",)).items():
        xy = sorted((max(row["error"], FLOOR), 1e3 * row["solve"]) for row in points)
        axes.plot(*zip(*_front(xy), strict=True), **styles[pair])
    for shade, ((name,), points) in zip(PEERS, _grouped(peers, ("name",)).items(), strict=False):
        xy = sorted((max(peer["error"], FLOOR), 1e3 * peer["solve"]) for peer in points)
        axes.plot(
            *zip(*xy, strict=True), label=drawn(name), color=shade, marker="x", ls=":", lw=1.6
        )
    axes.set(xscale="log", yscale="log")
    axes.invert_xaxis()
    axes.set_xlabel("relative error of n(0), m(0)")
    axes.set_ylabel("time of one solve (ms)")
    axes.grid(True, which="major", alpha=0.25)
    _plain_ticks(axes.yaxis)
    tidy(axes)
    _legend(axes, rows)


def _front(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points that no other of the same line beats in both error and time."""
    front: list[tuple[float, float]] = []
    for error, time in points:
        if not front or time < front[-1][1]:
            front.append((error, time))
    return front


def _orders(axes: Axes, study: Mapping[str, Any]) -> None:
    orders = {(slope["name"], slope["degree"]): slope["order"] for slope in study["slopes"]}
    styles = _styles(_drawn(study["rows"]))
    rows = [row for row in _drawn(study["rows"]) if row["states"] == "reduced"]
    for (pair, degree), points in _grouped(rows, ("pair", "degree")).items():
        if (pair, degree) not in orders:
            continue
        xy = sorted((row["intervals"] * row["steps"], max(row["error"], FLOOR)) for row in points)
        axes.plot(*zip(*xy, strict=True), **styles[pair])
        axes.annotate(
            f"{orders[pair, degree]:.1f}",
            xy[-1],
            xytext=(4, 0),
            textcoords="offset points",
            fontsize=7,
            color=styles[pair]["color"],
        )
    axes.set(xscale="log", yscale="log")
    axes.set_xlabel("intervals (shooting: steps)")
    axes.set_ylabel("relative error of n(0), m(0)")
    _plain_ticks(axes.xaxis)
    axes.set_title("measured orders at the ends; reduced states", loc="left", fontsize=10)
    axes.grid(True, which="major", alpha=0.25)
    tidy(axes)


def _legend(axes: Axes, rows: Rows) -> None:
    """One entry for each colour, marker and dash: there may be fifty pairs."""
    from matplotlib.lines import Line2D

    peers, names = axes.get_legend_handles_labels()
    colours, markers = _colours(rows), _markers(rows)
    handles = [Line2D([], [], color=colour, lw=3) for colour in colours.values()]
    handles += [Line2D([], [], color=INK, marker=marker, ls="") for marker in markers.values()]
    states = [name for name in STATES if any(row["states"] == name for row in rows)]
    handles += [Line2D([], [], color=INK, ls=STATES[name]) for name in states]
    labels = [*map(drawn, (*colours, *markers)), *(f"{name} states" for name in states), *names]
    axes.legend(
        [*handles, *peers],
        labels,
        loc="upper left",
        bbox_to_anchor=(1.01, 1.0),
        frameon=False,
        fontsize=9,
        labelcolor=INK,
        handlelength=3,
    )


def _plain_ticks(axis: Axis) -> None:
    """Ticks at 1, 2, 5, 10, ... in plain digits."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_locator(NullLocator())


def _drawn(rows: Rows) -> list[Row]:
    return [row for row in rows if row["verified"] and row["error"] is not None]


def _colours(rows: Rows) -> dict[str, str]:
    names = dict.fromkeys(row["formulation"] for row in rows)
    return dict(zip(names, cycle(COLOURS), strict=False))


def _markers(rows: Rows) -> dict[str, str]:
    names = dict.fromkeys(row["transcription"] for row in rows)
    return dict(zip(names, cycle(MARKERS), strict=False))


def _grouped(rows: Rows, keys: tuple[str, ...]) -> dict[tuple[Any, ...], list[Row]]:
    groups: dict[tuple[Any, ...], list[Row]] = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in keys), []).append(row)
    return groups


def _styles(rows: Rows) -> dict[str, dict[str, Any]]:
    colours, markers = _colours(rows), _markers(rows)
    return {
        row["pair"]: {
            "color": colours[row["formulation"]],
            "marker": markers[row["transcription"]],
            "linestyle": STATES[row["states"]],
            "markersize": 5,
            "lw": 1.3,
        }
        for row in rows
    }
