"""Random clamps from nothing, answers and error bars against an independent integrator.

    python scripts/bench_truth.py [--clamps 300] [--laws sadowsky regularized variational]
        [--tolerances 1e-6 1e-9] [--seed 1] [--seconds 500] [--out results/bench_truth]

Rows go to `rows.jsonl` as they are measured, and those there are not measured again: a long run can
be interrupted, or cut in pieces by `--seconds`. JSON and figure are of all rows there.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from truth_measure import LAWS, cases, measured
from truth_report import draw, report

from ribbonopt.output.summary import versions
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.studies.machine import machine


def main() -> None:
    """Measure what is missing, then report everything."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "bench_truth")
    parser.add_argument("--clamps", type=int, default=300)
    parser.add_argument("--laws", nargs="+", default=list(LAWS), choices=list(LAWS))
    parser.add_argument("--tolerances", nargs="+", type=float, default=[1e-6, 1e-9])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", type=int, help="numbers of clamps")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="stop after so many")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    path = options.out / "rows.jsonl"
    rows = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
    groups = [(law, t) for t in options.tolerances for law in options.laws]
    end = time.monotonic() + options.seconds
    with path.open("a") as file:
        for law, tolerance in groups:
            measure(law, tolerance, options, rows, file, end)
    result: dict[str, Any] = {"machine": machine(), "versions": versions()}
    result |= {"seed": options.seed, "rows": len(rows)} | report(rows, groups)
    (options.out / "bench_truth.json").write_text(json.dumps(result, indent=2) + "\n")
    draw(rows, options.out / "bench_truth.png")
    print(f"written: {options.out}")


def measure(law: str, tolerance: float, options: Any, rows: list[Any], file: Any, end: float) -> None:
    """Measure the clamps of one law and tolerance that no row holds yet."""
    known = {(r["law"], r["tolerance"], r["seed"], r["clamp"]) for r in rows}
    prepared = None
    for i, scene in cases(law, tolerance, options.seed, options.clamps):
        key = (law, tolerance, options.seed, i)
        if key in known or (options.only and i not in options.only) or time.monotonic() > end:
            continue
        prepared = prepared or prepare(scene)
        row = dict(zip(("law", "tolerance", "seed", "clamp"), key, strict=True))
        rows.append(row | measured(prepared, scene))
        file.write(json.dumps(rows[-1]) + "\n")
        file.flush()


if __name__ == "__main__":
    main()
