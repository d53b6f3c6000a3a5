"""Honest bars: the estimated error of scenes and random clamps beside the true one.

    python scripts/bench_error_estimate.py [--out results/bench_error_estimate] [--clamps 20]
                                           [--intervals N] [--formulation NAME]

True: against the same equilibrium at tolerance 1e-12 by a scheme of higher degree, and where
there are any, n(0) and m(0) of 28 digits. All errors are relative, as
`ribbonopt.accuracy.estimate.relative_error` has them. `--intervals` starts every scene on so many
intervals instead of its own, so that more of them must be refined.
Writes `bench_error_estimate.json` and `bench_error_estimate.png`.
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

from ribbonopt.accuracy.estimate import estimate_error
from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.mechanics.rotations import matrix_of
from ribbonopt.pipeline import Prepared, prepare
from ribbonopt.scene import Boundary, Collocation, Directors, End, Scene, Variational, load_scene
from ribbonopt.solution import Solution
from ribbonopt.studies.machine import machine
from ribbonopt.summary import versions

ROOT = Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "tests"))
from references import HALF_MOEBIUS, REGULARIZED  # noqa: E402

TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
NAMES = ("n0", "m0", "u0", "energy", "states")
EXACT: dict[str, Any] = {
    **dict.fromkeys(("moebius_half", "moebius_half_full", "ribbon_si"), HALF_MOEBIUS),
    "moebius_regularized": REGULARIZED[0.01],
}
ROUNDING = 1e-13  # true errors below are not compared
TARGETS = {"below tolerance": 0.98, "within a factor 10": 0.8}
COLOURS = ("#c2410c", "#b8860b", "#2f7d32", "#1f5fa8")


def main() -> None:
    """Run all cases, print the table, write JSON and figure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("results") / "bench_error_estimate")
    parser.add_argument("--clamps", type=int, default=20, help="random clamps")
    parser.add_argument("--intervals", type=int, help="of the first mesh of every scene")
    parser.add_argument("--formulation", help="instead of that of the scenes")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    rows: list[dict[str, Any]] = []
    skipped: dict[str, str] = {}
    for prepared, name, scene in cases(options, skipped):
        measure(prepared, name, scene, rows, skipped)
    summary = summarised(rows)
    result = {
        "machine": machine(),
        "versions": versions(),
        "intervals": options.intervals,
        "formulation": options.formulation,
        "targets": TARGETS,
        **summary,
        "skipped": skipped,
        "rows": rows,
    }
    report(rows, summary, skipped)
    (options.out / "bench_error_estimate.json").write_text(json.dumps(result, indent=2) + "\n")
    draw(rows, options.out / "bench_error_estimate.png")
    print(f"written: {options.out}: bench_error_estimate.json, bench_error_estimate.png")


def cases(
    options: argparse.Namespace, skipped: dict[str, str]
) -> Iterator[tuple[Prepared, str, Scene]]:
    """Yield what is built, name and scene of each ribbon."""
    every = [(p.stem, load_scene(p)) for p in sorted((ROOT / "configs").glob("*.yaml"))]
    rng = np.random.default_rng(1)
    every += [(f"clamps {i}", clamps(rng)) for i in range(options.clamps)]
    shared: Prepared | None = None  # all clamps differ in numbers only
    for name, scene in every:
        if options.intervals:
            mesh = replace(scene.transcription, intervals=options.intervals)
            scene = replace(scene, transcription=mesh)
        scene = replace(scene, formulation=options.formulation or scene.formulation)
        try:
            prepared = shared or prepare(replace(scene, tolerance=TOLERANCES[0]))
        except ModelError as error:
            skipped[name] = str(error)
            continue
        if name.startswith("clamps"):
            shared = prepared
        yield prepared, name, scene


def clamps(rng: np.random.Generator) -> Scene:
    """Clamp a ribbon at both ends, the far one anywhere and turned at random."""
    turn = matrix_of(rng.normal(size=4)).T.tolist()
    distance, direction = rng.uniform(0.3, 0.95), rng.normal(size=3)
    place = distance * direction / np.linalg.norm(direction)
    return Scene(
        name="clamps",
        law=Variational(delta=0.01),
        boundary=Boundary(
            start=End(position=(0.0, 0.0, 0.0), directors="identity"),
            end=End(position=tuple(place.tolist()), directors=Directors(*map(tuple, turn))),
        ),
        guess="auto",
        transcription=Collocation(scheme="gauss", degree=6, intervals=40),
    )


def measure(
    prepared: Prepared,
    name: str,
    scene: Scene,
    rows: list[dict[str, Any]],
    skipped: dict[str, str],
) -> None:
    """Append estimated and true errors of one ribbon at each tolerance."""
    truth: Solution | None = None
    for tolerance in reversed(TOLERANCES):
        label = f"{name} at {tolerance:.0e}"
        try:
            found = prepared.solve(replace(scene, tolerance=tolerance))
            if not (found.verified or found.status.name == "TOLERANCE_MISSED"):
                skipped[label] = f"not solved: {found.message}"
                continue
            if truth is None or not agree(found, truth):
                truth = true_solution(found)
        except ConvergenceError as error:
            skipped[label] = str(error)
            continue
        if not truth.verified or not agree(found, truth):
            skipped[label] = f"no truth: {truth.message}"
            continue
        sizes, estimates = sizes_of(found), estimate_error(found)
        true, doubt = true_errors(found, truth, EXACT.get(name, {})), estimate_error(truth)
        rows.append(
            {
                "case": name,
                "tolerance": tolerance,
                "met": found.verified,
                "elements": list(found.dense.blocks.layout.elements),
                "estimate": {k: estimates[k] / sizes[k] for k in NAMES},
                "true": {k: true[k] / sizes[k] for k in NAMES},
                "truth_estimate": {k: doubt[k] / sizes[k] for k in NAMES},
            }
        )


def true_solution(found: Solution) -> Solution:
    """Return the same equilibrium to 1e-12, by a scheme of higher degree."""
    scheme = found.scene.transcription
    finer = replace(scheme, degree=min(scheme.degree + 2, 10), intervals=max(scheme.intervals, 10))
    scene = replace(found.scene, tolerance=1e-12, transcription=finer)
    return prepare(scene).solve(guess=found, fallback=False)


def agree(found: Solution, truth: Solution) -> bool:
    """Whether two solutions are the same equilibrium."""
    sizes, errors = sizes_of(truth), true_errors(found, truth, {})
    return all(errors[k] < 0.05 * sizes[k] for k in ("n0", "m0", "states"))


def true_errors(found: Solution, truth: Solution, exact: dict[str, Any]) -> dict[str, float]:
    """Absolute errors as in `estimate_error`; `exact` are loads in units Dw = L = 1."""
    units = found.units
    pairs = {k: (getattr(found, k), getattr(truth, k)) for k in ("n0", "m0", "u0", "energy")}
    for k in ("n0", "m0"):
        if k in exact:
            pairs[k] = pairs[k][0], np.array(exact[k]) * units.of(k[0])
    errors = {k: float(np.abs(np.subtract(*pair)).max()) for k, pair in pairs.items()}
    ours, theirs = found.outputs(found.nodes), truth.outputs(found.nodes)
    gaps = [
        np.abs(ours[k] - theirs[k]).max() / units.of(k if k == "r" else "d1")
        for k in ("r", "d1", "d2", "d3")
    ]
    return errors | {"states": float(max(gaps))}


def sizes_of(solution: Solution) -> dict[str, float]:
    """Sizes that errors are relative to, as in `relative_error`."""
    force, moment = solution.units.of("n"), solution.units.of("m")
    loads = max(np.abs(solution.n0).max() / force, np.abs(solution.m0).max() / moment)
    strains = float(np.abs(solution.at_stages["u"]).max())
    sizes = {"n0": loads * force, "m0": loads * moment, "u0": strains}
    return {k: float(v) for k, v in sizes.items()} | {
        "energy": abs(solution.energy),
        "states": 1.0,
    }
