"""Speed of the whole path on the half Moebius ribbon: build, solve, whole process, scaling, peer.

    python scripts/bench_path.py [--out results/bench] [--repeat 11] [--quick]

Medians of `repeat` runs, the contenders of each comparison interleaved in one run, so that ratios
hold on a noisy machine. Writes `bench_path.json` and `bench_path.png`. Errors are relative to the
28-digit reference, largest of the six numbers n(0), m(0).
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring, for all contenders.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from peer_states import HALF

from ribbonopt.output.summary import versions
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import Scene, load_scene

ROOT = Path(__file__).resolve().parent.parent
SCENE = ROOT / "configs" / "moebius_half.yaml"
REFERENCE = np.array(HALF)
# (solver, degree, intervals, solver tolerance): the quickest found that reach each error.
CASES = {
    "1e-9": [("ipopt", 6, 6, 1e-9), ("newton", 6, 6, 1e-9)],
    "1e-12": [("ipopt", 8, 6, 1e-12), ("newton", 8, 6, 1e-12)],
}
# solve_bvp controls a residual: these powers of ten give errors nearest to the wanted ones.
PEER_TOLERANCE = {"1e-9": 1e-6, "1e-12": 1e-9}
TARGETS = {"ipopt 1e-9": 8.0, "newton 1e-9": 2.5, "ipopt 1e-12": 16.0, "newton 1e-12": 4.0}


LAUNCHER = """
import resource, subprocess, sys, time
start = time.perf_counter()
subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True)
seconds = time.perf_counter() - start
peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
print(seconds, peak / (1024 if sys.platform == "linux" else 1024**2))
"""


def main() -> None:
    """Run all parts, print the tables, write JSON and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "bench")
    parser.add_argument("--repeat", type=int, default=11)
    parser.add_argument("--quick", action="store_true", help="skip scipy's 1e-12 (seconds a run)")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    result: dict[str, Any] = {
        "machine": {
            "processor": platform.processor() or platform.machine(),
            "cpus": os.cpu_count(),
        },
        "versions": versions(),
        "repeat": options.repeat,
        "build_ms": bench_build(options.repeat),
        "solve": bench_solve(options.repeat, options.quick),
        "process": bench_process(options.repeat),
        "scaling": bench_scaling(options.repeat),
    }
    report(result)
    (options.out / "bench_path.json").write_text(json.dumps(result, indent=2) + "\n")
    draw(result, options.out / "bench_path.png")
    print(f"written: {options.out / 'bench_path.json'}, {options.out / 'bench_path.png'}")


def scene(solver: str, degree: int, intervals: int, tolerance: float) -> Scene:
    """Return the half Moebius scene with these settings."""
    return load_scene(
        SCENE,
        [
            f"solver={{type: {solver}, tolerance: {tolerance}}}",
            f"transcription.degree={degree}",
            f"transcription.intervals={intervals}",
        ],
    )


def medians(repeat: int, runs: dict[str, Callable[[], Any]]) -> dict[str, float]:
    """Median seconds of every run, interleaved, after one call of each to warm up."""
    for run in runs.values():
        run()
    seconds: dict[str, list[float]] = {name: [] for name in runs}
    for _ in range(repeat):
        for name, run in runs.items():
            start = time.perf_counter()
            run()
            seconds[name].append(time.perf_counter() - start)
    return {name: statistics.median(values) for name, values in seconds.items()}


def bench_build(repeat: int) -> dict[str, float]:
    """Milliseconds from a scene file to a solver that is ready, imports excluded."""
    runs = {
        solver: lambda solver=solver: prepare(scene(solver, 6, 10, 1e-12))
        for solver in ("ipopt", "newton")
    }
    first = {}
    for name, run in runs.items():
        start = time.perf_counter()
        run()
        first[f"{name}, first in the process"] = 1e3 * (time.perf_counter() - start)
    return first | {name: 1e3 * value for name, value in medians(repeat, runs).items()}


def bench_solve(repeat: int, quick: bool) -> list[dict[str, Any]]:
    """Solve again in process to 1e-9 and 1e-12, beside scipy's solve_bvp at equal error."""
    rows = []
    for target, cases in CASES.items():
        runs: dict[str, Callable[[], Any]] = {}
        details = {}
        for solver, degree, intervals, tolerance in cases:
            prepared = prepare(scene(solver, degree, intervals, tolerance))
            w, p = prepared.start()
            name = f"{solver} {target}"
            runs[name] = lambda prepared=prepared, w=w, p=p: prepared.solver.solve(w, p)
            answer = prepared.solver.solve(w, p)
            error = np.abs(answer.w[-6:] - REFERENCE).max() / np.abs(REFERENCE).max()
            details[name] = {
                "mesh": f"gauss {degree} on {intervals}",
                "error": float(error),
                "iterations": answer.iterations,
                "factorizations": answer.factorizations,
                "evaluate_ms": 1e3 * answer.evaluate,
                "linear_ms": 1e3 * answer.linear,
            }
        if not (quick and target == "1e-12"):
            from peer_scipy import Scipy
            from peer_states import Ribbon

            peer = Scipy(Ribbon(whole=False))
            name = f"scipy solve_bvp {target}"
            answer, nodes = peer.solve(PEER_TOLERANCE[target])
            error = np.abs(answer - REFERENCE).max() / np.abs(REFERENCE).max()
            details[name] = {"mesh": f"{nodes} nodes", "error": float(error)}
            runs[name] = lambda peer=peer, t=PEER_TOLERANCE[target]: peer.solve(t)
        seconds = medians(repeat, runs)
        scipy_seconds = seconds.get(f"scipy solve_bvp {target}")
        for name, value in seconds.items():
            ratio = None
            if scipy_seconds is not None and "scipy" not in name:
                ratio = scipy_seconds / value
            rows.append({"case": name, "ms": 1e3 * value, "peer_ratio": ratio, **details[name]})
    return rows


def bench_process(repeat: int) -> dict[str, float]:
    """Whole processes: `ribbonopt solve` against importing what it needs."""
    base = [sys.executable, "-c", "import casadi, numpy, yaml"]
    commands = {"imports": base}
    for solver in ("auto", "ipopt"):
        commands[f"solve, {solver}"] = [
            *(sys.executable, "-m", "ribbonopt", "solve", str(SCENE)),
            *("--set", f"solver={{type: {solver}}}"),
        ]
    seconds: dict[str, list[float]] = {name: [] for name in commands}
    memory: dict[str, list[float]] = {name: [] for name in commands}
    # Byte code as after any installation, whatever this environment says.
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    for i in range(repeat + 1):
        for name, command in commands.items():
            # A small parent, because peak memory counts from the fork.
            launcher = [sys.executable, "-S", "-c", LAUNCHER, *command]
            answer = subprocess.run(
                launcher, check=True, capture_output=True, text=True, env=environment
            )
            if i:  # the first run of each warms the file cache
                wall, peak = (float(word) for word in answer.stdout.split())
                seconds[name].append(wall)
                memory[name].append(peak)
    result = {}
    for name in commands:
        result[f"{name}: ms"] = 1e3 * statistics.median(seconds[name])
        result[f"{name}: MB"] = statistics.median(memory[name])
        ratios = [a / b for a, b in zip(seconds[name], seconds["imports"], strict=True)]
        result[f"{name}: time ratio"] = statistics.median(ratios)
        ratios = [a / b for a, b in zip(memory[name], memory["imports"], strict=True)]
        result[f"{name}: memory ratio"] = statistics.median(ratios)
    return result


def bench_scaling(repeat: int) -> dict[str, Any]:
    """Cost of Newton against the number of intervals (degree 4)."""
    counts = [50, 100, 200, 400, 800]
    runs = {}
    for count in counts:
        prepared = prepare(scene("newton", 4, count, 1e-10))
        w, p = prepared.start()
        runs[str(count)] = lambda prepared=prepared, w=w, p=p: prepared.solver.solve(w, p)
    seconds = medians(repeat, runs)
    slope = np.polyfit(np.log(counts), np.log([seconds[str(n)] for n in counts]), 1)[0]
    return {"intervals": counts, "ms": [1e3 * seconds[str(n)] for n in counts], "exponent": slope}


def report(result: dict[str, Any]) -> None:
    """Print the tables."""
    print("build, imports excluded (target 100 ms):")
    for name, value in result["build_ms"].items():
        print(f"  {name:<28} {value:8.1f} ms")
    print("solve again in process:")
    for row in result["solve"]:
        target = TARGETS.get(row["case"])
        ratio = row["peer_ratio"]
        print(
            f"  {row['case']:<24} {row['ms']:9.2f} ms"
            f"{f' (target {target:g})' if target else '':<14} error {row['error']:.1e}"
            f"  {row['mesh']}{f'  scipy takes {ratio:.0f} times as long' if ratio else ''}"
        )
    print("whole process (targets: time 2, memory 1.5 times the imports):")
    for name, value in result["process"].items():
        print(f"  {name:<28} {value:8.2f}")
    scaling = result["scaling"]
    pairs = ", ".join(
        f"{n}: {ms:.1f}" for n, ms in zip(scaling["intervals"], scaling["ms"], strict=True)
    )
    print(f"Newton, ms by intervals: {pairs}; exponent {scaling['exponent']:.2f} (target 1.15)")


def draw(result: dict[str, Any], path: Path) -> None:
    """Draw time against error and time against intervals."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    left, right = figure.subplots(1, 2)
    curves: dict[str, list[tuple[float, float]]] = {}
    for row in result["solve"]:
        solver = row["case"].rsplit(" ", 1)[0]
        curves.setdefault(solver, []).append((row["error"], row["ms"]))
    for solver, points in curves.items():
        left.loglog(*zip(*points, strict=True), "o-", label=solver)
    left.legend()
    left.set(
        xlabel="relative error of n(0), m(0)",
        ylabel="time of one solve (ms)",
        title="half Moebius ribbon, solved again",
    )
    scaling = result["scaling"]
    right.loglog(scaling["intervals"], scaling["ms"], "o-")
    right.set(
        xlabel="intervals",
        ylabel="time of one solve (ms)",
        title=f"Newton, Gauss 4: exponent {scaling['exponent']:.2f}",
    )
    right.set_xticks(scaling["intervals"], [str(n) for n in scaling["intervals"]], minor=False)
    right.set_xticks([], minor=True)
    right.set_yticks([5, 10, 20, 50, 100], ["5", "10", "20", "50", "100"], minor=False)
    right.set_yticks([], minor=True)
    for axes in (left, right):
        axes.grid(True, which="major", alpha=0.3)
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    main()
