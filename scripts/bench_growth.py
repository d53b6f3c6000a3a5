"""How CPU and memory of one answer grow with the number of intervals, from 10 to 10,000.

    python scripts/bench_growth.py [--before CHECKOUT] [--degree 6] [--turns 3]
        [--intervals 10 30 ...] [--out results/growth]

Half the Moebius ribbon by Newton's method on a uniform mesh, structure built, each point in a fresh
process, whose peak of resident memory counts. The law is smooth, so that no mesh asks for phases.
The exponent is the slope of log(CPU) over log(intervals), all points alike; kilobytes an interval
are the slope between the largest number of intervals and a tenth of it, so that what Python and
CasADi take by themselves is off. Contenders are this checkout with its kernel and without, and the
checkout before, by turns; told are medians.
Writes `growth.json` and `growth.png`.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np

from ribbonopt.output.summary import versions
from ribbonopt.studies.machine import machine

ROOT = Path(__file__).resolve().parent.parent
BEFORE, WITH, WITHOUT = "before", "with kernel", "without"
INTERVALS = [10, 30, 100, 300, 1000, 3000, 10_000]
EXPONENT, KILOBYTES = 1.05, 40.0  # wanted
WORK = """
import resource, sys, time
from ribbonopt import load_scene, prepare
SMOOTH = "law={type: variational, delta: 0.1}", "solver={type: newton}"
scene, degree, intervals = sys.argv[1:]
settings = [f"transcription.degree={degree}", f"transcription.intervals={intervals}"]
prepared = prepare(load_scene(scene, [*settings, *SMOOTH]))
solution = prepared.solve()
times = max(1, 500 // int(intervals))
used = time.process_time()
for _ in range(times):
    solution = prepared.solve()
used = (time.process_time() - used) / times
peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(used, peak / (1 if sys.platform == "linux" else 1024), int(solution.verified), solution.n0[1])
"""


def main() -> None:
    """Measure, print, write JSON and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--before", type=Path, help="an older checkout of this package")
    parser.add_argument("--degree", type=int, default=6)
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--intervals", type=int, nargs="+", default=INTERVALS)
    parser.add_argument("--out", type=Path, default=Path("results") / "growth")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    contenders = {WITH: (ROOT, ""), WITHOUT: (ROOT, "off")}
    if options.before:
        contenders[BEFORE] = (options.before.resolve(), "")
    load = os.getloadavg()
    runs: dict[str, dict[int, list[list[float]]]] = {label: {} for label in contenders}
    for _ in range(options.turns):
        for count in options.intervals:
            for label, (path, kernel) in contenders.items():
                found = measured(path, kernel, options.degree, count)
                runs[label].setdefault(count, []).append(found)
    result: dict[str, Any] = {
        "machine": machine(),
        "versions": versions(),
        "degree": options.degree,
        "load": [load, os.getloadavg()],
        "contenders": {label: summary(found) for label, found in runs.items()},
    }
    report(result)
    text = json.dumps(result, indent=2) + "\n"
    (options.out / "growth.json").write_text(text, encoding="utf-8")
    draw(result, options.out / "growth.png")
    print(f"written: {options.out}: growth.json, growth.png")


def measured(path: Path, kernel: str, degree: int, intervals: int) -> list[float]:
    """Solve in a fresh process: CPU seconds, peak memory (kB), whether verified, a number."""
    # A small parent, because peak memory counts from the fork.
    launcher = "import subprocess, sys; sys.exit(subprocess.run(sys.argv[1:]).returncode)"
    scene = str(ROOT / "configs" / "moebius_half.yaml")
    work = [sys.executable, "-c", WORK, scene, str(degree), str(intervals)]
    environment = os.environ | {"PYTHONPATH": str(path)}
    environment.pop("RIBBONOPT_KERNEL", None)
    if kernel:
        environment["RIBBONOPT_KERNEL"] = kernel
    command = [sys.executable, "-S", "-c", launcher, *work]
    with TemporaryDirectory() as elsewhere:  # Python would take a package that lies where it runs
        done = subprocess.run(
            command, stdout=subprocess.PIPE, text=True, env=environment, check=True, cwd=elsewhere
        )
    return [float(word) for word in done.stdout.split()]


def summary(runs: dict[int, list[list[float]]]) -> dict[str, Any]:
    """Medians of each number of intervals, and the slopes."""
    counts = sorted(runs)
    seconds = [statistics.median(run[0] for run in runs[n]) for n in counts]
    peaks = [statistics.median(run[1] for run in runs[n]) for n in counts]
    tenth = min(counts, key=lambda n: abs(n - counts[-1] / 10))
    grown = peaks[-1] - peaks[counts.index(tenth)]
    local = np.diff(np.log(seconds)) / np.diff(np.log(counts))
    return {
        "intervals": counts,
        "seconds": seconds,
        "peak_kb": peaks,
        "verified": all(run[2] == 1 for n in counts for run in runs[n]),
        "exponent": float(np.polyfit(np.log(counts), np.log(seconds), 1)[0]),
        "largest_exponent": float(local.max()),
        "kb_an_interval": grown / (counts[-1] - tenth),
    }


def report(result: dict[str, Any]) -> None:
    """Print a line for each contender, and its points."""
    for label, one in result["contenders"].items():
        failed = "" if one["verified"] else "; NOT VERIFIED"
        print(
            f"{label}: exponent {one['exponent']:.3f}, between neighbours at most "
            f"{one['largest_exponent']:.3f} (wanted {EXPONENT:g}); {one['kb_an_interval']:.1f} kB "
            f"an interval (wanted {KILOBYTES:g}){failed}"
        )
        rows = zip(one["intervals"], one["seconds"], one["peak_kb"], strict=True)
        print("  " + ", ".join(f"{n}: {1e3 * s:.4g} ms {kb / 1024:.0f} MB" for n, s, kb in rows))
    before, after = (load[0] for load in result["load"])
    print(f"degree {result['degree']}, load {before:.2f} before, {after:.2f} after")


def draw(result: dict[str, Any], path: Path) -> None:
    """Draw CPU and memory over the number of intervals."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.5, 4), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    colours = {BEFORE: "#999999", WITH: "#1f5fa8", WITHOUT: "#7fb0dd"}
    for label, one in result["contenders"].items():
        style = {"color": colours[label], "marker": "o", "ms": 4}
        name = f"{label}: exponent {one['exponent']:.2f}"
        left.loglog(one["intervals"], 1e3 * np.array(one["seconds"]), label=name, **style)
        name = f"{label}: {one['kb_an_interval']:.0f} kB an interval"
        peaks = np.array(one["peak_kb"]) / 1024
        right.semilogx(one["intervals"], peaks, label=name, **style)
    left.set(xlabel="intervals", ylabel="CPU of an answer, milliseconds")
    right.set(xlabel="intervals", ylabel="peak of resident memory, MB")
    right.set_ylim(bottom=0)
    for axes in (left, right):
        axes.legend(frameon=False, fontsize=9)
        axes.grid(True, which="major", alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    main()
