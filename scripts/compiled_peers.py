"""Peers of `bench_compiled.py`: what is found of them here, with the same start and CPU clock.

They are tuned with the answer in view: for each error the quickest mesh and tolerance found that
reach it, whatever their own estimate says; ours have none of that and give a bar as well.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from typing import Any

import peer_branch
from peer_auto import Auto
from peer_casadi import NEWTON, Collocated
from peer_colnew import EPSILONS, Colnew
from peer_scipy import Scipy
from peer_settings import AUTO, BRANCH, COLNEW, SCIPY
from peer_states import Ribbon

Found = dict[str, Any]
Ask = Callable[[str, int, int], Found]
# case: settings of peers, as in `peer_settings.py`, on 13 states
CASES: dict[str, dict[str, Any]] = {
    "half 1e-6": {
        COLNEW: (4, 3, 1e-2),
        AUTO: (5, 5, 1e-8, 1),
        NEWTON: (6, 4, 1e-7),
        SCIPY: 1e-4,
    },
    "half 1e-9": {
        COLNEW: (6, 3, 1e-2),
        AUTO: (8, 5, 1e-8, 1),
        NEWTON: (6, 6, 1e-9),
        SCIPY: 1e-6,
    },
    "half 1e-12": {COLNEW: (6, 6, 1e-4)},
    "whole 1e-9": {COLNEW: (3, 6, 1e-7), SCIPY: 1e-7},
}
ONCE = 10  # times that a compiled peer solves in a turn for each of ours
STATES = (13, 18)  # of the branch


def peers_found() -> dict[str, dict[str, Ask]]:
    """Return the peers of every case, compiled or built; say which are missing, and why."""
    peers = {COLNEW: Colnew(), AUTO: Auto()}
    for label, peer in peers.items():
        if peer.why:
            print(f"{label} is not run: {peer.why}")
    there = {label: peer for label, peer in peers.items() if not peer.why}
    result: dict[str, dict[str, Ask]] = {}
    for name, settings in CASES.items():
        ribbon = Ribbon(name.startswith("whole"))
        asks = result.setdefault(name, {})
        for label, setting in settings.items():
            if label in there:
                run = partial(there[label].run, ribbon, setting)
                asks[label] = partial(_more, run, ONCE if label == COLNEW else 1)
            elif label == NEWTON:
                asks[label] = partial(_timed, Collocated(ribbon, NEWTON, *setting).solve)
            elif label == SCIPY:
                asks[label] = partial(_timed, partial(_loads, Scipy(ribbon), setting))
    result["branch"] = _branches(there)
    return result


def _branches(there: dict[str, Any]) -> dict[str, Ask]:
    """Return the peers that follow the branch, on 13 and on 18 states."""
    asks: dict[str, Ask] = {}
    more = {COLNEW: {"epsilons": EPSILONS}, AUTO: {"first": -1.0}}
    for label, settings in BRANCH.items():
        for states in STATES:
            ribbon, setting = Ribbon(False, states), settings[states]
            name = f"{label}, {states} states"
            if label in there:
                run = partial(there[label].run, ribbon, setting)
                asks[name] = partial(_more, partial(run, **more[label]), 1)
            elif label == SCIPY:
                asks[name] = partial(_branch, states, setting)
    return asks


def _more(run: Callable[..., Found], factor: int, name: str, count: int, turn: int) -> Found:
    return run(times=factor * count)


def _timed(solve: Callable[[], list[float]], name: str, count: int, turn: int) -> Found:
    used = time.process_time()
    for _ in range(count):
        numbers = solve()
    return {"cpu_s": (time.process_time() - used) / count, "numbers": numbers}


def _loads(problem: Scipy, tolerance: float) -> list[float]:
    return problem.solve(tolerance)[0]


def _branch(states: int, tolerance: float, name: str, count: int, turn: int) -> Found:
    found = peer_branch.follow(states, tolerance)
    return {"cpu_s": found["cpu_s"], "numbers": found["loads"], "points": found["points"]}
