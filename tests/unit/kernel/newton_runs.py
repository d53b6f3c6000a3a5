"""Newton's method on shipped scenes, told as plain numbers: run once with the kernel, once without.

    python newton_runs.py NAME ...

prints one JSON object: of each scene and each kind of run, what came of it.
"""

import json
import sys
from pathlib import Path

import numpy as np

from ribbonopt.kernel import STATE
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import load_scene
from ribbonopt.solvers import NewtonSolver, SolveReport

CONFIGS = Path(__file__).parents[3] / "configs"
#: with guesses of their own: IPOPT, which finds one, cannot be loaded under the address sanitizer
SCENES = (
    *("moebius_half", "moebius_half_full", "moebius_regularized", "moebius_epsilon", "helix"),
    *("cantilever", "curved_ring", "twisted_ring", "helix_clamped", "ribbon_si", "snap"),
)
Told = dict[str, object]


def told(report: SolveReport) -> Told:
    """Return status, counts, unknowns and size of the residuals."""
    counts = report.iterations, report.factorizations
    largest = float(np.abs(report.residuals).max())
    return {
        "status": report.status.name,
        "counts": counts,
        "w": report.w.tolist(),
        "residual": largest,
    }


def runs_of(name: str) -> dict[str, Told]:
    """Return what comes of Newton's method from several starts of one scene."""
    prepared = prepare(load_scene(CONFIGS / f"{name}.yaml"))
    # To a tolerance beyond rounding, which would decide on the last step.
    newton, (w, p) = NewtonSolver(prepared.nlp, tolerance=1e-11), prepared.start()
    first = newton.solve(w, p)
    rng = np.random.default_rng(1)
    near = first.w + 1e-3 * rng.normal(size=len(w))
    lay = prepared.nlp.layout
    conditions = 1e-4 * rng.normal(size=lay.conditions)
    unknown = w.copy()
    unknown[0] = np.nan
    return {
        "start": told(first),
        "near": told(newton.solve(near, p)),
        "inherited": told(newton.solve(near, p, factors=first.factors)),
        "far": told(newton.solve(first.w + 30 * (near - first.w), p, factors=first.factors)),
        "relaxed": told(newton.solve(first.w, p, relaxed=conditions)),
        "enough": told(newton.solve(near, p, enough=1e-4)),
        "short": told(newton.solve(near, p, most=1)),
        "NaN": told(newton.solve(unknown, p)),
        "nothing": told(newton.solve(np.zeros(len(w)), p)),
    }


if __name__ == "__main__":
    print(json.dumps({"state": STATE, "runs": {name: runs_of(name) for name in sys.argv[1:]}}))
