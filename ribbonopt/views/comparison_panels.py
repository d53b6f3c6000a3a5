"""Panels of time against error: the lines of one formulation, the frontiers of all and of peers."""

from __future__ import annotations

from collections.abc import Callable
from itertools import cycle
from textwrap import fill
from typing import TYPE_CHECKING, Any

from ribbonopt.plain import Row, Rows
from ribbonopt.text import drawn

from .comparison_rows import OVERALL, OWN, PAIR, at, best, by_decade, grouped, scheme_of, xy
from .comparison_style import BAND, PEERS, STATES, looks
from .naming import Name
from .style import INK, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LINES, LETTERS = 3, 52  # reasons that a panel without lines gives, letters of their lines


def time_axes(axes: Axes, name: str) -> None:
    """Prepare axes: logarithms, errors that shrink to the right, light grid, the name above."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

    axes.set(xscale="log", yscale="log")
    axes.xaxis.set_major_locator(LogLocator(base=100, numticks=12))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_locator(NullLocator())
    axes.grid(True, which="major", alpha=0.25)
    axes.set_title(name, loc="left", fontsize=10.5, fontweight="bold", color=INK)
    tidy(axes)


def one_formulation(axes: Axes, rows: Rows, good: Rows, every: Rows) -> list[Name]:
    """Draw the good rows of a formulation over the frontier of all; the names of its own."""
    if not good:
        said(axes, rows)
        return []
    axes.plot(*xy(best(every, OVERALL)), **BAND)
    schemes = looks(every, "transcription")
    for line in grouped(good, "pair").values():
        colour, marker = schemes[line[0]["transcription"]]
        look: dict[str, Any] = {"color": colour, "marker": marker, "lw": 0.9, "ms": 3.2}
        axes.plot(*xy(best(line, PAIR)), ls=STATES[line[0]["states"]], alpha=0.75, **look)
    own = best(good, OWN)
    _bold(axes, own, INK)
    for row in own:
        colour, marker = schemes[row["transcription"]]
        axes.plot(*xy([row]), color=colour, marker=marker, ms=6, mec=INK, mew=0.9, zorder=5)
    return _names(own, scheme_of, INK)


def best_of_all(axes: Axes, rows: Rows, peers: Rows) -> list[Name]:
    """Draw the frontiers of formulations, of all, and of peers; return the names."""
    forms: list[Name] = []
    colours = looks(rows, "formulation")
    for name, points in grouped(rows, "formulation").items():
        line, colour = best(points, OWN), colours[name].color
        axes.plot(*xy(line), color=colour, marker=".", ms=4, lw=1.0, alpha=0.8)
        forms.append(Name(drawn(name), at(line[0]), colour, bold=True))
    own = best(rows, OVERALL)
    _bold(axes, own, INK)
    axes.plot(*xy(own), "o", color=INK, ms=4.5, zorder=5)
    ends: list[Name] = []
    meshes = _names(own, lambda row: f"{drawn(row['formulation'])} {scheme_of(row)}", INK)
    for colour, (name, found) in zip(cycle(PEERS), grouped(peers, "name").items(), strict=False):
        line = sorted((peer for peer in found if peer["frontier"]), key=lambda peer: peer["error"])
        _bold(axes, line, colour)
        axes.plot(*xy(line), "X", color=colour, ms=5.5, zorder=5)
        ends.append(Name(drawn(name), at(line[-1]), colour, bold=True))
        meshes += _names(line, lambda peer: drawn(peer["detail"], 24), colour)
    return [*ends, *meshes, *forms]


def said(axes: Axes, rows: Rows) -> None:
    """Write in axes that hold no line why there is none."""
    reasons = dict.fromkeys(row["message"] for row in rows if row["message"])
    words = [fill(drawn(reason, 3 * LETTERS), LETTERS) for reason in list(reasons)[:LINES]]
    more = [f"and {len(reasons) - LINES} more reasons"] if len(reasons) > LINES else []
    text = "\n\n".join(["no verified solution of known error", *words, *more])
    axes.text(
        0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", fontsize=8, color=INK
    )


def _bold(axes: Axes, rows: Rows, colour: str) -> None:
    """Draw a frontier, and the quartiles of its times."""
    axes.plot(*xy(rows), color=colour, lw=2.0, zorder=3)
    for row in rows:
        if row["low"] is not None and row["high"] is not None:
            x, _ = at(row)
            ends = [1e3 * row["low"], 1e3 * row["high"]]
            axes.plot([x, x], ends, color=colour, lw=1.0, zorder=4)


def _names(rows: Rows, text: Callable[[Row], str], colour: str) -> list[Name]:
    """Return names of those rows of a frontier that are quickest to some power of ten."""
    return [Name(text(row), at(row), colour) for row in by_decade(rows)]
