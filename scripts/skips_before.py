"""Scenes as such against an older checkout: part of `bench_skips.py`, and the process for each.

Started as a script it reads a case a line and writes what a turn of it took.
"""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
SMOOTH = "law={type: variational, delta: 0.05}"
TOLERANCE = "tolerance=1e-9"
# how, scene, overrides, solves in a turn; `own` from the answer, `near` from that of a smooth law
CASES: tuple[tuple[str, str, list[str], int], ...] = (
    ("warm", "moebius_half", [], 10),
    ("cold", "moebius_half", [], 1),
    ("own", "moebius_half", [], 10),
    ("warm", "moebius_regularized", [], 5),
    ("cold", "moebius_regularized", [], 1),
    ("warm", "moebius_regularized", [TOLERANCE], 5),
    ("cold", "moebius_regularized", [TOLERANCE], 1),
    ("near", "moebius_regularized", [TOLERANCE], 5),
    ("own", "moebius_whole", [], 5),
    ("near", "moebius_whole", [], 3),
    ("warm", "moebius_whole", [], 1),
    ("cold", "moebius_whole", [], 1),
    ("warm", "moebius_variational", [TOLERANCE], 5),
    ("warm", "clamped_twist", [], 1),
    ("cold", "clamped_twist", [], 1),
    ("warm", "elastica_clamped", [], 10),
    ("warm", "heavy_cantilever", [], 3),
    ("warm", "end_moment", [], 10),
)


def against(before: Path, turns: int) -> list[dict[str, Any]]:
    """Return for each case medians of CPU ms before and now, and of the ratio of the turns."""
    contenders = [_Process(before), _Process(ROOT)]
    rows = []
    for how, name, overrides, count in CASES:
        found: tuple[list[dict[str, Any]], ...] = ([], [])
        for turn in range(turns + 1):
            for i in (0, 1) if turn % 2 else (1, 0):
                answer = contenders[i].ask([how, name, overrides, count])
                found[i].extend([answer] if turn else [])
        ms = [[one["ms"] for one in each] for each in found]
        ratios = sorted(a / b for a, b in zip(*ms, strict=True))
        row = {
            "how": how,
            "scene": " ".join([name, *overrides]),
            "ms_before": statistics.median(ms[0]),
            "ms": statistics.median(ms[1]),
            "ratio": statistics.median(ratios),
            "quartiles": [ratios[len(ratios) // 4], ratios[-1 - len(ratios) // 4]],
            "verified": all(one["verified"] for each in found for one in each),
        }
        rows.append(row)
        print(
            f"{how} {row['scene']:<40} {row['ms_before']:8.2f} -> {row['ms']:8.2f} ms: "
            f"{row['ratio']:.2f} {'' if row['verified'] else 'NOT VERIFIED'}",
            flush=True,
        )
    for one in contenders:
        one.close()
    return rows


class _Process:
    """A process that works with the package of a checkout."""

    def __init__(self, checkout: Path) -> None:
        if not (checkout / "ribbonopt").is_dir():
            raise SystemExit(f"--before: found {checkout}, expected a folder that has ribbonopt/")
        environment = os.environ | {"PYTHONPATH": str(checkout.resolve())}
        self._process = subprocess.Popen(
            [sys.executable, __file__],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
        )

    def ask(self, case: list[Any]) -> dict[str, Any]:
        assert self._process.stdin is not None and self._process.stdout is not None
        print(json.dumps(case), file=self._process.stdin, flush=True)
        line = self._process.stdout.readline()
        if not line:
            raise SystemExit(f"{case}: the process has ended, as said above")
        found: dict[str, Any] = json.loads(line)
        return found

    def close(self) -> None:
        self._process.communicate()


def _way(how: str, name: str, overrides: list[str]) -> Callable[[], Any]:
    """Return what a turn does, all else built."""
    from ribbonopt.pipeline.neighbour import Latest
    from ribbonopt.pipeline.prepared import prepare, solve
    from ribbonopt.scene import load_scene

    path = ROOT / "configs" / f"{name}.yaml"
    scene = load_scene(path, overrides)
    if how == "cold":
        return lambda: solve(scene)
    prepared = prepare(scene)
    if how == "warm":
        return prepared.solve
    other = replace(load_scene(path, [*overrides, SMOOTH]), tolerance=None)
    guess = prepared.solve() if how == "own" else solve(other)
    return lambda: replace(prepared, _latest=Latest()).solve(guess=guess)


def _work() -> None:
    ways: dict[str, Callable[[], Any]] = {}
    for line in sys.stdin:
        how, name, overrides, count = json.loads(line)
        way = ways.setdefault(line, _way(how, name, overrides)) if line not in ways else ways[line]
        started = time.process_time()
        for _ in range(count):
            found = way()
        ms = 1e3 * (time.process_time() - started) / count
        print(json.dumps({"ms": ms, "verified": found.verified}), flush=True)


if __name__ == "__main__":
    _work()
