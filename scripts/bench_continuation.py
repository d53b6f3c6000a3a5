"""What branches cost: half and whole Moebius ribbon, epsilon going to zero; Figure 5d of the paper.

    python scripts/bench_continuation.py [--out results/continuation] [--repeat 7]

Writes `continuation.json` (median and minimum seconds of wall clock and CPU, cold and with the
structure built, steps apart) and `continuation.png` (u2(0) against epsilon, and against delta of
the variational law). AUTO needs 0.98 s for the half ribbon at the same error (DESIGN 4.11).
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import time
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from stopwatches import stopwatches

from ribbonopt.accuracy import estimate
from ribbonopt.pipeline.prepared import Prepared
from ribbonopt.scene import Scene, load_scene
from ribbonopt.solvers.newton import NewtonSolver
from ribbonopt.studies.continuation import recorded
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.recorded import value_of
from ribbonopt.studies.continuation.walk import steps

CONFIGS = Path(__file__).resolve().parent.parent / "configs"
LIMIT = 3.38657617297834557330  # u2(0) of Sadowsky's ribbon, 28 digits (SCIENCE, section 5)
# name: scene, settings, targets in seconds.
CASES: dict[str, tuple[str, list[str], float]] = {
    "half, epsilon 0.1 to 1e-4": (
        "moebius_half.yaml",
        [
            "law={type: regularized, epsilon: 0.1}",
            "continuation={parameter: law.epsilon, to: 1e-4, scale: log, largest: 0.15}",
            *("tolerance=2e-9", "transcription.degree=6", "transcription.intervals=8"),
        ],
        0.12,
    ),
    "whole, epsilon 0.1 to 1e-8": (
        "moebius_regularized.yaml",
        [
            "continuation={parameter: law.epsilon, from: 0.1, to: 1e-8, scale: log, largest: 0.28}",
            *("tolerance=1e-8", "transcription.degree=8", "transcription.intervals=10"),
        ],
        1.0,
    ),
}
DELTA = [
    "law={type: variational, delta: 0.1}",
    "continuation={parameter: law.delta, to: 1e-3, scale: log, stability: false}",
    "tolerance=1e-8",
]


WATCHED = (
    (NewtonSolver, "solve", "Newton"),
    (steps, "near", "tangents and determinants"),
    (estimate, "_analysed", "estimates"),
    (steps, "special_points", "special points"),
    (recorded.Recorder, "row", "recording"),
)


def main() -> None:
    """Measure, print, write JSON and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "continuation")
    parser.add_argument("--repeat", type=int, default=7)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    scenes = {name: load_scene(CONFIGS / file, sets) for name, (file, sets, _) in CASES.items()}
    runs: dict[str, list[dict[str, Any]]] = {name: [] for name in scenes}
    rows, built = {}, {}
    for name, scene in scenes.items():
        first, rows[name], built[name] = followed(scene, None)
        runs[name].append(first)
    for _ in range(options.repeat):
        for name, scene in scenes.items():
            runs[name].append(followed(scene, built[name])[0])
    result = {name: summary(runs[name], rows[name], CASES[name][2]) for name in scenes}
    delta = followed(load_scene(CONFIGS / "moebius_half.yaml", DELTA), None)[1]
    result["slopes"] = {
        "epsilon": slope(rows["whole, epsilon 0.1 to 1e-8"], 1e-8),
        "delta": slope(delta, 1e-8),
    }
    report(result)
    text = json.dumps(result, indent=2) + "\n"
    (options.out / "continuation.json").write_text(text, encoding="utf-8")
    draw(rows["whole, epsilon 0.1 to 1e-8"], delta, options.out / "continuation.png")
    print(f"written: {options.out}: continuation.json, continuation.png")


def followed(
    scene: Scene, prepared: Prepared | None
) -> tuple[dict[str, Any], list[dict[str, Any]], Prepared]:
    """Follow a branch: seconds, rows, and the structure that was built."""
    with stopwatches(WATCHED) as spent_on:
        wall, cpu = time.perf_counter(), time.process_time()
        continuation = Continuation(scene, prepared)
        rows = [dict(point.row) for point in continuation]
        seconds = {"cpu": time.process_time() - cpu, "wall": time.perf_counter() - wall}
    assert continuation.ending.reached, continuation.ending.reason
    sums: dict[str, float] = {}
    for label, spent in spent_on:
        sums[label] = sums.get(label, 0.0) + spent
    return seconds | {"steps": sums}, rows, continuation.prepared


def summary(
    runs: list[dict[str, Any]], rows: list[dict[str, Any]], target: float
) -> dict[str, Any]:
    """Medians; the first run built everything."""
    again = sorted(runs[1:], key=lambda run: run["cpu"])
    median = again[len(again) // 2]
    return {
        "target_s": target,
        "points": len(rows),
        "largest_error": max(row["error"] for row in rows),
        "cold_s": {kind: runs[0][kind] for kind in ("cpu", "wall")},
        "cpu_s": median["cpu"],
        "wall_s": statistics.median(run["wall"] for run in again),
        "minimum_s": {kind: min(run[kind] for run in again) for kind in ("cpu", "wall")},
        "steps_s": median["steps"],
    }


def slope(rows: list[dict[str, Any]], least: float) -> float:
    """Order of u2(0) - limit in the parameter, from the smaller half of its values."""
    rows = [row for row in rows if row["kind"] == "point"]
    pairs = [(value_of(row), abs(row["u2"] - LIMIT)) for row in rows[len(rows) // 2 :]]
    known = np.log([pair for pair in pairs if pair[1] > 10 * least * LIMIT])
    return float(np.polyfit(known[:, 0], known[:, 1], 1)[0])


def report(result: dict[str, Any]) -> None:
    """Print the table."""
    for name in CASES:
        row = result[name]
        print(
            f"{name}: {row['points']} points, error at most {row['largest_error']:.0e}: "
            f"{row['cpu_s']:.3f} s of CPU (target {row['target_s']:g}; minimum "
            f"{row['minimum_s']['cpu']:.3f}; wall {row['wall_s']:.3f}; first time "
            f"{row['cold_s']['cpu']:.3f})"
        )
        parts = ", ".join(f"{label} {1e3 * s:.0f}" for label, s in row["steps_s"].items())
        print(f"  in ms: {parts}")
    slopes = result["slopes"]
    print(
        f"u2(0) against its limit: order {slopes['epsilon']:.3f} in epsilon, "
        f"{slopes['delta']:.2f} in delta"
    )


def draw(epsilon: list[dict[str, Any]], delta: list[dict[str, Any]], path: Path) -> None:
    """Draw Figure 5d: u2(0) against both parameters, and the distance from the limit."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    curves = (
        (epsilon, "o-", "#1f5fa8", "eq. (6.1), epsilon"),
        (delta, "s-", "#c0501a", "variational, delta"),
    )
    for rows, mark, colour, label in curves:
        values = np.array([(value_of(row), row["u2"]) for row in rows if row["kind"] == "point"])
        left.semilogx(*values.T, mark, ms=3.5, color=colour, label=label)
        gap = np.abs(values[:, 1] - LIMIT)
        right.loglog(values[:, 0], gap, mark, ms=3.5, color=colour, label=label)
    left.axhline(LIMIT, color="0.5", lw=0.8, ls="--", label="Sadowsky")
    left.set(xlabel="epsilon or delta", ylabel="u2(0)", title="Moebius ribbon, Figure 5d")
    right.set(xlabel="epsilon or delta", ylabel="|u2(0) - limit|", title="distance from the limit")
    for axes in (left, right):
        axes.grid(True, which="major", alpha=0.3)
        axes.legend()
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    main()
