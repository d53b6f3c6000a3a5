"""Figure of a study under several laws: energies against the own law's, and differences.

It takes rows as plain mappings, as `laws.json` holds them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ribbonopt.text import drawn

from .columns import is_numeric, varied
from .laws import COLOURS
from .style import FAINT, INK, blank, tidy, title

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MARKERS = "osD^vP*X"
PANELS = {
    "energy_gap": "difference of energy to the own law (%)",
    "n0_gap": "difference of n(0) to the own law (%)",
    "m0_gap": "difference of m(0) to the own law (%)",
    "special1": "first special point",
    "special2": "second special point",
}
MOST = 3


def plot_law_batches(study: Mapping[str, Any]) -> Figure:
    """Plot differences to the own law against the first input that varies as a number.

    Of ribbons that were continued the places of special points.
    """
    rows = study["rows"]
    numeric = [n for n in study["inputs"] if is_numeric(rows, n) and varied(rows, n)]
    x = numeric[0] if numeric else "number"
    shown = [name for name in PANELS if any(row.get(name) is not None for row in rows)]
    shown = shown[:MOST] or list(PANELS)[:1]
    figure = blank(max(7.0, 4.4 * len(shown)), 5.0)
    panels = list(figure.subplots(1, len(shown), squeeze=False)[0])
    laws = [law["law"] for law in study["laws"]]
    for axes, column in zip(panels, shown, strict=True):
        factor = 100 if column.endswith("_gap") else 1
        if factor > 1:
            axes.axhline(0, color=INK, lw=0.8)
        for i, law in enumerate(laws):
            known = [r for r in rows if r["law"] == law and r.get(column) is not None]
            if not known:
                continue
            xy = np.array([[r[x], factor * r[column]] for r in known]).T
            look = {"color": COLOURS[i % len(COLOURS)], "ms": 4, "mew": 0, "alpha": 0.75}
            axes.plot(*xy, MARKERS[i % len(MARKERS)], label=drawn(law), **look)
        axes.set_xlabel(drawn(x))
        axes.set_ylabel(PANELS[column])
        axes.grid(True, alpha=0.25)
        tidy(axes)
    title(panels[0], study["name"])
    handles = {h.get_label(): h for axes in panels for h in axes.get_legend_handles_labels()[0]}
    if handles:
        figure.legend(
            handles=handles.values(), loc="outside lower center", ncols=len(handles), frameon=False
        )
    else:
        panels[0].text(0.5, 0.5, "nothing to compare", color=FAINT, transform=panels[0].transAxes)
    return figure
