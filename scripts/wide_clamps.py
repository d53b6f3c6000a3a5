"""Random clamps of a wide ribbon (Wunderlich's law) from nothing: how many are solved, and right.

    python scripts/wide_clamps.py [--out results/wide_clamps.json] [--count 100] [--width 0.05]

Ribbons are held at both ends as in `starts_clamps.py`, their edges straight there. From what is
solved `tests/independent` finds the equilibrium nearby by other means, to rounding: `confirmed`
where loads and energy differ by no more than their bars, `refuted` where they do or where there is
none, `undecided` where that cannot tell. Of some the energy form is solved from the answer, on its
mesh: `agrees` where energies differ by less than ENERGY of them and loads by less than LOADS. By
itself, from nothing, it may find another equilibrium (`energy form from nothing`).
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

# Small matrices: threads of the linear algebra cost more than they bring.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from starts_clamps import clamps

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.pipeline.prepared import Prepared, prepare
from ribbonopt.scene import Ipopt, Scene, Wunderlich
from ribbonopt.solution.solution import Solution

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "tests"))

from independent.confirm import examine  # noqa: E402  (lies beside the tests)
from independent.wide import ETA, M, N, P  # noqa: E402
from independent.wide_near import near  # noqa: E402

TOLERANCE = 1e-8
SOLVER = Ipopt(max_iterations=100)
ROUNDING = 1e-12  # of loads and energy
ENERGY, LOADS = 1e-7, 1e-5  # relative: the energy form has no bars
EVERY = 4  # of so many clamps one is tried by the energy form from the answer
SAME = 1e-4  # relative difference of energies, on meshes that know of no inflection


def main() -> None:
    """Solve and confirm, print the summary and write it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "wide_clamps.json")
    parser.add_argument("--count", type=int, default=100, help="random clamps")
    parser.add_argument("--seed", type=int, default=0, help="of the first of them")
    parser.add_argument("--width", type=float, default=0.05, help="of the ribbon, over its length")
    options = parser.parse_args()
    rows = judged(options.count, options.seed, options.width)
    result = {"width": options.width, "summary": summarised(rows), "rows": rows}
    options.out.parent.mkdir(parents=True, exist_ok=True)
    options.out.write_text(json.dumps(result, indent=2) + "\n")
    print(json.dumps(result["summary"], indent=2))
    print(f"written: {options.out}")


@dataclass(frozen=True)
class Ways:
    """Structures, built once: as it comes, to a tolerance, and the energy form."""

    plain: Prepared
    tight: Prepared
    energy: Prepared

    @classmethod
    def of(cls, scene: Scene) -> Ways:
        """Build them for a scene and those that differ in numbers."""
        return cls(
            prepare(scene),
            prepare(replace(scene, tolerance=TOLERANCE)),
            prepare(energy_form(scene)),
        )


def energy_form(scene: Scene) -> Scene:
    """Return the scene in the energy form."""
    return replace(scene, formulation="energy", solver=SOLVER)


def judged(count: int, seed: int = 0, width: float = 0.05) -> list[dict[str, Any]]:
    """Solve that many, from a seed on, and say of each what came of it."""
    scenes = {i: replace(clamps(i), law=Wunderlich(width=width)) for i in range(seed, seed + count)}
    ways = Ways.of(next(iter(scenes.values())))
    rows = []
    for case, scene in scenes.items():
        rows.append({"seed": case} | judge(ways, scene, case))
        print(json.dumps(rows[-1]), file=sys.stderr, flush=True)
    return rows


def judge(ways: Ways, scene: Scene, case: int) -> dict[str, Any]:
    """Solve one scene from nothing, then to a tolerance, and compare."""
    started = time.process_time()
    try:
        found = ways.plain.solve(scene)
    except ConvergenceError as error:
        message, found = str(error), None
    row: dict[str, Any] = {"cpu": time.process_time() - started, "verdict": "unsolved"}
    row |= from_nothing(ways, scene)
    if found is None:
        return row | {"message": message}
    row |= {"message": found.message, "sheets": found.sheets, "energy": found.energy}
    row["stalled"] = sum("stalled" in step["step"] for step in found.steps)
    if not found.verified:
        return row
    tight = replace(scene, tolerance=TOLERANCE)
    started = time.process_time()
    found = ways.tight.solve(tight, guess=found)
    row |= {"cpu_tight": time.process_time() - started, "elements": len(found.nodes) - 1}
    if not found.verified:
        return row | {"message": found.message}
    started = time.process_time()
    row |= confirmed(found)
    row["cpu_confirming"] = time.process_time() - started
    return row | (compared(ways, scene, found) if case % EVERY == 0 else {})


def confirmed(found: Solution) -> dict[str, Any]:
    """Return the verdict on an answer, with true errors over bars."""
    bars = estimate_error(found)
    try:
        truth, _ = near(found, doubled=False)
    except ValueError as error:
        return {"verdict": "undecided", "where": str(error)}
    except ArithmeticError as error:
        gap = examine(found)
        return {"verdict": "refuted", "where": f"{error}; {gap.where}", "gap": gap.worst}
    y = truth.y[:, 0]
    sizes = {"n0": np.abs(y[N]).max(), "m0": np.abs(y[M]).max(), "energy": truth.energy}
    errors = {
        "n0": np.abs(y[N] - found.n0).max(),
        "m0": np.abs(y[M] - found.m0).max(),
        "energy": abs(truth.energy - found.energy),
    }
    over = {
        k: float(e / (bars[k] + ROUNDING * (sizes["n0"] + sizes[k]))) for k, e in errors.items()
    }
    right = max(over.values()) <= 1
    inner = [int(np.abs(truth.s - s).argmin()) for s in truth.ends[1:-1]]
    return {
        "verdict": "confirmed" if right else "refuted",
        "errors_over_bars": over,
        "relative_errors": {k: float(e / sizes[k]) for k, e in errors.items()},
        "energy": truth.energy,
        "n0": y[N].tolist(),
        "m0": y[M].tolist(),
        "inflections": [[float(truth.s[i]), *truth.y[[ETA, P], i].tolist()] for i in inner],
        "steepest": float(np.abs(truth.y[ETA]).max()),
    }


def from_nothing(ways: Ways, scene: Scene) -> dict[str, Any]:
    """Solve the energy form from nothing."""
    started = time.process_time()
    try:
        found = ways.energy.solve(energy_form(scene))
    except (ConvergenceError, ModelError) as error:
        return {"energy_from_nothing": None, "energy_message": str(error)}
    cpu = {"cpu_energy": time.process_time() - started}
    return cpu | {"energy_from_nothing": found.energy if found.verified else None}


def compared(ways: Ways, scene: Scene, found: Solution) -> dict[str, Any]:
    """Compare an answer with the energy form from it, on its mesh."""
    try:
        other = ways.energy.polish(found, energy_form(scene))
    except (ConvergenceError, ModelError) as error:
        return {"energy_form": "unsolved", "energy_message": str(error)}
    if not other.verified:
        return {"energy_form": "unsolved", "energy_message": other.message}
    apart = {
        "energy": abs(other.energy / found.energy - 1),
        "n0": float(np.abs(other.n0 - found.n0).max() / np.abs(found.n0).max()),
        "m0": float(np.abs(other.m0 - found.m0).max() / np.abs(found.m0).max()),
    }
    same = apart["energy"] <= ENERGY and max(apart["n0"], apart["m0"]) <= LOADS
    return {"energy_form": "agrees" if same else "differs", "apart": apart}


def summarised(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Return rates and times."""
    verdicts = Counter(row["verdict"] for row in rows)
    forms = Counter(row.get("energy_form", "not tried") for row in rows)
    solved = [row for row in rows if row["verdict"] != "unsolved"]
    over = [max(row["errors_over_bars"].values()) for row in rows if "errors_over_bars" in row]
    return {
        "count": len(rows),
        "rate": len(solved) / max(len(rows), 1),
        "verdicts": dict(verdicts),
        "worst_error_over_bar": max(over, default=None),
        "energy form from the answer": dict(forms),
        "energy form from nothing": dict(Counter(other(row) for row in rows)),
        "after_stalls": sum(row.get("stalled", 0) > 0 for row in rows),
        "cpu_50_90_100": percentiles([row["cpu"] for row in rows]),
        "cpu_tight_50_90_100": percentiles(
            [row["cpu_tight"] for row in rows if "cpu_tight" in row]
        ),
        "inflections": dict(Counter(len(row["inflections"]) for row in rows if "n0" in row)),
        "seeds": {
            **{v: [r["seed"] for r in rows if r["verdict"] == v] for v in verdicts if v[0] != "c"},
            **{v: [r["seed"] for r in rows if r.get("energy_form") == v] for v in ("differs",)},
            "more energy": [r["seed"] for r in rows if other(r) == "less energy"],
        },
    }


def other(row: dict[str, Any]) -> str:
    """Return what the energy form found by itself."""
    least, energy = row.get("energy_from_nothing"), row.get("energy")
    if least is None or energy is None:
        return "unsolved"
    if abs(least / energy - 1) < SAME:
        return "the same"
    return "less energy" if least < energy else "more energy"


def percentiles(values: list[float]) -> list[float]:
    """Return the median, nine tenths and the most."""
    return [float(v) for v in np.percentile(values or [np.nan], [50, 90, 100])]


if __name__ == "__main__":
    main()
