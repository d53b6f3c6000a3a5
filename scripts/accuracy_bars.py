"""What an answer with its error bar costs, step by step; part of `bench_accuracy.py`.

Half and whole Moebius ribbon, from the loads that the peers start from, everything built by a first
solve. Milliseconds of CPU, which other programs on the machine stretch less than the clock.
"""

from __future__ import annotations

import statistics
import time
from pathlib import Path
from typing import Any

from stopwatches import stopwatches

from ribbonopt.accuracy.estimate import estimate_error, relative_error
from ribbonopt.attempt import attempt
from ribbonopt.pipeline import refinement
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.scene import load_scene

CONFIGS = Path(__file__).resolve().parent.parent / "configs"
HALF, WHOLE = "moebius_half.yaml", "moebius_regularized.yaml"
# name: scene, tolerance, degree, first number of intervals, target in ms.
CASES = {
    "half 1e-9": (HALF, 1e-9, 6, 8, 4.0),
    "half 1e-12": (HALF, 1e-12, 8, 8, 6.0),
    "whole 1e-9": (WHOLE, 1e-9, 7, 10, 15.0),
    "whole 1e-12": (WHOLE, 1e-12, 8, 14, 25.0),
}
WATCHED = (
    (refinement, "relative_error", "estimate"),
    (refinement, "_better_mesh", "remesh"),
    (attempt, "initial_unknowns", "unknowns"),
    (attempt.Attempt, "run", "solve, its unknowns and verification included"),
    (attempt, "verify", "verification"),
)
BUILD = 150.0  # target of building the structure, in ms


def bench_bars(repeat: int) -> dict[str, Any]:
    """Medians over interleaved solves; `steps` are the parts of the median one, in order."""
    runs: dict[str, Prepared] = {}
    result: dict[str, Any] = {}
    for name, (scene, tolerance, degree, intervals, target) in CASES.items():
        settings = [
            f"tolerance={tolerance}",
            f"transcription.degree={degree}",
            f"transcription.intervals={intervals}",
        ]
        start = time.process_time()
        runs[name] = prepare(load_scene(CONFIGS / scene, settings))
        built = 1e3 * (time.process_time() - start)
        found = runs[name].solve()
        result[name] = {
            "target_ms": target,
            "build_ms": built,
            "met": found.verified,
            "estimate": relative_error(found)[0],
            "elements": found.dense.blocks.layout.elements,
            "runs": [],
        }
    for _ in range(repeat):
        for name, prepared in runs.items():
            with stopwatches(WATCHED) as steps:
                used = time.process_time()
                estimate_error(prepared.solve())
                result[name]["runs"].append((1e3 * (time.process_time() - used), steps))
    for row in result.values():
        taken = sorted(row.pop("runs"), key=lambda run: run[0])
        row["ms"], row["steps"] = taken[len(taken) // 2]
        row["minimum_ms"] = taken[0][0]
        row["spread_ms"] = statistics.pstdev(run[0] for run in taken)
    return result


def report(result: dict[str, Any]) -> None:
    """Print the table."""
    print("an answer with its error bar, everything built (ms of CPU; steps of the median run):")
    for name, row in result.items():
        print(
            f"  {name:<12} {row['ms']:6.2f} (target {row['target_ms']:g}, minimum "
            f"{row['minimum_ms']:.2f}), build {row['build_ms']:.0f} (target {BUILD:g}); estimate "
            f"{row['estimate']:.1e} on {row['elements']}{'' if row['met'] else '  NOT MET'}"
        )
        print("    " + ", ".join(f"{label} {1e3 * s:.2f}" for label, s in row["steps"]))
