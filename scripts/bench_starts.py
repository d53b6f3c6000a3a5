"""How far the starts reach: random clamps, noise on a start, and scenes without their guess.

    python scripts/bench_starts.py [--out results/bench_starts] [--only clamps noise nothing]
                                   [--count 200] [--seeds 50] [--repeat 5]

Everything is seeded; failures are counted with their messages, and times are those of all solves,
failures included. Writes `bench_starts.json` and, of all parts, `bench_starts.png`.
"""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from bench_path import ROOT, medians
from results_machine import conditions
from starts_clamps import bench_clamps
from starts_noise import LEVELS, SAME, bench_noise, bench_peer

from ribbonopt.output.summary import versions
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.studies.machine import machine

BLUE, RED, GREEN, GREY, LIGHT = "#1f5fa8", "#c2410c", "#2f7d32", "#777777", "#b8b8b8"
SHADES = ("#7fb0dd", "#7b3fa0", "#8a6d00")


def main() -> None:
    """Run all parts, print the tables, write JSON and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "bench_starts")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS))
    parser.add_argument("--count", type=int, default=200, help="random clamps")
    parser.add_argument("--seeds", type=int, default=50, help="seeds at each level of noise")
    parser.add_argument("--repeat", type=int, default=5, help="runs of each scene from nothing")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    parts: dict[str, Callable[[], Any]] = {
        "clamps": lambda: bench_clamps(options.count),
        "noise": lambda: [*bench_noise(options.seeds), *bench_peer(options.seeds)],
        "nothing": lambda: bench_nothing(options.repeat),
    }
    result = {
        "machine": machine(),
        "versions": versions(),
        "seeds": options.seeds,
        "load_before": os.getloadavg(),
    } | conditions()
    for name in options.only:
        result[name] = parts[name]()
        REPORTS[name](result[name])
    result["load_after"] = os.getloadavg()
    (options.out / "bench_starts.json").write_text(json.dumps(result, indent=2) + "\n")
    print(f"written: {options.out / 'bench_starts.json'}")
    if set(PARTS) <= set(result):
        draw(result, options.out / "bench_starts.png")
        print(f"written: {options.out / 'bench_starts.png'}")


def bench_nothing(repeat: int) -> list[dict[str, Any]]:
    """Time whole solves, building included, of every scene from its own guess and from none."""
    rows = []
    for path in sorted((ROOT / "configs").glob("*.yaml")):
        scenes = {"auto": load_scene(path, ["guess=auto"])}
        if load_scene(path).guess != "auto":
            scenes["own"] = load_scene(path)
        solutions = {name: solve(scene) for name, scene in scenes.items()}
        runs = {name: lambda scene=scene: solve(scene) for name, scene in scenes.items()}
        auto, own = solutions["auto"], solutions.get("own")
        off, other = None, ""
        if own is not None:  # signs may differ by symmetry
            loads = [np.abs(np.append(s.n0, s.m0)) for s in (auto, own)]
            off = float(np.abs(loads[0] - loads[1]).max() / max(loads[1].max(), 1e-300))
            if off > SAME:
                other = f"another equilibrium: energy {auto.energy:.6g}, own {own.energy:.6g}"
        rows.append(
            {
                "scene": path.stem,
                "verified": {name: solution.verified for name, solution in solutions.items()},
                "message": auto.message,
                "ms": {name: 1e3 * value for name, value in medians(repeat, runs).items()},
                "difference": off,
                "other": other,
            }
        )
    return rows


def report_clamps(clamps: dict[str, Any]) -> None:
    """Print what came of random clamps."""
    print(f"random clamps (the first, with what is built: {clamps['first_s']:.2f} s)")
    for name, row in clamps["summary"].items():
        median, ninety, largest = row["ms"]
        cpu = " / ".join(f"{value:.0f}" for value in row["cpu_ms"])
        print(
            f"  {name:<16} {row['verified']} of {row['count']} verified; median {median:.0f}, "
            f"90 % {ninety:.0f}, largest {largest:.0f} ms (CPU {cpu}); "
            f"{row['ipopt_iterations']:g} iterations of IPOPT\n"
            f"    failures {row['failures']}, seeds {row['failed_seeds'][:10]}"
        )
        if name == "automatic start":
            again = row["minimised_again"]
            print(f"    by number of shapes {row['shapes']}, of minimisations again {again}")
    both = clamps["energy_where_both"]
    print(f"  energy from the automatic start against the other, where both solved: {both}")


def report_noise(noise: list[dict[str, Any]]) -> None:
    """Print what came of starts with noise."""
    print(f"Moebius ribbons found, noise {', '.join(f'{level:.0%}' for level in LEVELS)}")
    for method, rows in by_method(noise).items():
        found = " / ".join(f"{row['found']}" for row in rows)
        ms = " / ".join(f"{row['ms_median']:.0f}" for row in rows)
        most = " / ".join(f"{row['ms_max']:.0f}" for row in rows)
        print(f"  {method:<42} {found} of {rows[0]['seeds']}; CPU median {ms}, most {most} ms")
        for row in rows:
            if row["not_found"]:
                print(f"    {row['level']:.0%}: {row['not_found']}")
    gaps = [row["gap_max"] for row in noise if row["gap_max"] is not None]
    print(f"  integrated anew, answers are off by {max(gaps):.0e} at most")


def report_nothing(nothing: list[dict[str, Any]]) -> None:
    """Print what came of scenes without their guess."""
    print("from nothing, whole solves in ms (loads against those from the scene's own guess)")
    for row in nothing:
        own, off = row["ms"].get("own"), row["difference"]
        beside = "own guess: none" if own is None else f"own guess {own:7.1f}, differ by {off:.0e}"
        failed = row["other"]
        if not all(row["verified"].values()):
            failed = f"NOT VERIFIED: {row['verified']}, {row['message']}"
        print(f"  {row['scene']:<22} auto {row['ms']['auto']:7.1f}  {beside}  {failed}".rstrip())


REPORTS: dict[str, Callable[[Any], None]] = {
    "clamps": report_clamps,
    "noise": report_noise,
    "nothing": report_nothing,
}
PARTS = tuple(REPORTS)


def by_method(noise: list[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """Return the rows of each ribbon and method, by level of noise."""
    found: dict[str, list[dict[str, Any]]] = {}
    for row in noise:
        found.setdefault(f"{row['scene']}: {row['method']}", []).append(row)
    return found


def draw(result: dict[str, Any], path: Path) -> None:
    """Draw times of the clamps, success rates, and times from nothing."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(15, 4.8), layout="constrained")
    FigureCanvasAgg(figure)
    left, middle, right = figure.subplots(1, 3)
    _times(left, result["clamps"])
    _rates(middle, result)
    _nothing(right, result["nothing"])
    for axes in (left, middle, right):
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=150)


def _times(axes: Any, clamps: dict[str, Any]) -> None:
    """Histogram of the times of random clamps."""
    ms = {name: [row["ms"] for row in rows] for name, rows in clamps["rows"].items()}
    every = np.concatenate(list(ms.values()))
    bins = np.geomspace(0.9 * every.min(), 1.1 * every.max(), 40)
    for (name, values), colour in zip(ms.items(), (BLUE, RED), strict=True):
        good = clamps["summary"][name]["verified"]
        label = f"{name}: {good} of {len(values)} solved"
        axes.hist(values, bins, color=colour, alpha=0.8, label=label)
    axes.set(xscale="log", xlabel="time of one solve (ms), failures included", ylabel="solves")
    axes.set_title("random clamps")
    ticks = [k * 10**e for e in range(1, 6) for k in (1, 2, 5)]
    axes.set_xticks([t for t in ticks if bins[0] < t < bins[-1]])
    axes.set_xticks([], minor=True)
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_ylim(0, 1.3 * axes.get_ylim()[1])
    axes.legend(frameon=False, fontsize=9, loc="upper left")


def _rates(axes: Any, result: dict[str, Any]) -> None:
    """Bars: share found from starts with noise."""
    rates = {
        name: [row["found"] / row["seeds"] for row in rows]
        for name, rows in by_method(result["noise"]).items()
    }
    width, places = 0.8 / len(rates), np.arange(len(LEVELS))
    colours = (BLUE, GREEN, RED, *SHADES, GREY, LIGHT)
    for i, ((name, shares), colour) in enumerate(zip(rates.items(), colours, strict=False)):
        at = places + (i - (len(rates) - 1) / 2) * width
        bars = axes.bar(at, shares, 0.92 * width, color=colour, label=name)
        axes.bar_label(bars, [f"{100 * share:.0f}" for share in shares], fontsize=6, padding=1)
    axes.set_xticks(places, [f"{level:.0%} noise" for level in LEVELS])
    axes.set(ylabel="share that found the band", title="Moebius ribbons, noise on the start")
    axes.set_ylim(0, 1.6)
    axes.set_yticks([0, 0.5, 1], ["0", "50 %", "100 %"])
    axes.legend(frameon=False, fontsize=7, ncols=2, loc="upper center")


def _nothing(axes: Any, rows: list[dict[str, Any]]) -> None:
    """Bars: whole solves of each scene from nothing and from its own guess."""
    places = np.arange(len(rows))[::-1]
    for name, colour, shift in (("auto", BLUE, 0.2), ("own", GREY, -0.2)):
        ms = [row["ms"].get(name, 0) for row in rows]
        label = {"auto": "no guess", "own": "the scene's own guess"}[name]
        axes.barh(places + shift, ms, 0.38, color=colour, label=label)
    names = [row["scene"] + (" (another)" if row["other"] else "") for row in rows]
    failed = ["" if all(row["verified"].values()) else " (failed)" for row in rows]
    axes.set_yticks(places, map("".join, zip(names, failed, strict=True)), fontsize=8)
    axes.set(xlabel="whole solve, building included (ms)", title="scenes of configs/")
    axes.set_ylim(-0.7, 1.08 * len(rows) + 0.6)
    axes.legend(frameon=False, fontsize=9, loc="upper left", ncols=2)


if __name__ == "__main__":
    main()
