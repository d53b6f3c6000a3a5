"""Work that `bench_compiled.py` times, done by the package that Python finds first.

A line of the input is `[case, count, turn]` in JSON, a line of the output the CPU seconds of one of
`count` answers and what they are. The structure of a case is built, and solved once, before it is
timed. Only what older checkouts have as well is used here.

    PYTHONPATH=CHECKOUT python scripts/compiled_cases.py
"""

from __future__ import annotations

import gc
import json
import math
import os
import sys
import time
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

CONFIGS = Path(__file__).resolve().parent.parent / "configs"
HALF, WHOLE = CONFIGS / "moebius_half.yaml", CONFIGS / "moebius_regularized.yaml"
PEERS = "guess={force: [0, 40, 40], moment: [0, 2, -9]}"  # what the peers start from
BRANCH = "half Moebius, epsilon 0.1 to 1e-4"  # of `branch_cases`
# name: scene, tolerance, degree, intervals of the first mesh
ANSWERS = {
    "half 1e-6": (HALF, 1e-6, 6, 6),
    "half 1e-9": (HALF, 1e-9, 6, 8),
    "half 1e-12": (HALF, 1e-12, 8, 8),
    "whole 1e-9": (WHOLE, 1e-9, 7, 10),
}
CASES = (*ANSWERS, "branch", "batch half 1e-8", "batch clamps 1e-6", "clamp from nothing")
FIRST = 25  # ribbons of a batch that are not counted: the worker's start is among them


def clamp_study(distances: int, turns: int) -> str:
    """Return the study of ribbons between clamps, one of them turned."""
    return f"""\
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
    parameters.distance: {{from: 0.5, to: 0.95, count: {distances}}}
    parameters.turn: {{from: -1.5, to: 1.5, count: {turns}}}
"""


BATCHES = {
    "batch half 1e-8": f"""\
name: half
scene: {HALF}
set: {{law: {{type: regularized, epsilon: 0.1}}, tolerance: 1e-8}}
sweep: {{grid: {{law.epsilon: {{from: 0.1, to: 1e-4, count: 250, scale: log}}}}}}
""",
    "batch clamps 1e-6": clamp_study(40, 5),
}

Found = dict[str, Any]
Work = Callable[[int, int], Found]


def answers(name: str) -> Work:
    """Solve a scene from the loads that peers start from, with its error bar."""
    from ribbonopt import load_scene, prepare
    from ribbonopt.accuracy.estimate import estimate_error

    path, tolerance, degree, intervals = ANSWERS[name]
    settings = [f"tolerance={tolerance}", PEERS, f"transcription.degree={degree}"]
    prepared = prepare(load_scene(path, [*settings, f"transcription.intervals={intervals}"]))

    def work(count: int, turn: int) -> Found:
        used = time.process_time()
        for _ in range(count):
            solution = prepared.solve()
            bars = estimate_error(solution)
        seconds = (time.process_time() - used) / count
        loads = [*solution.n0.tolist(), *solution.m0.tolist()]
        bar = max(bars["n0"], bars["m0"]) / max(map(abs, loads))
        return {"cpu_s": seconds, "verified": solution.verified, "numbers": loads, "bar": bar}

    return work


def branch(name: str) -> Work:
    """Follow the branch, structure kept."""
    from branch_cases import CASES as BRANCHES

    from ribbonopt import Continuation, loads_scene

    case = BRANCHES[BRANCH]
    scene = loads_scene(case.scene, overrides=list(case.settings))
    prepared = Continuation(scene).prepared

    def work(count: int, turn: int) -> Found:
        used = time.process_time()
        for _ in range(count):
            continuation = Continuation(scene, prepared)
            points = list(continuation)
        seconds = (time.process_time() - used) / count
        row = points[-1].row
        return {
            "cpu_s": seconds,
            "verified": continuation.ending.reached and all(p.solution.verified for p in points),
            "numbers": [row[f"{load}0{x}"] for load in "nm" for x in "xyz"],
            "bar": max(p.row["error"] or 0.0 for p in points if p.kind == "point"),
            "points": len(points),
        }

    return work


def batch(name: str) -> Work:
    """Solve a study by one worker: CPU of a ribbon, the first ones and what they start are off."""
    from ribbonopt import load_study, run_batch

    def work(count: int, turn: int) -> Found:
        with TemporaryDirectory() as folder:
            path = Path(folder) / "study.yaml"
            path.write_text(BATCHES[name], encoding="utf-8")
            rows: list[Found] = []
            for row in run_batch(load_study([path]), jobs=1):
                rows.append(row)
                if len(rows) == FIRST:
                    used = seconds_of_all() + seconds_of_children()
        seconds = seconds_of_all() - used
        rows.sort(key=lambda row: int(row["number"]))
        return {
            "cpu_s": seconds / (len(rows) - FIRST),
            "verified": all(row["verified"] for row in rows),
            "numbers": [row["energy"] for row in rows],
        }

    return work


def clamps(name: str) -> Work:
    """Solve random clamps from nothing, others in every turn."""
    from starts_clamps import clamps as clamp

    from ribbonopt import prepare

    prepared = prepare(clamp(1000))
    prepared.solve()  # builds what the automatic start needs

    def work(count: int, turn: int) -> Found:
        scenes = [clamp(count * turn + k) for k in range(count)]
        used = time.process_time()
        solutions = [prepared.solve(scene) for scene in scenes]
        return {
            "cpu_s": (time.process_time() - used) / count,
            "verified": all(solution.verified for solution in solutions),
            "numbers": [solution.energy for solution in solutions],
        }

    return work


def seconds_of_all() -> float:
    """CPU of this process and of those that it has started and that have ended."""
    return math.fsum(os.times()[:4])


def seconds_of_children() -> float:
    """CPU of the processes that it has started and that still run; Linux only."""
    used = 0.0
    for children in Path("/proc/self/task").glob("*/children"):
        for number in children.read_text().split():
            words = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()
            used += sum(map(int, words[11:13])) / os.sysconf("SC_CLK_TCK")
    return used


def built(name: str) -> Work:
    """Return the work of a case, its structure built."""
    if name in ANSWERS:
        return answers(name)
    if name in BATCHES:
        return batch(name)
    return {"branch": branch, "clamp from nothing": clamps}[name](name)


def kernel() -> str:
    """Return what this package says of its kernel; checkouts from before it have none."""
    home = import_module("ribbonopt").__file__ or ""
    if not Path(home).with_name("kernel").is_dir():  # another one may be installed
        return "none"
    return str(import_module("ribbonopt.kernel").STATE)


def main() -> None:
    """Answer line by line; the first line asks for nothing but the versions."""
    from ribbonopt.output.summary import versions

    print(json.dumps({"kernel": kernel()} | versions()), flush=True)
    works: dict[str, Work] = {}
    for line in sys.stdin:
        name, count, turn = json.loads(line)
        if name not in works:
            works[name] = built(name)
        gc.collect()
        print(json.dumps(works[name](count, turn)), flush=True)


if __name__ == "__main__":
    main()
