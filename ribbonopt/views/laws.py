"""Figure of one scene under several laws: centre lines, strains and moments in one frame each.

It takes rows as plain mappings, as `laws.json` holds them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.plain import Row
from ribbonopt.text import drawn

from .camera import place_camera
from .style import FAINT, INK, SI, SPECIAL, blank, tidy, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: one for each law; the first is the scene's own
COLOURS = ("#111111", "#1f5fa8", "#c2410c", "#009e73", "#cc79a7", "#8a6d00", "#56b4e9", "#7b3fa0")
#: lines thin from row to row and are dashed, so that those that coincide are all seen
DASHES: tuple[Any, ...] = ("-", (0, (5, 1.6)), (0, (1.2, 1.2)), (0, (6, 1.5, 1.2, 1.5)))
LABELS = {
    "u2": (r"$u_2$ (bending)", "1/m"),
    "u3": (r"$u_3$ (twist)", "1/m"),
    "m2": (r"$m_2$", "N m"),
    "m3": (r"$m_3$", "N m"),
}
HARDLY = 0.1  # share of a lab axis in one of the picture
FLAT = 1e-7  # of the length: a centre line as near to a plane as this lies in it


def plot_laws(study: Mapping[str, Any]) -> Figure:
    """Plot the rows that are solutions: the centre line as seen best, u2, u3, m2, m3 along s."""
    rows = [row for row in study["rows"] if row.get("curves")]
    si = str(study["units"]).startswith("SI")
    figure = blank(13.0, 6.4)
    grid = figure.add_gridspec(2, 3, width_ratios=(1.25, 1, 1))
    space = figure.add_subplot(grid[:, 0])
    _space(space, rows, "m" if si else "L")
    for k, (name, (label, unit)) in enumerate(LABELS.items()):
        axes = figure.add_subplot(grid[k // 2, 1 + k % 2])
        for i, row in enumerate(rows):
            axes.plot(row["curves"]["s"], row["curves"][name], **style(i, len(rows)))
        axes.axhline(0, color=INK, lw=0.6, zorder=0)
        axes.set_ylabel(f"{label}  [{unit}]" if si else label)
        axes.set_xlabel("$s$  [m]" if si else "$s$")
        axes.margins(x=0)
        axes.grid(True, alpha=0.2)
        tidy(axes)
    title(space, study["name"])
    figure.axes[2].set_title(SI if si else SPECIAL, loc="right", fontsize=9)
    legend(figure, rows)
    return figure


def style(number: int, count: int) -> dict[str, Any]:
    """Return how the curves of a law are drawn."""
    return {
        "color": COLOURS[number % len(COLOURS)],
        "ls": DASHES[number % len(DASHES)],
        "lw": 3.2 - 1.8 * number / max(count - 1, 1),
        "zorder": 2 + 0.1 * number,
    }


def legend(figure: Figure, rows: Sequence[Row]) -> None:
    """Name the laws under a figure, with their numbers."""
    from matplotlib.lines import Line2D

    handles = []
    for i, row in enumerate(rows):
        numbers = f" ({row['numbers']})" if row["numbers"] else ""
        look = {k: v for k, v in style(i, len(rows)).items() if k != "zorder"}
        handles.append(Line2D([], [], label=drawn(row["law"] + numbers, 80), **look))
    figure.legend(
        handles=handles,
        loc="outside lower center",
        ncols=min(3, max(1, len(rows))),
        frameon=False,
        fontsize=9,
        handlelength=4,
    )


def _space(axes: Axes, rows: Sequence[Row], unit: str) -> None:
    """Draw the centre lines orthographically, so that the first shows most of itself."""
    lines = [np.array(row["curves"]["r"]) for row in rows]
    if lines:
        right, up, words = _axes_of(lines)
        for i, line in enumerate(lines):
            axes.plot(line @ right, line @ up, **style(i, len(lines)))
        start = lines[0][0]
        axes.plot([start @ right], [start @ up], "o", ms=5, color=INK, zorder=5)
        axes.set_xlabel(f"{words[0]}  [{unit}]")
        axes.set_ylabel(f"{words[1]}  [{unit}]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.grid(True, alpha=0.2)
    tidy(axes)
    axes.tick_params(labelsize=8, colors=FAINT)


def _axes_of(lines: Sequence[Any]) -> tuple[Any, Any, tuple[str, str]]:
    """Return two unit vectors across the sight, and what they are called."""
    points = np.concatenate(lines)
    extent = np.ptp(points, axis=0)
    thin = int(extent.argmin())
    if extent[thin] <= FLAT * extent.max():
        across = [axis for axis in range(3) if axis != thin]
        if extent[across[1]] > extent[across[0]]:
            across.reverse()
        right, up = np.eye(3)[across[0]], np.eye(3)[across[1]]
        return right, up, ("xyz"[across[0]], "xyz"[across[1]])
    first = lines[0]
    camera = place_camera(first, np.zeros_like(first) + _normal(first))
    return camera.right, camera.up, (_named(camera.right), _named(camera.up))


def _normal(line: Any) -> Any:
    """Return the direction of least extent of a line (k, 3)."""
    return np.linalg.svd(line - line.mean(axis=0), full_matrices=False)[2][-1]


def _named(vector: Any) -> str:
    """Write a unit vector of the picture by the lab's axes, without what is hardly seen of it."""
    parts = [(v, name) for v, name in zip(vector, "xyz", strict=True) if abs(v) > HARDLY]
    if len(parts) == 1:
        return ("-" if parts[0][0] < 0 else "") + parts[0][1]
    words = [f"{'-' if v < 0 else '+'} {abs(v):.2f} {name}" for v, name in parts]
    return " ".join(words).removeprefix("+ ")
