"""Order across a sign change of m2, with phases that end on it and without: `switching.png`.

    python scripts/figure_switching.py [--out scripts/figures/switching.png]

Whole Moebius ribbon by Gauss 3 with odd numbers of intervals, so that no node falls on s = 1/2 by
itself. Law (6.1), whose strains have a kink there (and, epsilon being small, change within a layer
that fine meshes only resolve), and Sadowsky's, whose strains jump. Error of n(0), m(0) against the
references of `tests/references.py`; orders are slopes over the three finest meshes.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from bench_path import ROOT
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import load_scene

sys.path.append(str(ROOT / "tests"))
from references import HALF_MOEBIUS, REGULARIZED

COUNTS = (5, 7, 9, 13, 19, 27, 39, 57, 81)
FINER = (161, 321, 641, 961)  # for (6.1)
LAWS = {
    "(6.1), epsilon = 0.01": (
        "{type: regularized, epsilon: 0.01}",
        REGULARIZED[0.01],
        "#1f5fa8",
        FINER,
    ),
    "Sadowsky": ("{type: sadowsky}", HALF_MOEBIUS, "#c2410c", ()),
}
SWITCHING = {"in phases": ("auto", "o-"), "without": ("off", "s--")}


def main() -> None:
    """Measure, print, draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    default = ROOT / "scripts" / "figures" / "switching.png"
    parser.add_argument("--out", type=Path, default=default)
    path = parser.parse_args().out
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    for law, (words, exact, colour, finer) in LAWS.items():
        reference = np.concatenate([exact["n0"], exact["m0"]])
        for how, (switching, style) in SWITCHING.items():
            settings = [f"law={words}", f"switching={switching}"]
            counts, errors = measured(settings, reference, COUNTS + finer)
            label = f"{law}, {how}: {slope(counts, errors)}"
            print(label, *(f"{n}: {e:.1e}" for n, e in zip(counts, errors, strict=True)))
            axes.loglog(counts, errors, style, ms=5, color=colour, label=label)
    ticks = COUNTS[::2] + FINER
    axes.set_xticks(ticks, [str(n) for n in ticks])
    axes.set_xticks([], minor=True)
    axes.set(xlabel="intervals of Gauss 3", ylabel="relative error of n(0), m(0)")
    axes.set_title("whole Moebius ribbon: m2 changes sign at s = 1/2")
    axes.grid(True, alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, fontsize=9)
    figure.savefig(path, dpi=110)
    print(f"written: {path}")


def measured(
    settings: list[str], reference: np.ndarray, tried: tuple[int, ...]
) -> tuple[list[int], list[float]]:
    """Return numbers of intervals and errors of what was solved."""
    found: dict[int, float] = {}
    for count in tried:
        mesh = ["transcription.degree=3", f"transcription.intervals={count}"]
        scene = load_scene(ROOT / "configs" / "moebius_regularized.yaml", settings + mesh)
        solution = prepare(scene).solve()
        if not solution.verified:
            print(f"{settings}, {count} intervals: {solution.message}")
            continue
        gap = np.abs(np.concatenate([solution.n0, solution.m0]) - reference).max()
        found[len(solution.nodes) - 1] = float(gap / np.abs(reference).max())
    return list(found), list(found.values())


def slope(counts: list[int], errors: list[float]) -> str:
    """Return the order in h over the finest meshes, in words."""
    if not counts:
        return "no solution on any mesh"
    order = -np.polyfit(np.log(counts[-3:]), np.log(errors[-3:]), 1)[0]
    return f"order {order:.1f}"


if __name__ == "__main__":
    main()
