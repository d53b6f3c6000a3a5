"""The figure of a study of stress: a row for each kind of trial.

On the left what trials came to, a bar for each value, a colour for each verdict; on the right how
many of sixteen digits the answers lost, and the condition of their equations. It takes rows as
plain mappings, as `stress.json` holds them, of one scene or of many.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ribbonopt.plain import Row, Rows
from ribbonopt.text import drawn

from .style import FAINT, INK, blank, draw_all, tidy, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: verdicts in the order in which they are stacked
COLOURS = {
    "solved": "#2f7d32",
    "another equilibrium": "#8fc98f",
    "honest failure": "#c9c9c9",
    "unconfirmed": "#e0b34a",
    "crashed": "#7b3fa0",
    "wrong": "#c2410c",
}
DIGITS, CONDITION = "#1f5fa8", "#8a6d00"
WIDTH, ROW, HEAD = 13.0, 1.25, 1.0  # inches
TOLD = ("wrong", "crashed")  # over the bar, however few they are
SMALL: dict[str, Any] = {"ha": "center", "fontsize": 7}
THIN = 0.13  # share of a bar that has no room for a number
LETTERS = 26  # of a value under its bar
SPREAD = 0.3  # of dots beside each other, over the distance of bars
MOST, LARGEST = 16.0, 1e20  # digits; conditions that are drawn


def plot_stress(study: Mapping[str, Any]) -> Figure:
    """Plot verdicts by kind and value, and digits and conditions beside them."""
    groups: dict[str, list[Row]] = {}
    for row in study["rows"]:
        groups.setdefault(row["kind"], []).append(row)
    figure = blank(WIDTH, HEAD + ROW * max(1, len(groups)))
    if not groups:
        title(figure.subplots(), f"{study['name']}: no trials")
        return figure
    axes = figure.subplots(len(groups), 2, squeeze=False)
    for (left, right), (kind, rows) in zip(axes, groups.items(), strict=True):
        labels = list(dict.fromkeys(row["label"] for row in rows))
        _verdicts(left, kind, rows, labels)
        _numbers(right, rows, labels)
    title(axes[0][0], study["name"], 14)
    axes[0][1].set_title(
        "digits lost of 16 (dots) and condition (crosses)", loc="left", fontsize=10, pad=14
    )
    _legend(figure, study["rows"])
    return figure


def save_figure(study: Mapping[str, Any], path: str | Path) -> None:
    """Write the figure of a study; PictureError if it cannot be drawn or written."""
    path = Path(path)
    draw_all({path.name: partial(plot_stress, study)}, path.parent)


def _verdicts(axes: Axes, kind: str, rows: Rows, labels: list[str]) -> None:
    """Draw a bar of shares for each value, on it how many are not solved, over it what is wrong."""
    for at, label in enumerate(labels):
        counts = Counter(row["verdict"] for row in rows if row["label"] == label)
        bottom, whole = 0.0, counts.total()
        for verdict, colour in COLOURS.items():
            if not (count := counts[verdict]):
                continue
            share = count / whole
            axes.bar(at, share, 0.86, bottom, color=colour, linewidth=0)
            if whole > 1 and verdict in TOLD:
                axes.text(at, 1.02, f"{count} {verdict}", color=colour, va="bottom", **SMALL)
            elif verdict != "solved" and share > THIN:
                axes.text(at, bottom + share / 2, str(count), color=INK, va="center", **SMALL)
            bottom += share
    axes.set_ylim(0, 1)
    axes.set_yticks([])
    axes.set_ylabel(drawn(kind), rotation=0, ha="right", va="center", color=INK, fontsize=10)
    _values(axes, labels)
    axes.spines[["top", "right", "left"]].set_visible(False)


def _numbers(axes: Axes, rows: Rows, labels: list[str]) -> None:
    """Draw digits lost on the left scale, the condition on the right one, trials side by side."""
    beside = axes.twinx()
    for at, label in enumerate(labels):
        some = [row for row in rows if row["label"] == label]
        step = 2 * SPREAD / max(1, len(some) - 1)
        for i, row in enumerate(some):
            x = at + (i * step - SPREAD if len(some) > 1 else 0.0)
            if row["digits_lost"] is not None:
                size = 9 if len(some) < 20 else 3
                axes.scatter(x, row["digits_lost"], size, color=DIGITS, linewidth=0, zorder=3)
            if row["condition"] is not None:
                y = min(row["condition"], LARGEST)
                beside.scatter(x, y, 9, color=CONDITION, marker="x", linewidth=0.6, alpha=0.7)
    axes.set_ylim(-0.5, MOST + 0.5)
    axes.set_yticks([0, 8, 16])
    axes.grid(True, axis="y", alpha=0.25)
    beside.set_yscale("log")
    beside.set_ylim(1, LARGEST)
    beside.set_yticks([1, 1e10, LARGEST], ["1", "1e10", "1e20"])
    beside.minorticks_off()
    for one, colour in ((axes, DIGITS), (beside, CONDITION)):
        tidy(one)
        one.tick_params(axis="y", labelsize=8, colors=colour)
    beside.spines[["top", "left", "right", "bottom"]].set_visible(False)
    _values(axes, labels)


def _values(axes: Axes, labels: list[str]) -> None:
    """Write values under their bars, aslant where they are long."""
    long = sum(len(label) for label in labels) > 70 or max(map(len, labels)) > 12
    slant: dict[str, Any] = {"rotation": 20, "ha": "right"} if long else {}
    axes.set_xlim(-0.6, len(labels) - 0.4)
    names = [drawn(label, LETTERS) for label in labels]
    axes.set_xticks(range(len(labels)), names, fontsize=7, color=INK, **slant)
    axes.tick_params(axis="x", length=0, colors=INK)
    axes.spines["bottom"].set_color(FAINT)


def _legend(figure: Figure, rows: Rows) -> None:
    from matplotlib.patches import Patch

    counts = Counter(row["verdict"] for row in rows)
    handles = [
        Patch(color=colour, label=f"{verdict}: {counts[verdict]}")
        for verdict, colour in COLOURS.items()
        if counts[verdict] or verdict == "wrong"
    ]
    figure.legend(
        handles=handles, loc="outside lower center", ncols=len(handles), frameon=False, fontsize=9
    )
