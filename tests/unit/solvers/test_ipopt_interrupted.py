"""Ctrl-C in the middle of IPOPT is Ctrl-C, though CasADi takes it for a failure of the solve."""

import signal
import threading
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import casadi as ca
import numpy as np
import pytest

from ribbonopt.solvers.ipopt import IpoptSolver

SIZE = 20_000  # of a valley that takes an iteration for each or so: minutes


@dataclass(frozen=True, eq=False)
class Valley(IpoptSolver):
    """IPOPT on a long curved valley."""

    @property
    def solver(self) -> Any:
        x = ca.MX.sym("x", SIZE)
        cost = ca.sum1(100 * (x[1:] - x[:-1] ** 2) ** 2 + (1 - x[:-1]) ** 2)
        options = {"print_time": False, "error_on_fail": False}
        ipopt = {"print_level": 0, "sb": "yes", "max_iter": 10**7, "max_cpu_time": 60.0}
        return ca.nlpsol("valley", "ipopt", {"x": x, "f": cost}, options | {"ipopt": ipopt})


def test_interrupted_in_the_middle(capfd: pytest.CaptureFixture[str]) -> None:
    nlp: Any = SimpleNamespace(inequality=np.zeros(0, bool))
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        threading.Timer(0.5, signal.raise_signal, (signal.SIGINT,)).start()
        with pytest.raises(KeyboardInterrupt):
            Valley(nlp).solve(np.full(SIZE, -1.2), np.zeros(0))
    finally:
        signal.signal(signal.SIGINT, before)
    assert "KeyboardInterruptException" in capfd.readouterr().err
