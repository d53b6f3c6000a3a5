"""What natural frequencies cost, in CPU milliseconds, beside dense matrices and scipy's `eigh`.

    python scripts/bench_modes.py [--count 8] [--repeat 9] [--out results/modes]

One ribbon clamped at both ends, bent and twisted, on meshes of degree 6 from 10 to 160 elements;
its solution is there before. The dense contender begins where ours does, with the chain of elements
of the second variation, writes both matrices of the problem down on what the conditions leave free,
and solves all of it; it has no bounds of errors, which ours has from a second mesh. Contenders
take turns; medians of CPU time are told, and the loads of the machine. Writes `bench_modes.json`
and `bench_modes.png`.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring, for all contenders.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from scipy.linalg import eigh

from ribbonopt import Solution, loads_scene, solve
from ribbonopt.arrays import Array
from ribbonopt.checks.modes import modes_of
from ribbonopt.checks.variation import Variation
from ribbonopt.checks.vibrations.kinetic import Gyration, kinetic
from ribbonopt.checks.vibrations.stated import stated
from ribbonopt.mechanics.widths import widths

SCENE = """
name: vibrating
law: {{type: variational, delta: 0.3}}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: clamped, position: [0.1, 0, 0.6], directors: {{turns: [{{z: 40*pi/180}}]}}}}
transcription: {{type: collocation, scheme: gauss, degree: 6, intervals: {0}}}
"""
ELEMENTS = (10, 20, 40, 80, 160)
DENSE_MOST = 80  # elements: beyond, a dense matrix takes minutes
TARGET = 20, 50.0  # elements, milliseconds
SHIFT = 1e4


def main() -> None:
    """Measure, print, write JSON and figure."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--count", type=int, default=8)
    parser.add_argument("--repeat", type=int, default=9)
    parser.add_argument("--out", type=Path, default=Path("results") / "modes")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    load = [os.getloadavg()[0]]
    rows = [measured(n, options.count, options.repeat) for n in ELEMENTS]
    load.append(os.getloadavg()[0])
    # How the time grows from the target's mesh to the finest: 1 is linear.
    first, last = (next(r for r in rows if r["elements"] == n) for n in (TARGET[0], ELEMENTS[-1]))
    growth = np.log(last["cpu_ms"] / first["cpu_ms"]) / np.log(last["elements"] / TARGET[0])
    result = {
        "count": options.count,
        "repeat": options.repeat,
        "cpus": os.cpu_count(),
        "load_average": load,
        "target_ms": TARGET[1],
        "growth": float(growth),
        "meshes": rows,
    }
    print(f"time grows as the number of elements to the power {growth:.2f} from {TARGET[0]} on")
    print(f"load average {load[0]:.2f} before, {load[1]:.2f} behind, on {os.cpu_count()} cores")
    text = json.dumps(result, indent=2) + "\n"
    (options.out / "bench_modes.json").write_text(text, encoding="utf-8")
    draw(rows, options.count, options.out / "bench_modes.png")
    print(f"written: {options.out}: bench_modes.json, bench_modes.png")


def measured(elements: int, count: int, repeat: int) -> dict[str, Any]:
    """Measure a mesh."""
    solution = solve(loads_scene(SCENE.format(elements)))
    variation = chain_of(solution)
    contenders: dict[str, Callable[[], Array]] = {"cpu_ms": lambda: ours(solution, count)}
    if elements <= DENSE_MOST:
        contenders["dense_ms"] = lambda: dense(solution, variation, count)
    found, taken = {}, {name: [] for name in contenders}
    for turn in range(repeat + 1):
        for name, contender in contenders.items():
            if name == "dense_ms" and turn > max(2, repeat // 3):
                continue
            start = time.process_time()
            found[name] = contender()
            if turn:  # all is built in the first
                taken[name].append(1e3 * (time.process_time() - start))
    row: dict[str, Any] = {"elements": elements, "solved_on": len(solution.nodes) - 1}
    row |= {name: statistics.median(times) for name, times in taken.items()}
    row["unknowns"] = int(variation.form.B.shape[0] * variation.form.B.shape[2])
    text = f"{elements:4d} elements: {row['cpu_ms']:7.1f} ms"
    if "dense_ms" in row:
        row["apart"] = float(np.abs(found["cpu_ms"] / found["dense_ms"] - 1).max())
        text += f", dense {row['dense_ms']:8.1f} ms (omega^2 apart by {row['apart']:.0e})"
    print(text, flush=True)
    return row


def ours(solution: Solution, count: int) -> Array:
    """Return omega^2 (k,), with shapes and bounds made besides."""
    found = modes_of(solution, count)
    if isinstance(found, str):
        raise SystemExit(found)
    return found.squared


def chain_of(solution: Solution) -> Variation:
    """Return the second variation as a chain of elements."""
    what = stated(solution, planar=False)
    if isinstance(what, str):
        raise SystemExit(what)
    return what.variation(again=False)


def dense(solution: Solution, variation: Variation, count: int) -> Array:
    """Return omega^2 (k,) by dense matrices of what the conditions leave free, and `eigh`."""
    what = stated(solution, planar=False)
    assert not isinstance(what, str)
    wide = widths(what.posed.scene, variation.stages.places)
    rows = kinetic(variation, what.ribbon.model, what.length, wide, Gyration()).rows
    form = variation.form
    elements, nx, m = form.B.shape
    n = nx + elements * m
    state = np.eye(nx, n)
    first, K, M = state, np.zeros((n, n)), np.zeros((n, n))
    for e in range(elements):
        own = np.eye(m, n, nx + e * m)
        both = np.vstack([state, own])
        K += both.T @ form.Q[e] @ both
        moved = rows[e] @ both
        M += moved.T @ moved
        state = form.A[e] @ state + form.B[e] @ own
    ends = np.vstack([first, state])
    K += ends.T @ form.ends @ ends
    conditions = form.C @ ends
    free = np.linalg.svd(conditions)[2][len(conditions) :].T
    K, M = free.T @ K @ free, free.T @ M @ free
    last = len(K) - 1
    mu = eigh(M, K + SHIFT * M, eigvals_only=True, subset_by_index=[last - count + 1, last])
    squared: Array = 1 / mu[::-1] - SHIFT
    return squared


def draw(rows: list[dict[str, Any]], count: int, path: Path) -> None:
    """Draw milliseconds by elements, both contenders, and the target."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    for name, label, colour in (
        ("cpu_ms", "chain of elements, with bounds", "#1f5fa8"),
        ("dense_ms", "dense, scipy.linalg.eigh", "#c0501a"),
    ):
        points = [(row["elements"], row[name]) for row in rows if name in row]
        axes.plot(*zip(*points, strict=True), "o-", color=colour, label=label)
    axes.plot(*TARGET, "kx", ms=9, label=f"target: {TARGET[1]:g} ms")
    axes.set(xscale="log", yscale="log", xlabel="elements of degree 6", ylabel="CPU, milliseconds")
    axes.set_title(f"{count} natural frequencies and shapes of a solution")
    axes.set_xticks(ELEMENTS, [str(n) for n in ELEMENTS])
    axes.minorticks_off()
    axes.grid(True, which="major", alpha=0.3)
    axes.legend()
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    main()
