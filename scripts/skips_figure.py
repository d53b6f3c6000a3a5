"""Figure of `bench_skips.py`: CPU time with and without what each case skips."""

from __future__ import annotations

from pathlib import Path
from typing import Any

BLUE, GREY = "#1f5fa8", "#999999"


def draw(rows: list[dict[str, Any]], path: Path) -> None:
    """Draw a line from the long way to the short one for each row, what saves most on top."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import NullFormatter

    figure = Figure(figsize=(9, 0.34 * len(rows) + 1.2), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    for i, row in enumerate(rows):
        axes.plot([row["ms"], row["ms_long"]], [i, i], "-", color=GREY, linewidth=1, zorder=1)
        axes.plot(row["ms_long"], i, "o", color=GREY, markersize=5)
        axes.plot(row["ms"], i, "o", color=BLUE, markersize=6)
        place = max(row["ms"], row["ms_long"])
        axes.annotate(
            f"{row['ratio']:.3g} times",
            (place, i),
            (8, 0),
            textcoords="offset points",
            va="center",
            fontsize=8,
        )
    names = [f"{row['skipped']}\n{row['scene']}" for row in rows]
    axes.set_yticks(range(len(rows)), names, fontsize=7)
    axes.set(
        xscale="log",
        ylim=(len(rows) - 0.4, -0.6),
        xlabel="CPU of an answer, ms: blue without, grey with what is skipped",
    )
    low, high = axes.get_xlim()
    axes.set_xlim(low, 3 * high)
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.grid(True, axis="x", alpha=0.2)
    figure.savefig(path, dpi=130)
