"""The shipped scenes: estimated errors beside the true ones, against a tighter tolerance.

True: against the same equilibrium at tolerance 1e-12 by a scheme of higher degree, n(0) and m(0)
against 28 digits where there are any. All errors are relative, as `relative_error` has them.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from bench_path import ROOT

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import Scene, load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

sys.path.append(str(ROOT / "tests"))
from references import HALF_MOEBIUS, REGULARIZED

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
NAMES = ("n0", "m0", "u0", "energy", "states")
EXACT: dict[str, Any] = {
    **dict.fromkeys(("moebius_half", "moebius_half_full", "ribbon_si"), HALF_MOEBIUS),
    "moebius_regularized": REGULARIZED[0.01],
}
QUANTILES = (0, 0.05, 0.5, 0.95, 1)
LEAST = 1e-3
ROUNDING = 1e-13  # true errors below are not compared
Row = dict[str, Any]


def scenes(intervals: int | None) -> Row:
    """Measure and print all shipped scenes."""
    rows: list[Row] = []
    skipped: dict[str, str] = {}
    for name, scene in cases(intervals):
        rows += measured(name, scene, skipped)
    result = {"intervals": intervals, "summary": summarised(rows), "skipped": skipped, "rows": rows}
    report(result)
    return result


def cases(intervals: int | None) -> Iterator[tuple[str, Scene]]:
    """Yield name and scene of each ribbon."""
    for path in sorted((ROOT / "configs").glob("*.yaml")):
        scene = load_scene(path)
        mesh = replace(scene.transcription, intervals=intervals or scene.transcription.intervals)
        yield path.stem, replace(scene, transcription=mesh)


def measured(name: str, scene: Scene, skipped: dict[str, str]) -> list[Row]:
    """Return estimated and true errors of one ribbon at each tolerance."""
    rows, scheme = [], scene.transcription
    for tolerance in TOLERANCES:
        label = f"{name} at {tolerance:.0e}"
        try:
            found = solve(replace(scene, tolerance=tolerance))
        except (ConvergenceError, ModelError) as error:  # the latter: no estimate
            skipped[label] = f"skipped: {error}"
            continue
        if not (found.verified or found.status is Status.TOLERANCE_MISSED):
            skipped[label] = f"not solved: {found.message}"
            continue
        finer = replace(scheme, degree=min(scheme.degree + 2, 10), intervals=40)
        truth = prepare(replace(scene, tolerance=1e-12, transcription=finer)).polish(found)
        sizes, true = sizes_of(found), true_errors(found, truth, EXACT.get(name, {}))
        if not truth.verified or max(true[k] / sizes[k] for k in NAMES) > 0.1:
            skipped[label] = f"no truth: {truth.message}"
            continue
        estimate, doubt = estimate_error(found), estimate_error(truth)
        errors = {"estimate": estimate, "true": true, "truth_estimate": doubt}
        relative = {key: {k: e[k] / sizes[k] for k in NAMES} for key, e in errors.items()}
        row = {"case": name, "tolerance": tolerance, "elements": len(found.nodes) - 1}
        rows.append(row | {"met": found.verified, **relative})
    return rows


def true_errors(found: Solution, truth: Solution, exact: dict[str, Any]) -> dict[str, float]:
    """Absolute errors as in `estimate_error`; `exact` are loads in units Dw = L = 1."""
    unit = found.units.of
    given = {k: np.array(v) * unit(k[0]) for k, v in exact.items() if k in ("n0", "m0")}
    errors = {
        k: float(np.abs(getattr(found, k) - given.get(k, getattr(truth, k))).max())
        for k in ("n0", "m0", "u0", "energy")
    }
    ours, theirs = (s.outputs(found.nodes) for s in (found, truth))
    gaps = {k: np.abs(ours[k] - theirs[k]).max() / unit(k) for k in ("r", "d1", "d2", "d3")}
    return errors | {"states": float(max(gaps.values()))}


def sizes_of(solution: Solution) -> dict[str, float]:
    """Sizes that errors are relative to, as in `relative_error`: none below 1e-3."""
    unit = {k: solution.units.of(k[0]) for k in ("n0", "m0")}
    loads = max(float(np.abs(getattr(solution, k)).max()) / unit[k] for k in unit)
    sizes = {k: loads * unit[k] for k in unit} | {"energy": abs(solution.energy), "states": 1.0}
    sizes["u0"] = float(np.abs(solution.at_stages["u"]).max())
    return {name: max(size, LEAST * unit.get(name, 1.0)) for name, size in sizes.items()}


def summarised(rows: list[Row]) -> Row:
    """Return shares of cases and of ratios that are as they should be."""
    ratios = [r["estimate"][k] / r["true"][k] for r in rows for k in NAMES if comparable(r, k)]
    near = [0.1 <= ratio <= 10 for ratio in ratios]
    below = [max(row["true"].values()) <= row["tolerance"] for row in rows]
    return {
        "below tolerance": {"share": float(np.mean(below)), "of": len(below), "target": 0.98},
        "within a factor 10": {"share": float(np.mean(near)), "of": len(near), "target": 0.8},
        "tolerance not met, and said": sum(not row["met"] for row in rows),
        "estimate over true, 0, 5, 50, 95, 100 %": np.quantile(ratios, QUANTILES).tolist(),
    }


def comparable(row: Row, name: str) -> bool:
    """Whether a true error is more than rounding and than the error of the truth."""
    return bool(row["true"][name] > max(ROUNDING, 3 * row["truth_estimate"][name]))


def report(result: Row) -> None:
    """Print the table: true errors and, behind them, estimate over true."""
    print(f"{'true error, estimate / true':<34}" + "".join(f"{name:>17}" for name in NAMES))
    for row in result["rows"]:
        true, estimate = row["true"], row["estimate"]
        ratios = [f"{estimate[k] / true[k]:.2g}" if comparable(row, k) else "" for k in NAMES]
        cells = [f"{true[k]:9.1e} {ratio:<7}" for k, ratio in zip(NAMES, ratios, strict=True)]
        words = "ABOVE" * (max(true.values()) > row["tolerance"]) + " (said)" * (not row["met"])
        print(f"{row['case']:<22}{row['tolerance']:<6.0e} {row['elements']:4}", *cells, words)
    for name, words in (*result["skipped"].items(), *result["summary"].items()):
        print(f"{name}: {words}")
