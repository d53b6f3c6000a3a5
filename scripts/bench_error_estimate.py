"""Honest bars: the estimated error of scenes and random clamps beside the true one.

    python scripts/bench_error_estimate.py [--out results/bench_error_estimate] [--clamps 20]
                                           [--intervals N]

True: against the same equilibrium at tolerance 1e-12 by a scheme of higher degree, n(0) and m(0)
against 28 digits where there are any. All errors are relative, as `relative_error` has them.
`--intervals` starts every scene on so many, so that more of them must be refined. Writes
`bench_error_estimate.json` and `bench_error_estimate.png`.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from bench_path import ROOT

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.mechanics.rotations import matrix_of
from ribbonopt.pipeline import Prepared, prepare
from ribbonopt.scene import Boundary, Collocation, Directors, End, Scene, Variational, load_scene
from ribbonopt.solution import Solution
from ribbonopt.solvers import Status
from ribbonopt.studies.machine import machine
from ribbonopt.summary import versions

sys.path.append(str(ROOT / "tests"))
from references import HALF_MOEBIUS, REGULARIZED

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
COLOURS = ("#c2410c", "#b8860b", "#2f7d32", "#1f5fa8")
NAMES = ("n0", "m0", "u0", "energy", "states")
EXACT: dict[str, Any] = {
    **dict.fromkeys(("moebius_half", "moebius_half_full", "ribbon_si"), HALF_MOEBIUS),
    "moebius_regularized": REGULARIZED[0.01],
}
ROUNDING = 1e-13  # true errors below are not compared
Row = dict[str, Any]


def main() -> None:
    """Run all cases, print the table, write JSON and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "bench_error_estimate")
    parser.add_argument("--clamps", type=int, default=20, help="random clamps")
    parser.add_argument("--intervals", type=int, help="of the first mesh of every scene")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    rows: list[Row] = []
    skipped: dict[str, str] = {}
    for prepared, name, scene in cases(options, skipped):
        rows += measured(prepared, name, scene, skipped)
    result = {"machine": machine(), "versions": versions(), "intervals": options.intervals}
    result |= {"summary": summarised(rows), "skipped": skipped, "rows": rows}
    report(result)
    (options.out / "bench_error_estimate.json").write_text(json.dumps(result, indent=2) + "\n")
    draw(rows, options.out / "bench_error_estimate.png")
    print(f"written: {options.out}: bench_error_estimate.json, bench_error_estimate.png")


def cases(options: Any, skipped: dict[str, str]) -> Iterator[tuple[Prepared, str, Scene]]:
    """Yield what is built, name and scene of each ribbon."""
    every = [(p.stem, load_scene(p)) for p in sorted((ROOT / "configs").glob("*.yaml"))]
    rng = np.random.default_rng(1)
    every += [(f"clamps {i}", clamps(rng)) for i in range(options.clamps)]
    kept: Prepared | None = None  # all clamps differ in numbers only
    for name, scene in every:
        if options.intervals:
            mesh = replace(scene.transcription, intervals=options.intervals)
            scene = replace(scene, transcription=mesh)
        try:
            prepared = kept or prepare(replace(scene, tolerance=TOLERANCES[0]))
        except ModelError as error:  # no estimate
            skipped[name] = str(error)
            continue
        kept = prepared if name.startswith("clamps") else None
        yield prepared, name, scene


def clamps(rng: np.random.Generator) -> Scene:
    """Clamp a ribbon at both ends, the far one anywhere and turned at random."""
    turn = matrix_of(rng.normal(size=4)).T.tolist()
    distance, direction = rng.uniform(0.3, 0.95), rng.normal(size=3)
    place = (distance * direction / np.linalg.norm(direction)).tolist()
    return Scene(
        name="clamps",
        law=Variational(delta=0.01),
        boundary=Boundary(
            start=End(position=(0.0, 0.0, 0.0), directors="identity"),
            end=End(position=tuple(place), directors=Directors(*map(tuple, turn))),
        ),
        guess="auto",
        transcription=Collocation(scheme="gauss", degree=6, intervals=40),
    )


def measured(prepared: Prepared, name: str, scene: Scene, skipped: dict[str, str]) -> list[Row]:
    """Return estimated and true errors of one ribbon at each tolerance."""
    rows: list[Row] = []
    truth: Solution | None = None
    for tolerance in reversed(TOLERANCES):
        label = f"{name} at {tolerance:.0e}"
        try:
            found = prepared.solve(replace(scene, tolerance=tolerance))
            if found.verified and (truth is None or not agree(found, truth)):
                truth = true_solution(found)
        except ConvergenceError as error:
            skipped[label] = str(error)
            continue
        if not (found.verified or found.status is Status.TOLERANCE_MISSED):
            skipped[label] = f"not solved: {found.message}"
        elif truth is None or not truth.verified or not agree(found, truth):
            skipped[label] = f"no truth: {truth.message if truth else found.message}"
        else:
            errors = {
                "estimate": estimate_error(found),
                "true": true_errors(found, truth, EXACT.get(name, {})),
                "truth_estimate": estimate_error(truth),
            }
            sizes = sizes_of(found)
            relative = {k: {q: e[q] / sizes[q] for q in NAMES} for k, e in errors.items()}
            elements = list(found.dense.blocks.layout.elements)
            row = {"case": name, "tolerance": tolerance, "met": found.verified}
            rows.append(row | {"elements": elements, **relative})
    return rows


def true_solution(found: Solution) -> Solution:
    """Return the same equilibrium to 1e-12, by a scheme of higher degree."""
    scheme = found.scene.transcription
    finer = replace(scheme, degree=min(scheme.degree + 2, 10), intervals=max(20, scheme.intervals))
    scene = replace(found.scene, tolerance=1e-12, transcription=finer)
    return prepare(scene).solve(guess=found, fallback=False)


def agree(found: Solution, truth: Solution) -> bool:
    """Whether two solutions are the same equilibrium."""
    sizes, errors = sizes_of(truth), true_errors(found, truth, {})
    return all(errors[k] < 0.05 * sizes[k] for k in ("n0", "m0", "states"))


def true_errors(found: Solution, truth: Solution, exact: dict[str, Any]) -> dict[str, float]:
    """Absolute errors as in `estimate_error`; `exact` are loads in units Dw = L = 1."""
    unit = found.units.of
    given = {k: np.array(v) * unit(k[0]) for k, v in exact.items() if k in ("n0", "m0")}
    errors = {
        k: float(np.abs(getattr(found, k) - given.get(k, getattr(truth, k))).max())
        for k in ("n0", "m0", "u0", "energy")
    }
    ours, theirs = (s.outputs(found.nodes) for s in (found, truth))
    gaps = [np.abs(ours[k] - theirs[k]).max() / unit(k) for k in ("r", "d1", "d2", "d3")]
    return errors | {"states": float(max(gaps))}


def sizes_of(solution: Solution) -> dict[str, float]:
    """Sizes that errors are relative to, as in `relative_error`."""
    force, moment = solution.units.of("n"), solution.units.of("m")
    loads = float(max(abs(solution.n0).max() / force, abs(solution.m0).max() / moment))
    strains = float(np.abs(solution.at_stages["u"]).max())
    sizes = {"n0": loads * force, "m0": loads * moment, "u0": strains}
    return sizes | {"energy": abs(solution.energy), "states": 1.0}


def summarised(rows: list[Row]) -> Row:
    """Return shares of cases and of ratios that are as they should be."""
    ratios = [
        row["estimate"][k] / row["true"][k] for row in rows for k in NAMES if comparable(row, k)
    ]
    near = [0.1 <= ratio <= 10 for ratio in ratios]
    below = [max(row["true"].values()) <= row["tolerance"] for row in rows]
    low, middle, high = np.percentile(ratios, [5, 50, 95]).tolist() if ratios else [np.nan] * 3
    return {
        "below tolerance": {"share": float(np.mean(below)), "of": len(below), "target": 0.98},
        "within a factor 10": {"share": float(np.mean(near)), "of": len(near), "target": 0.8},
        "tolerance not met, and said": sum(not row["met"] for row in rows),
        "estimate over true, 5, 50, 95 %": [low, middle, high],
    }


def comparable(row: Row, name: str) -> bool:
    """Whether a true error is more than rounding and than the error of the truth."""
    return bool(row["true"][name] > max(ROUNDING, 3 * row["truth_estimate"][name]))


def report(result: Row) -> None:
    """Print the table: true errors and, behind them, estimate over true."""
    print(f"{'true error, estimate / true':<34}" + "".join(f"{name:>17}" for name in NAMES))
    for row in result["rows"]:
        cells = [
            f"{row['true'][k]:9.1e}"
            + (f" {row['estimate'][k] / row['true'][k]:<7.2g}" if comparable(row, k) else " " * 8)
            for k in NAMES
        ]
        over = "" if max(row["true"].values()) <= row["tolerance"] else "  ABOVE"
        print(f"{row['case']:<22}{row['tolerance']:<6.0e} {sum(row['elements']):4}", *cells, over)
    for name, reason in result["skipped"].items():
        print(f"skipped {name}: {reason}")
    for name, value in result["summary"].items():
        print(f"{name}: {value}")


def draw(rows: list[Row], path: Path) -> None:
    """Draw estimate against true error, a colour for each tolerance."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 6), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    ends = np.array([1e-17, 1e-3])
    axes.fill_between(ends, ends / 10, ends * 10, color="#dddddd", lw=0, label="factor 10")
    axes.loglog(ends, ends, color="#777777", lw=1)
    for tolerance, colour in zip(TOLERANCES, COLOURS, strict=True):
        some = [row for row in rows if row["tolerance"] == tolerance]
        pairs = [(row["true"][k], row["estimate"][k]) for row in some for k in NAMES]
        true, estimate = np.maximum(np.array(pairs).reshape(-1, 2), 2e-17).T
        axes.plot(true, estimate, "o", ms=4, mew=0, alpha=0.7, color=colour, label=f"{tolerance:g}")
    axes.axvline(ROUNDING, color="#777777", lw=0.8, ls=":")
    axes.set(xlim=ends, ylim=ends, xlabel="true relative error", ylabel="estimated relative error")
    axes.set_title("n(0), m(0), u(0), energy, states at four tolerances")
    axes.legend(frameon=False, loc="upper left")
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    main()
