"""Bars that nobody can refute: estimated errors beside the true ones.

    python scripts/bench_error_estimate.py [--clamps 300] [--laws sadowsky regularized variational]
        [--tolerances 1e-6 1e-9] [--seed 1] [--only 14 19] [--seconds 500]
        [--scenes [--intervals N]] [--out results/bench_error_estimate]

Random clamps are solved from nothing, and judged by an integrator that shares no code with the
package (`tests/independent`). Rows go to `rows.jsonl` as they are measured and those there are not
measured again: a long run can be interrupted, or cut in pieces by `--seconds`. Summary and figure
are of all rows there that were asked for. `--scenes` adds the shipped scenes at four tolerances,
against themselves at 1e-12; `--intervals` starts these on so many, so that more must be refined.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, TextIO

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from error_clamps import LAWS, cases, measured
from error_report import draw, report

from ribbonopt.output.summary import versions
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.studies.machine import machine

Row = dict[str, Any]
Key = tuple[str, float, int, int]  # law, tolerance, seed, clamp


def main() -> None:
    """Measure what is missing, print what is there, write JSON and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "bench_error_estimate")
    parser.add_argument("--clamps", type=int, default=300, help="how many random clamps")
    parser.add_argument("--laws", nargs="+", default=list(LAWS), choices=list(LAWS))
    parser.add_argument("--tolerances", nargs="+", type=float, default=[1e-6, 1e-9])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", type=int, help="numbers of clamps, not all")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="end after so many")
    parser.add_argument("--scenes", action="store_true", help="the shipped scenes too")
    parser.add_argument("--intervals", type=int, help="of the first mesh of every shipped scene")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    path = options.out / "rows.jsonl"
    lines = path.read_text().splitlines() if path.exists() else []
    known = {key_of(row): row for row in map(json.loads, lines)}
    with path.open("a") as file:
        rows = list(measure(options, known, file, time.monotonic() + options.seconds))
    result: Row = {"machine": machine(), "versions": versions(), "seed": options.seed}
    if rows:
        result["clamps"] = report(rows)
        draw(rows, options.out / "bench_error_estimate.png")
    if options.scenes:
        from error_scenes import scenes

        result["scenes"] = scenes(options.intervals)
    (options.out / "bench_error_estimate.json").write_text(json.dumps(result, indent=2) + "\n")
    print(f"written: {options.out}")


def measure(options: Any, known: dict[Key, Row], file: TextIO, end: float) -> Iterator[Row]:
    """Yield the rows that are known, and measure the others while there is time."""
    for tolerance in options.tolerances:
        for law in options.laws:
            prepared = None
            for i, scene in cases(law, tolerance, options.seed, options.clamps):
                key = law, tolerance, options.seed, i
                if options.only and i not in options.only:
                    continue
                if key not in known and time.monotonic() < end:
                    prepared = prepared or prepare(scene)
                    names = dict(zip(("law", "tolerance", "seed", "clamp"), key, strict=True))
                    known[key] = names | measured(prepared, scene)
                    file.write(json.dumps(known[key]) + "\n")
                    file.flush()
                if key in known:
                    yield known[key]


def key_of(row: Row) -> Key:
    """Return what a row is of."""
    return row["law"], row["tolerance"], row["seed"], row["clamp"]


if __name__ == "__main__":
    main()
