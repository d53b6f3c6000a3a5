"""Time against error on the half Moebius ribbon: every pair, scipy and CasADi as usually written.

    python scripts/bench_accuracy.py [--out results/accuracy] [--repeat 11] [--quick]

One interleaved run, medians; errors relative to the 28-digit reference. Writes `benchmark.csv`,
`benchmark.json` (with machine and versions), `benchmark.png` (with measured orders) and, what an
answer with its error bar costs, `bars.json` (`accuracy_bars.py`).
"""

from __future__ import annotations

import argparse
import json
import os
from pathlib import Path

# Small matrices: threads of the linear algebra cost more than they bring, for all contenders.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import accuracy_bars
import numpy as np
import peer_casadi
import peer_scipy

from ribbonopt.scene import load_scene
from ribbonopt.studies.comparison.benchmark import Peer, benchmark
from ribbonopt.studies.comparison.files import save_study
from ribbonopt.studies.comparison.table import table
from ribbonopt.studies.comparison.truth import SourcedLoads
from ribbonopt.views.comparison import save_figure

SCENE = Path(__file__).resolve().parent.parent / "configs" / "moebius_half.yaml"
REFERENCE = SourcedLoads(
    n0=(0.0, 43.4964080173984993703, 42.0522517129717208281),
    m0=(0.0, 2.00545099623122820984, -8.86920396209993570631),
    source="28 digits by Taylor series",
)
FORCE, MOMENT = (0.0, 40.0, 40.0), (0.0, 2.0, -9.0)
# solve_bvp controls a residual; the last takes seconds.
SCIPY = (1e-3, 1e-5, 1e-7, 1e-9)
CASADI = (5, 10, 20, 40, 80)


def main() -> None:
    """Run, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "accuracy")
    parser.add_argument("--repeat", type=int, default=11)
    parser.add_argument("--quick", action="store_true", help="fewer pairs, meshes and peers")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    bars = accuracy_bars.bench_bars(options.repeat)
    accuracy_bars.report(bars)
    (options.out / "bars.json").write_text(json.dumps(bars, indent=2) + "\n", encoding="utf-8")
    study = benchmark(
        load_scene(SCENE),
        repeat=options.repeat,
        quick=options.quick,
        reference=REFERENCE,
        peers=peers(options.quick),
    )
    print(table(study))
    save_study(study, options.out, "benchmark")
    save_figure(study.plain(), options.out / "benchmark.png")
    print(f"written: {options.out}: bars.json, benchmark.csv, benchmark.json, benchmark.png")


def peers(quick: bool) -> list[Peer]:
    """Return scipy's solve_bvp at some tolerances and CasADi on some meshes."""
    scipy = peer_scipy.HalfMoebius(FORCE, MOMENT)
    tolerances, meshes = (SCIPY[:2], CASADI[:3]) if quick else (SCIPY, CASADI)
    result = [
        Peer("scipy solve_bvp", f"tolerance {tolerance:g}", lambda t=tolerance: _scipy(scipy, t))
        for tolerance in tolerances
    ]
    for intervals in meshes:
        casadi = peer_casadi.HalfMoebius(FORCE, MOMENT, intervals)
        name = f"CasADi, degree {peer_casadi.DEGREE}, as usually written"
        result.append(Peer(name, f"{intervals} intervals", casadi.solve))
    return result


def _scipy(problem: peer_scipy.HalfMoebius, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    answer, _ = problem.solve(tolerance)
    return answer[:3], answer[3:]


if __name__ == "__main__":
    main()
