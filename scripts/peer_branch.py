"""The half Moebius ribbon as epsilon goes to zero, by scipy's `solve_bvp` in a loop."""

from __future__ import annotations

import time
from typing import Any

from peer_colnew import EPSILONS
from peer_scipy import Scipy
from peer_states import Ribbon

TOLERANCE = 1e-6  # of its residuals: the error of n(0), m(0) at the end is then 2e-9


def follow(states: int = 13, tolerance: float = TOLERANCE) -> dict[str, Any]:
    """Solve at every epsilon from the answer before: seconds, points, loads at the end."""
    wall, cpu = time.perf_counter(), time.process_time()
    problem = Scipy(Ribbon(False, states), epsilon=EPSILONS[0])
    for epsilon in EPSILONS:
        problem.epsilon = epsilon
        loads, nodes = problem.solve(tolerance, keep=True)
    return {
        "cpu_s": time.process_time() - cpu,
        "wall_s": time.perf_counter() - wall,
        "points": len(EPSILONS),
        "nodes": nodes,
        "loads": loads,
    }
