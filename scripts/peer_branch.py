"""The half Moebius ribbon as epsilon goes to zero, by scipy's `solve_bvp` in a loop."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from peer_scipy import HalfMoebius

EPSILONS = np.logspace(-1, -4, 21)
FORCE, MOMENT = (0.0, 40.0, 40.0), (0.0, 2.0, -9.0)
TOLERANCE = 1e-6  # of its residuals: the error of n(0), m(0) at the end is then 2e-9


def follow() -> dict[str, Any]:
    """Solve at every epsilon from the answer before: seconds, points, loads at the end."""
    wall, cpu = time.perf_counter(), time.process_time()
    problem = HalfMoebius(FORCE, MOMENT, epsilon=EPSILONS[0])
    for epsilon in EPSILONS:
        problem.epsilon = epsilon
        _, nodes = problem.solve(TOLERANCE, keep=True)
    return {
        "cpu_s": time.process_time() - cpu,
        "wall_s": time.perf_counter() - wall,
        "points": len(EPSILONS),
        "nodes": nodes,
        "loads": problem.c.tolist(),
    }
