"""Figure of `bench_compiled.py`: milliseconds of CPU of every contender, case by case."""

from __future__ import annotations

from pathlib import Path
from typing import Any

COLOURS = {"before": "#999999", "with kernel": "#1f5fa8", "without": "#7fb0dd"}
PEER = "#c0501a"


def draw(rows: dict[str, dict[str, Any]], path: Path) -> None:
    """Draw a dot for each contender on a logarithmic axis, one small plot a case."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator, NullFormatter

    heights = [len(row["contenders"]) + 1 for row in rows.values()]
    figure = Figure(figsize=(8, 0.27 * sum(heights) + 0.6), layout="constrained")
    FigureCanvasAgg(figure)
    plots = figure.subplots(len(rows), 1, squeeze=False, gridspec_kw={"height_ratios": heights})
    for axes, (name, row) in zip(plots[:, 0], rows.items(), strict=True):
        every = [one["ms"] for one in row["contenders"].values()]
        for k, (label, one) in enumerate(row["contenders"].items()):
            axes.plot(one["ms"], k, "o", color=COLOURS.get(label, PEER))
            ratio = f"  {one['ratio']:.2f} x" if label in row["wanted"] and "ratio" in one else ""
            error = f"  error {one['error']:.0e}" if "error" in one else ""
            time = f"{one['ms']:.0f}" if one["ms"] >= 100 else f"{one['ms']:.3g}"
            text = f"   {time} ms{ratio}{error}"
            axes.text(one["ms"], k, text, va="center", fontsize=8)
        axes.set_yticks(range(len(row["contenders"])), list(row["contenders"]), fontsize=8)
        axes.set(
            xscale="log", xlim=(min(every) / 1.5, 6 * max(every)), ylim=(len(every) - 0.4, -0.6)
        )
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.grid(True, axis="x", which="both", alpha=0.15)
        axes.set_title(name, fontsize=9, loc="left")
        axes.tick_params(axis="x", labelsize=7)
        axes.spines[["top", "right"]].set_visible(False)
    figure.supxlabel("CPU of one answer (of a ribbon, of a branch), milliseconds", fontsize=9)
    figure.savefig(path, dpi=150)
