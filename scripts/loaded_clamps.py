"""Random clamps under random loads, curled when free, from nothing: how many are solved, and right.

    python scripts/loaded_clamps.py [--out results/loaded_clamps.json] [--count 200] [--seed 0]

Ribbons are held at both ends as in `starts_clamps.py`; each carries a dead force per length of any
direction, up to 50 Dw / L^3, and has a natural curvature up to 5 / L either way, every other one
with Poisson's ratio, under Sadowsky's law and the variational one in turn. What is solved is
integrated again by `tests/independent`, with equations of its own: `confirmed` where nothing is off
by more than rounding grown along the ribbon, `refuted` where it is, `undecided` in between and
where that cannot tell.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections import Counter
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from starts_clamps import clamps

import ribbonopt.scene
from ribbonopt.errors import ConvergenceError
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.scene import Loads, Sadowsky, Scene, Variational

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "tests"))

from independent.confirm import examine  # noqa: E402  (lies beside the tests)

LOAD, CURVATURE, RATIO = 50.0, 5.0, 0.3
LAWS = (Sadowsky(), Variational(delta=0.01))
TOLERANCE = 1e-9
RIGHT, WRONG = 1e-7, 1e-5  # gaps over their growth
#: whether scenes have natural strains
CURLED = "natural" in {field.name for field in fields(Scene)}


def main() -> None:
    """Solve and confirm, print the summary and write it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "loaded_clamps.json")
    parser.add_argument("--count", type=int, default=200, help="random clamps")
    parser.add_argument("--seed", type=int, default=0, help="of the first of them")
    options = parser.parse_args()
    rows = judged(options.count, options.seed)
    result = {"summary": summarised(rows), "rows": rows}
    options.out.parent.mkdir(parents=True, exist_ok=True)
    options.out.write_text(json.dumps(result, indent=2) + "\n")
    print(json.dumps(result["summary"], indent=2))
    print(f"written: {options.out}")


def loaded(seed: int) -> Scene:
    """Return a random clamp with its load and natural curvature; laws and ratios in turn."""
    rng = np.random.default_rng((seed, 18))
    direction = rng.normal(size=3)
    force = rng.uniform(0, LOAD) * direction / np.linalg.norm(direction)
    curvature = float(rng.uniform(-CURVATURE, CURVATURE))
    scene = replace(
        clamps(seed),
        name=f"loaded clamps {seed}",
        law=LAWS[seed % 2],
        loads=Loads(force=tuple(force.tolist())),
        tolerance=TOLERANCE,
    )
    if not CURLED:
        return scene
    ratio = RATIO if seed // 2 % 2 else 0.0
    natural: Any = ribbonopt.scene.Natural(curvature=curvature, poisson_ratio=ratio)
    return replace(scene, natural=natural)


def judged(count: int, seed: int = 0) -> list[dict[str, Any]]:
    """Solve that many, from a seed on, and say of each what came of it."""
    prepared: dict[int, Prepared] = {}
    rows = []
    for case in range(seed, seed + count):
        scene = loaded(case)
        kind = case % 4  # law and whether there is Poisson's ratio
        if kind not in prepared:
            prepared[kind] = prepare(scene)
        rows.append({"seed": case, "law": scene.law.type} | judge(prepared[kind], scene))
    return rows


def judge(prepared: Prepared, scene: Scene) -> dict[str, Any]:
    """Solve one scene and integrate what comes out."""
    started = time.perf_counter()
    try:
        solution = prepared.solve(scene)
    except ConvergenceError as error:
        seconds = time.perf_counter() - started
        return {"seconds": seconds, "message": str(error), "verdict": "unsolved"}
    row: dict[str, Any] = {
        "seconds": time.perf_counter() - started,
        "message": solution.message,
        "verdict": "unsolved",
    }
    if not solution.verified:
        return row
    started = time.perf_counter()
    try:
        found = examine(solution)
    except (ValueError, ArithmeticError) as error:
        return row | {"verdict": "undecided", "where": str(error)}
    verdict = "confirmed" if found.worst <= RIGHT else "undecided"
    return row | {
        "verdict": "refuted" if not found.worst <= WRONG else verdict,
        "gap": found.worst,
        "where": found.where,
        "restarts": found.restarts,
        "phases": len(solution.sheets),
        "seconds_of_confirming": time.perf_counter() - started,
    }


def summarised(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Return rates and times, all together and by law."""
    laws = sorted({row["law"] for row in rows})
    parts = {"all": rows} | {law: [row for row in rows if row["law"] == law] for law in laws}
    return {
        "natural curvature": CURLED,
        **{name: _summary(part) for name, part in parts.items()},
        "failures": dict(
            Counter(row["message"].split(":")[0] for row in rows if row["verdict"] == "unsolved")
        ),
        "seeds": {
            verdict: [row["seed"] for row in rows if row["verdict"] == verdict]
            for verdict in ("unsolved", "refuted", "undecided")
        },
    }


def _summary(rows: list[dict[str, Any]]) -> dict[str, Any]:
    counts = Counter(row["verdict"] for row in rows)
    seconds = [row["seconds"] for row in rows]
    return {
        "count": len(rows),
        "solved": len(rows) - counts["unsolved"],
        "rate": (len(rows) - counts["unsolved"]) / max(len(rows), 1),
        **{verdict: counts[verdict] for verdict in ("confirmed", "refuted", "undecided")},
        "worst_gap_confirmed": max(
            (row["gap"] for row in rows if row["verdict"] == "confirmed"), default=None
        ),
        "seconds_50_90_100": [float(v) for v in np.percentile(seconds, [50, 90, 100])],
        "seconds_in_all": sum(seconds),
    }


if __name__ == "__main__":
    main()
