"""What a scene does not need and is not made: each skip, why, and the CPU time that it saves.

    python scripts/bench_skips.py [--before CHECKOUT] [--turns 15] [--only WORD ...]
        [--out results/skips] [--figure scripts/figures/skips.png]

Both ways of a case are gone by turns in one process, all built before unless building is what is
skipped; told are medians of CPU time and of the ratios of the turns, so that they hold on a busy
machine. Both ways must end in the same answer. Of whole commands the children's CPU time counts.
With `--before` scenes as such against an older checkout. Writes `skips.json`, `skips.md` and the
figure.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from skips_before import against
from skips_cases import CASES, CONFIGS, Case, Way
from skips_figure import draw
from skips_positions import positions_case

from ribbonopt.solution.solution import Solution
from ribbonopt.studies.machine import machine

LEAST = 0.02  # seconds that a turn of either way takes at least
SAME = 1e-6  # of n(0), m(0), by which both ways may differ: the loosest tolerance of a case
EVERY = """
import contextlib, importlib, pkgutil, sys, ribbonopt
import matplotlib.figure, matplotlib.backends.backend_agg
for found in pkgutil.walk_packages(ribbonopt.__path__, "ribbonopt."):
    if not found.name.endswith("__main__"):
        with contextlib.suppress(Exception):  # of what is not installed
            importlib.import_module(found.name)
from ribbonopt.cli import main
sys.exit(main(["solve", sys.argv[1], "--quiet"]))
"""
ONE = "import sys\nfrom ribbonopt.cli import main\nmain(['solve', sys.argv[1], '--quiet'])"

Row = dict[str, Any]


def main() -> None:
    """Measure, print, write JSON, table and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--before", type=Path, help="an older checkout of this package, built")
    parser.add_argument("--turns", type=int, default=15)
    parser.add_argument(
        "--only", nargs="+", default=[""], help="cases that have one of these words"
    )
    parser.add_argument("--out", type=Path, default=Path("results") / "skips")
    parser.add_argument("--figure", type=Path, help="where else the figure goes")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    load = os.getloadavg()[0]
    chosen = [case for case in CASES if any(word in case.skipped for word in options.only)]
    rows = [told(measured(case, options.turns)) for case in chosen]
    result: dict[str, Any] = {"machine": machine(), "turns": options.turns, "load_before": load}
    if options.only == [""]:
        rows += [told(row) for row in (*others(), imports(max(3, options.turns // 3)))]
        result["positions"] = positions(options.turns)
        print("positions:", result["positions"])
    rows.sort(key=lambda row: -row["ratio"])
    result |= {"rows": rows, "load_after": os.getloadavg()[0]}
    if options.before:
        result["before"] = against(options.before, options.turns)
    (options.out / "skips.json").write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")
    (options.out / "skips.md").write_text(table(rows), encoding="utf-8")
    for place in filter(None, (options.out / "skips.png", options.figure)):
        draw(rows, place)
    print(f"load {load:.1f} before, {result['load_after']:.1f} after; written: {options.out}")


def measured(case: Case, turns: int) -> Row:
    """Go both ways of a case by turns."""
    short, long = case.ways()
    first, other = short(), long()
    if isinstance(first, Solution) and isinstance(other, Solution):
        compare(case, first, other)
    seconds = timed((short, long), case.turns or turns)
    return row_of(case.skipped, case.why, case.scene, *seconds)


def compare(case: Case, first: Solution, other: Solution) -> None:
    """Refuse to time ways that end in different answers, or in none."""
    numbers = [np.append(found.n0, found.m0) for found in (first, other)]
    off = float(np.abs(numbers[0] - numbers[1]).max() / np.abs(numbers[1]).max())
    if not (first.verified and other.verified and off <= SAME):
        raise SystemExit(f"{case.skipped}: the ways differ by {off:.1e}; {first.message}")


def timed(ways: tuple[Way, ...], turns: int) -> tuple[list[float], ...]:
    """CPU seconds of each way, turn by turn, every other turn the other way round."""
    counts = [max(1, round(LEAST / max(cpu(way, 1), 1e-6))) for way in ways]
    found: tuple[list[float], ...] = tuple([] for _ in ways)
    for turn in range(turns):
        order = range(len(ways)) if turn % 2 else reversed(range(len(ways)))
        for i in order:
            found[i].append(cpu(ways[i], counts[i]))
    return found


def cpu(way: Way, count: int) -> float:
    """CPU seconds of one of so many goes."""
    started = time.process_time()
    for _ in range(count):
        way()
    return (time.process_time() - started) / count


def row_of(skipped: str, why: str, scene: str, short: list[float], long: list[float]) -> Row:
    """Return a row: medians in ms, and of the ratio with its quartiles."""
    ratios = sorted(b / a for a, b in zip(short, long, strict=True))
    return {
        "skipped": skipped,
        "why": why,
        "scene": scene,
        "ms": 1e3 * statistics.median(short),
        "ms_long": 1e3 * statistics.median(long),
        "ratio": statistics.median(ratios),
        "quartiles": [ratios[len(ratios) // 4], ratios[-1 - len(ratios) // 4]],
    }


def others() -> list[Row]:
    """Rows of a plane and of symmetries, where there are scripts for these."""
    rows = []
    if find_spec("skips_planar"):
        one = import_module("skips_planar").planar_case()
        ms = one["plane_ms"], one["space_ms"]
        rows.append(plain("what is across the plane", "`planar: true`", one["scene"], *ms))
    if find_spec("skips_symmetry"):
        for one in import_module("skips_symmetry").symmetry_case():
            why = f"symmetry repeats a piece ({one['piece']})"
            rows.append(plain("the rest of the loop", why, one["scene"], *whole_and_piece(one)))
    return rows


def whole_and_piece(one: Row) -> tuple[float, float]:
    """Milliseconds of the piece and of the whole."""
    whole = next(v for k, v in one.items() if "ms" in k and "whole" in k)
    piece = next(v for k, v in one.items() if "ms" in k and "piece" in k)
    return piece, whole


def plain(skipped: str, why: str, scene: str, ms: float, ms_long: float) -> Row:
    """Return a row of what another script has measured."""
    ratio = ms_long / ms
    row = {"skipped": skipped, "why": why, "scene": scene, "ms": ms, "ms_long": ms_long}
    return row | {"ratio": ratio, "quartiles": [ratio, ratio]}


def imports(turns: int) -> Row:
    """Return the row of a whole command that imports what it uses, and of one that imports all."""
    path = str(CONFIGS / "moebius_half.yaml")
    ways = tuple(process(code, path) for code in (ONE, EVERY))
    short, long = children(ways, turns)
    words = "imports of what is not used", "each is where it is used", "half Moebius, whole command"
    return row_of(*words, short, long)


def children(ways: tuple[Callable[[], None], ...], turns: int) -> tuple[list[float], list[float]]:
    """CPU seconds of child processes, by turns, after one of each."""
    found: tuple[list[float], list[float]] = [], []
    for turn in range(turns + 1):
        for way, seconds in zip(ways, found, strict=True):
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            way()
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            if turn:
                spent = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
                seconds.append(spent)
    return found


def process(code: str, path: str) -> Callable[[], None]:
    """Return what runs code in a process of its own."""
    return lambda: subprocess.run([sys.executable, "-c", code, path], check=True) and None


def positions(turns: int) -> dict[str, float]:
    """Return milliseconds of an answer, and of Newton's method with positions and without."""
    ways = positions_case()
    seconds = timed(tuple(ways.values()), turns)
    return {name: 1e3 * statistics.median(found) for name, found in zip(ways, seconds, strict=True)}


def told(row: Row) -> Row:
    """Print a row."""
    low, high = row["quartiles"]
    print(
        f"{row['skipped']:<45} {row['ms']:9.2f} ms, with it {row['ms_long']:9.2f}: "
        f"{row['ratio']:.2f} [{low:.2f}, {high:.2f}]  {row['scene']}",
        flush=True,
    )
    return row


def table(rows: list[Row]) -> str:
    """Return the table in Markdown, what saves most first."""
    lines = ["| skipped | why | on | ms | with it | saves |", "|---|---|---|---|---|---|"]
    for row in rows:
        numbers = f"{row['ms']:.3g} | {row['ms_long']:.3g} | {row['ratio']:.3g} times"
        lines.append(f"| {row['skipped']} | {row['why']} | {row['scene']} | {numbers} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
