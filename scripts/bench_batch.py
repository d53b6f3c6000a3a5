"""Batches: ribbons per second, 2 workers against 1, memory of the workers.

    python scripts/bench_batch.py [--out results/batch] [--count 1000]

1,000 ribbons clamped at both ends (distance and rotation of the end swept, variational law,
tolerance 1e-6), and half the Moebius ribbon at 500 values of epsilon (tolerance 1e-8). Writes
`batch.json`. The two runs of one study follow each other: compare ratios, machines are noisy.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from ribbonopt.studies.batch import run_batch
from ribbonopt.studies.study import Study
from ribbonopt.studies.sweep import load_study

CONFIGS = Path(__file__).resolve().parent.parent / "configs"
CLAMPS = """\
name: clamps
scene:
  name: clamp
  law: {{type: variational, delta: 0.1}}
  parameters: {{distance: 0.8, turn: 0.2}}
  boundary:
    start: {{support: clamped, position: [0, 0, 0], directors: identity}}
    end: {{support: clamped, position: [0, 0.05, distance], directors: {{turns: [{{z: turn}}]}}}}
  transcription: {{type: collocation, degree: 6, intervals: 10}}
  tolerance: 1e-6
sweep:
  grid:
    parameters.distance: {{from: 0.5, to: 0.95, count: {rows}}}
    parameters.turn: {{from: -1.5, to: 1.5, count: 25}}
"""
HALF = f"""\
name: half
scene: {CONFIGS / "moebius_half.yaml"}
set: {{law: {{type: regularized, epsilon: 0.1}}, tolerance: 1e-8}}
sweep:
  grid: {{law.epsilon: {{from: 0.1, to: 1e-4, count: 500, scale: log}}}}
"""


def main() -> None:
    """Measure, print, write JSON."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "batch")
    parser.add_argument("--count", type=int, default=1000, help="clamped ribbons, by 25")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    result: dict[str, Any] = {}
    texts = {"clamps": CLAMPS.format(rows=options.count // 25), "half": HALF}
    for name, text in texts.items():
        path = options.out / f"{name}.yaml"
        path.write_text(text, encoding="utf-8")
        study = load_study([path])
        for jobs in (1, 2):
            result[f"{name}, {jobs} workers"] = row = measured(study, jobs)
            print(
                f"{name}, {jobs} workers: {row['verified']} of {row['ribbons']} verified, "
                f"{row['per_second']:.1f} ribbons/s, memory of a worker {row['memory_mb']}"
            )
    for name in texts:
        pair = (result[f"{name}, {jobs} workers"]["per_second"] for jobs in (1, 2))
        one, two = pair
        print(f"{name}: 2 workers are {two / one:.2f} times as fast as 1")
    text = json.dumps(result, indent=2) + "\n"
    (options.out / "batch.json").write_text(text, encoding="utf-8")


def measured(study: Study, jobs: int) -> dict[str, Any]:
    """Run a study once: rate, and the memory of the largest worker after every tenth of it."""
    start, done, memory = time.perf_counter(), [], []
    for row in run_batch(study, jobs=jobs):
        done.append(row)
        if len(done) % max(study.count // 10, 1) == 0:
            memory.append(largest_worker())
    seconds = time.perf_counter() - start
    return {
        "ribbons": len(done),
        "verified": sum(row["verified"] for row in done),
        "seconds": seconds,
        "per_second": len(done) / seconds,
        "solving_s": sum(row["seconds"] for row in done),
        "memory_mb": memory,
    }


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


if __name__ == "__main__":
    main()
