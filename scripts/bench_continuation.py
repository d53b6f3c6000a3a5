"""What branches cost, in CPU seconds and per point, beside another checkout and scipy.

    python scripts/bench_continuation.py [--against CHECKOUT] [--peers] [--repeat 5]
        [--out results/continuation]

The branches are those of `branch_cases`. Each checkout has a process of its own, in which all is
built before it is measured; contenders take turns in one run, so that ratios hold on a noisy
machine, and all that is told is a median. A branch that ends short of its goal is followed once.
Writes `bench_continuation.json` and `bench_continuation.png`.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring, for all contenders.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
import peer_branch
from branch_cases import CASES, CONFIGS

from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene

ROOT = Path(__file__).resolve().parent.parent
HALF = next(iter(CASES))  # what the peer follows too
THIS, OTHER, PEER = "this checkout", "the other", "scipy solve_bvp"

Runs = dict[str, list[dict[str, Any]]]


class Checkout:
    """A process that follows branches with the package of a checkout."""

    def __init__(self, path: Path) -> None:
        """Start it; without a package there Python would take the one that is installed."""
        if not (path / "ribbonopt").is_dir():
            raise SystemExit(f"--against: found {path}, expected a folder that has ribbonopt/")
        self._process = subprocess.Popen(
            [sys.executable, str(ROOT / "scripts" / "branch_cases.py")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | {"PYTHONPATH": str(path.resolve())},
        )

    def follow(self, name: str) -> dict[str, Any]:
        """Follow a branch of `CASES`."""
        process = self._process
        assert process.stdin is not None and process.stdout is not None
        print(name, file=process.stdin, flush=True)
        line = process.stdout.readline()
        if not line:
            raise SystemExit(f"{name}: a process has ended, for the reason above")
        found: dict[str, Any] = json.loads(line)
        return found

    def close(self) -> None:
        """End it."""
        self._process.communicate()


def main() -> None:
    """Measure, print, write JSON and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--against", type=Path, help="another checkout of this package")
    parser.add_argument("--peers", action="store_true", help="solve_bvp in a loop as well")
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--out", type=Path, default=Path("results") / "continuation")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    checkouts = {THIS: Checkout(ROOT)}
    if options.against:
        checkouts[OTHER] = Checkout(options.against)
    load = [os.getloadavg()[0]]
    branches = {}
    for name in CASES:
        follow = {label: checkout.follow for label, checkout in checkouts.items()}
        runs = interleaved(name, follow, options.repeat, options.peers and name == HALF)
        branches[name] = {label: summary(found) for label, found in runs.items()}
        if OTHER in runs:
            branches[name]["ratio"] = ratio(runs[THIS], runs[OTHER])
        report(name, branches[name])
    load.append(os.getloadavg()[0])
    for checkout in checkouts.values():
        checkout.close()
    result: dict[str, Any] = {
        "repeat": options.repeat,
        "cpus": os.cpu_count(),
        "load_average": load,
        "against": str(options.against) if options.against else None,
        "branches": branches,
        "error_at_the_end": errors({k: v for k, v in branches[HALF].items() if k != "ratio"}),
    }
    for label, error in result["error_at_the_end"].items():
        print(f"{HALF}: error of the last n(0), m(0) by {label}: {error:.1e}")
    print(f"load average {load[0]:.2f} before, {load[1]:.2f} behind, on {os.cpu_count()} cores")
    text = json.dumps(result, indent=2) + "\n"
    (options.out / "bench_continuation.json").write_text(text, encoding="utf-8")
    draw(branches, options.out / "bench_continuation.png")
    print(f"written: {options.out}: bench_continuation.json, bench_continuation.png")


def interleaved(
    name: str, follow: dict[str, Callable[[str], dict[str, Any]]], repeat: int, peer: bool
) -> Runs:
    """Follow a branch by turns; the first time, when all is built, is the first of the runs."""
    contenders = dict(follow)
    if peer:
        contenders[PEER] = lambda _: peer_branch.follow()
    runs: Runs = {label: [run(name)] for label, run in contenders.items()}
    for _ in range(repeat):
        for label, run in contenders.items():
            if runs[label][0].get("reached", True):
                runs[label].append(run(name))
    return runs


def summary(runs: list[dict[str, Any]]) -> dict[str, Any]:
    """Return medians, and what the branch was."""
    again = runs[1:] or runs
    middle = sorted(again, key=lambda run: run["cpu_s"])[len(again) // 2]
    cpu = statistics.median(run["cpu_s"] for run in again)
    found = middle | {
        "first_s": runs[0]["cpu_s"],
        "cpu_s": cpu,
        "wall_s": statistics.median(run["wall_s"] for run in again),
        "least_s": min(run["cpu_s"] for run in again),
        "point_ms": 1e3 * cpu / middle["points"],
    }
    if middle.get("counted"):
        found["stability_ms"] = 1e3 * middle["parts_s"]["stability"] / middle["counted"]
    return found


def ratio(these: list[dict[str, Any]], others: list[dict[str, Any]]) -> float | None:
    """Median of the other's CPU over this one's, turn by turn; None if one falls short."""
    if not (these[0]["reached"] and others[0]["reached"]):
        return None
    pairs = zip(these[1:] or these, others[1:] or others, strict=True)
    return statistics.median(b["cpu_s"] / a["cpu_s"] for a, b in pairs)


def errors(found: dict[str, dict[str, Any]]) -> dict[str, float]:
    """Relative errors of n(0), m(0) at the last epsilon, against an answer to 1e-12."""
    settings = ["law={type: regularized, epsilon: 1e-4}", "tolerance=1e-12"]
    exact = solve(load_scene(CONFIGS / "moebius_half.yaml", [*settings, "transcription.degree=8"]))
    truth = np.array([*exact.n0, *exact.m0])
    return {
        label: float(np.abs(np.array(one["loads"]) - truth).max() / np.abs(truth).max())
        for label, one in found.items()
    }


def report(name: str, branch: dict[str, Any]) -> None:
    """Print a branch: a line for each contender."""
    print(f"{name}{target(name)}")
    for label, one in branch.items():
        if label == "ratio":
            continue
        text = (
            f"  {label}: {one['cpu_s']:.3f} s of CPU (least {one['least_s']:.3f}, first "
            f"{one['first_s']:.3f}), {one['points']} points, {one['point_ms']:.1f} ms a point"
        )
        if one.get("stability_ms") is not None:
            text += f", stability {one['stability_ms']:.1f} ms where counted ({one['counted']})"
        if one.get("special"):
            text += f"; {', '.join(one['special'])}"
        if not one.get("reached", True):
            text += f"; ENDS SHORT: {one['ending'].partition(':')[0]}"
        print(text)
        if parts := ", ".join(f"{k} {1e3 * s:.0f}" for k, s in one.get("parts_s", {}).items()):
            print(f"    in ms: {parts}")
    if branch.get("ratio"):
        print(f"  the other takes {branch['ratio']:.2f} times as long")


def target(name: str) -> str:
    """Say what a branch is to cost; empty where nothing is asked."""
    case = CASES[name]
    if case.seconds is not None:
        return f" (target {case.seconds:g} s)"
    return "" if case.point_ms is None else f" (target {case.point_ms:g} ms a point)"


def draw(branches: dict[str, dict[str, Any]], path: Path) -> None:
    """Draw milliseconds a point: bars, and the targets."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 4.6), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    colours = {THIS: "#1f5fa8", OTHER: "#c0501a", PEER: "#5a8f3c"}
    height, told = 0.26, set()
    for row, (name, branch) in enumerate(branches.items()):
        labels = [label for label in colours if label in branch]
        for k, label in enumerate(labels):
            one, y = branch[label], row + height * (k - (len(labels) - 1) / 2)
            bar = {"color": colours[label], "label": None if label in told else label}
            axes.barh(y, one["point_ms"], 0.9 * height, **bar)
            told.add(label)
            short = "" if one.get("reached", True) else ", ends short"
            judged = one.get("stability_ms") or 0.0
            share = f", stability {judged:.0f} ms each" if judged >= 1 else ""
            text = f"  {one['cpu_s']:.2f} s, {one['points']} points{share}{short}"
            axes.text(one["point_ms"], y, text, va="center", fontsize=8)
        case, points = CASES[name], branch[THIS]["points"]
        wanted = 1e3 * case.seconds / points if case.seconds else case.point_ms
        if wanted:
            axes.plot([wanted] * 2, [row - 0.45, row + 0.45], "k--", lw=1.2)
            axes.text(wanted, row - 0.46, "target", ha="center", fontsize=8)
    axes.set(xscale="log", xlabel="CPU, milliseconds a point", title="Branches, all built before")
    axes.set_xlim(5, 40 * max(one["point_ms"] for b in branches.values() for one in each(b)))
    axes.set_yticks(range(len(branches)), list(branches))
    axes.set_ylim(len(branches) - 0.4, -0.7)
    axes.grid(True, axis="x", which="major", alpha=0.3)
    axes.legend(loc="upper right")
    figure.savefig(path, dpi=150)


def each(branch: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the contenders of a branch."""
    return [one for one in branch.values() if isinstance(one, dict)]


if __name__ == "__main__":
    main()
