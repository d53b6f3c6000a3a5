"""Random clamps: ribbons held at both ends, the far one anywhere and turned at random.

Part of `bench_starts.py`. The automatic start, and beside it the loads that a user might try first:
no force, a moment of one about each axis, integrated to a shape; Newton's method, then IPOPT.
"""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import replace
from typing import Any

import numpy as np

from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.scene import Boundary, Collocation, End, LoadGuess, Quaternion, Scene, Variational

SIMPLEST = LoadGuess(force=(0.0, 0.0, 0.0), moment=(1.0, 1.0, 1.0))


def clamps(seed: int) -> Scene:
    """Clamp a ribbon at both ends, the far one at a distance of 0.3 to 0.95, turned at random."""
    rng = np.random.default_rng(seed)
    direction, q = rng.normal(size=3), rng.normal(size=4)
    place = rng.uniform(0.3, 0.95) * direction / np.linalg.norm(direction)
    turn = Quaternion(tuple((q / np.linalg.norm(q)).tolist()))
    return Scene(
        name=f"clamps {seed}",
        law=Variational(delta=0.01),
        boundary=Boundary(
            start=End(position=(0.0, 0.0, 0.0), directors="identity"),
            end=End(position=tuple(place.tolist()), directors=turn),
        ),
        transcription=Collocation(scheme="gauss", degree=6, intervals=60),
    )


def bench_clamps(count: int) -> dict[str, Any]:
    """Solve random clamps from no guess, and from the loads that a user might try first."""
    prepared = prepare(clamps(count))
    started = time.perf_counter()
    prepared.solve()  # builds what the automatic start and IPOPT need, once
    prepared.solver.ipopt.build()
    first = prepared.seconds + time.perf_counter() - started
    rows: dict[str, list[dict[str, Any]]] = {"automatic start": [], "simplest guess": []}
    for seed in range(count):
        scene = clamps(seed)
        rows["automatic start"].append(attempt(prepared, scene, fallback=True))
        scene = replace(scene, guess=SIMPLEST)
        rows["simplest guess"].append(attempt(prepared, scene, fallback=False))
    summary = {name: summarised(found) for name, found in rows.items()}
    pairs = zip(*([row["energy"] for row in found] for found in rows.values()), strict=True)
    both = Counter(compared(a, b) for a, b in pairs if None not in (a, b))
    return {"first_s": first, "summary": summary, "energy_where_both": dict(both), "rows": rows}


def compared(energy: float, other: float) -> str:
    """Return how an energy compares with another: other equilibria of the same clamps exist."""
    if abs(energy - other) <= 1e-6 * other:
        return "same"
    return "lower" if energy < other else "higher"


def attempt(prepared: Prepared, scene: Scene, *, fallback: bool) -> dict[str, Any]:
    """Solve one scene and say what happened."""
    started, used = time.perf_counter(), time.process_time()
    solution = prepared.solve(scene, fallback=fallback)
    seconds, used = time.perf_counter() - started, time.process_time() - used
    steps = [(step["step"], step.get("iterations", 0)) for step in solution.steps]
    least = [name for name, _ in steps if name.startswith("least energy")]
    return {
        "ms": 1e3 * seconds,
        "cpu_ms": 1e3 * used,  # what a busy machine does not change
        "verified": solution.verified,
        "message": solution.message,
        "energy": solution.energy if solution.verified else None,
        "ipopt_iterations": sum(count for name, count in steps if "ipopt" in name),
        "shapes": sum("delta = 0.3," in name for name in least),
        "minimised_again": sum("delta = 0.3," not in name for name in least),
        "steps": [name for name, _ in steps],
    }


def summarised(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Return how many were verified, which way, times of all, and the messages of the failures."""
    good = [row for row in rows if row["verified"]]
    return {
        "count": len(rows),
        "verified": len(good),
        **{
            clock: [float(v) for v in np.percentile([row[clock] for row in rows], [50, 90, 100])]
            for clock in ("ms", "cpu_ms")
        },
        "ipopt_iterations": float(np.median([row["ipopt_iterations"] for row in rows])),
        "shapes": dict(sorted(Counter(row["shapes"] for row in good).items())),
        "minimised_again": dict(sorted(Counter(row["minimised_again"] for row in good).items())),
        "failures": dict(Counter(r["message"].split(":")[0] for r in rows if not r["verified"])),
        "failed_seeds": [seed for seed, row in enumerate(rows) if not row["verified"]],
    }
