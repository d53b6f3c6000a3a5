"""Batches: ribbons per second, 2 workers against 1, memory of the workers, where the time goes.

    python scripts/bench_batch.py [--out results/batch] [--count 1000] [--repeat 3]

1,000 ribbons clamped at both ends (distance and rotation of the end swept, variational law,
tolerance 1e-6), and half the Moebius ribbon at 500 values of epsilon (tolerance 1e-8). Writes
`batch.json` and `batch.png`. The runs of one study follow each other, 1 worker, 2 workers, again:
medians of rates and of the ratios of neighbours, since machines are noisy. Starting the processes
is included. Where the time goes is measured in this process, every fourth chunk, after a first one.
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

from compiled_cases import clamp_study
from stopwatches import stopwatches

from ribbonopt.accuracy import estimate
from ribbonopt.attempt import attempt
from ribbonopt.solvers.condense import CondensedSystem
from ribbonopt.solvers.newton import NewtonSolver
from ribbonopt.studies.batch import worker
from ribbonopt.studies.batch.batch import run_batch
from ribbonopt.studies.batch.chunks import Chunk, chunks_of
from ribbonopt.studies.batch.processes import message
from ribbonopt.studies.batch.study import Study
from ribbonopt.studies.batch.sweep import load_study
from ribbonopt.transcription.collocation.blocks import ElementBlocks
from ribbonopt.views.style import BENDING, FAINT, TWIST, blank, tidy

CONFIGS = Path(__file__).resolve().parent.parent / "configs"
HALF = f"""\
name: half
scene: {CONFIGS / "moebius_half.yaml"}
set: {{law: {{type: regularized, epsilon: 0.1}}, tolerance: 1e-8}}
sweep:
  grid: {{law.epsilon: {{from: 0.1, to: 1e-4, count: 500, scale: log}}}}
"""
TARGETS = {"clamps": (2, 60.0), "half": (1, 150.0)}  # workers, ribbons per second
RATIO, GROWTH = 1.7, 1.1  # of 2 workers over 1; of memory after the first 100 ribbons
WATCHED = (
    (worker.Worker, "_solved", "in all"),
    (worker.Worker, "_scene", "scene read"),
    (worker.Worker, "_pose", "posed"),
    (NewtonSolver, "solve", "Newton's method"),
    (estimate, "_analysed", "estimate"),
    (attempt, "verify", "verification"),
    (ElementBlocks, "residuals", "of these: residuals"),
    (ElementBlocks, "linearize", "of these: Jacobians"),
    (CondensedSystem, "__init__", "of these: factors"),
    (CondensedSystem, "solve", "of these: solving with them"),
)


def main() -> None:
    """Measure, print, write JSON and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "batch")
    parser.add_argument("--count", type=int, default=1000, help="clamped ribbons, by 25")
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    result: dict[str, Any] = {}
    for name, text in {"clamps": clamp_study(options.count // 25, 25), "half": HALF}.items():
        path = options.out / f"{name}.yaml"
        path.write_text(text, encoding="utf-8")
        study = load_study([path])
        runs = [{jobs: measured(study, jobs) for jobs in (1, 2)} for _ in range(options.repeat)]
        result[name] = summary(name, runs) | {"ms_per_ribbon": where_the_time_goes(study)}
        tell(name, result[name])
    text = json.dumps(result, indent=2) + "\n"
    (options.out / "batch.json").write_text(text, encoding="utf-8")
    draw(result, options.out / "batch.png")


def measured(study: Study, jobs: int) -> dict[str, Any]:
    """Run a study once: rate, and the memory of the largest worker after every 50 ribbons."""
    start, done, memory = time.perf_counter(), [], []
    for row in run_batch(study, jobs=jobs):
        done.append(row)
        if len(done) % 50 == 0:
            memory.append(largest_worker())
    seconds = time.perf_counter() - start
    return {
        "ribbons": len(done),
        "verified": sum(row["verified"] for row in done),
        "per_second": len(done) / seconds,
        "memory_mb": memory,
    }


def summary(name: str, runs: list[dict[int, dict[str, Any]]]) -> dict[str, Any]:
    """Medians over the runs of one study."""
    rates = {jobs: statistics.median(run[jobs]["per_second"] for run in runs) for jobs in (1, 2)}
    jobs, target = TARGETS[name]
    growth = [
        max(r["memory_mb"][2:]) / max(r["memory_mb"][:2]) for run in runs for r in run.values()
    ]
    first = runs[0][1]
    return {
        "ribbons": first["ribbons"],
        "verified": min(r["verified"] for run in runs for r in run.values()),
        "per_second": rates,
        "target": {"workers": jobs, "per_second": target, "met": rates[jobs] >= target},
        "ratio": statistics.median(r[2]["per_second"] / r[1]["per_second"] for r in runs),
        "growth_after_100": max(growth),
        "memory_mb": {jobs: runs[0][jobs]["memory_mb"] for jobs in (1, 2)},
    }


def where_the_time_goes(study: Study) -> dict[str, float]:
    """Milliseconds of CPU a ribbon by kind of work, in this process."""
    chunks, hand = chunks_of(study), worker.Worker()
    solved(hand, chunks[0])
    with stopwatches(WATCHED) as steps:
        count = sum(solved(hand, chunk) for chunk in chunks[1::4])
    parts = dict.fromkeys((label for _, _, label in WATCHED), 0.0)
    for label, seconds in steps:
        parts[label] += 1e3 * seconds / count
    return parts


def solved(hand: worker.Worker, chunk: Chunk) -> int:
    """Solve a chunk as a worker does; return how many ribbons it has."""
    return sum(
        "row" in answer for answer in hand.answers(message(chunk.ribbons, [], (), "none", ""))
    )


def largest_worker() -> int:
    """Resident memory (MB) of the largest child process; 0 where /proc is missing."""
    sizes = [0]
    for status in Path("/proc").glob("[0-9]*/status"):
        try:
            lines = dict(
                line.split(":", 1) for line in status.read_text().splitlines() if ":" in line
            )
        except OSError:  # it has ended meanwhile
            continue
        if lines.get("PPid", "").strip() == str(os.getpid()):
            sizes.append(int(lines.get("VmRSS", "0 kB").split()[0]) // 1024)
    return max(sizes)


def tell(name: str, found: dict[str, Any]) -> None:
    """Print what was measured of one study."""
    target, rates = found["target"], found["per_second"]
    print(
        f"{name}: {found['verified']} of {found['ribbons']} verified; {rates[1]:.1f} ribbons/s by "
        f"1 worker, {rates[2]:.1f} by 2 (target {target['per_second']:g} by {target['workers']}"
        f"{'' if target['met'] else ', NOT MET'}); ratio {found['ratio']:.2f} (target {RATIO}); "
        f"memory x {found['growth_after_100']:.2f} after the first 100 (target {GROWTH})"
    )
    print("    " + ", ".join(f"{label} {ms:.2f}" for label, ms in found["ms_per_ribbon"].items()))


def draw(result: dict[str, Any], path: Path) -> None:
    """Rates with their targets, and memory along the run."""
    figure = blank(9.0, 3.6)
    left, right = figure.subplots(1, 2)
    for i, (name, found) in enumerate(result.items()):
        for jobs, colour in ((1, BENDING), (2, TWIST)):
            rate, at = found["per_second"][jobs], i + 0.2 * (2 * jobs - 3)
            left.bar(
                at, rate, 0.36, color=colour, label="_" if i else f"{jobs} worker{'s' * (jobs > 1)}"
            )
            left.text(at, rate, f"{rate:.0f}", ha="center", va="bottom", fontsize=8)
            ribbons = [50 * (k + 1) for k in range(len(found["memory_mb"][jobs]))]
            style = "-" if i == 0 else "--"
            label = f"{name}, {jobs}"
            right.plot(ribbons, found["memory_mb"][jobs], style, color=colour, label=label)
        jobs, target = TARGETS[name]
        at = i + 0.2 * (2 * jobs - 3)
        left.plot([at - 0.18, at + 0.18], [target, target], color="black", lw=2)
    left.set_xticks(range(len(result)), list(result))
    left.set_ylabel("ribbons per second; black: target")
    left.legend(frameon=False, fontsize=9)
    right.set(xlabel="ribbons solved", ylabel="memory of the largest worker, MB")
    right.set_ylim(bottom=0)
    right.legend(title="study, workers", frameon=False, fontsize=8, title_fontsize=8)
    for axes in (left, right):
        axes.grid(axis="y", color=FAINT, alpha=0.2)
        tidy(axes)
    figure.savefig(path)


if __name__ == "__main__":
    main()
