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
import peer_rootfinder
import peer_scipy
from peer_auto import CASES as OF_AUTO
from peer_auto import Auto
from peer_colnew import CASES as OF_COLNEW
from peer_colnew import Colnew

Found = dict[str, Any]
Ask = Callable[[str, int, int], Found]
LOADS = (peer_branch.FORCE, peer_branch.MOMENT)
# case: intervals, degree, tolerance of the defects
ROOTFINDER = {"half 1e-6": (6, 4, 1e-7), "half 1e-9": (6, 6, 1e-9)}
SCIPY = {"half 1e-6": 1e-4, "half 1e-9": 1e-6}  # of its residuals
ONCE = 10  # times that a compiled peer solves in a turn for each of ours


def peers_found() -> dict[str, dict[str, Ask]]:
    """Return the peers of every case, compiled or built; say which are missing, and why."""
    result: dict[str, dict[str, Ask]] = {}
    colnew, auto = Colnew(), Auto()
    for label, peer, cases, factor in (
        ("COLNEW", colnew, OF_COLNEW, ONCE),
        ("AUTO", auto, OF_AUTO, 1),
    ):
        if peer.why:
            print(f"{label} is not run: {peer.why}")
            continue
        for name in cases:
            result.setdefault(name, {})[label] = partial(_more, peer.solve, factor)
    for name, setting in ROOTFINDER.items():
        solve = peer_rootfinder.HalfMoebius(*setting).solve
        result.setdefault(name, {})["CasADi rootfinder"] = partial(_timed, solve)
    scipy = peer_scipy.HalfMoebius(*LOADS)
    for name, tolerance in SCIPY.items():
        solve = partial(_loads, scipy, tolerance)
        result.setdefault(name, {})["scipy solve_bvp"] = partial(_timed, solve)
    result.setdefault("branch", {})["scipy solve_bvp"] = _branch
    return result


def _more(solve: Ask, factor: int, name: str, count: int, turn: int) -> Found:
    return solve(name, factor * count, turn)


def _timed(solve: Callable[[], list[float]], name: str, count: int, turn: int) -> Found:
    used = time.process_time()
    for _ in range(count):
        numbers = solve()
    return {"cpu_s": (time.process_time() - used) / count, "numbers": numbers}


def _loads(problem: peer_scipy.HalfMoebius, tolerance: float) -> list[float]:
    loads: list[float] = problem.solve(tolerance)[0].tolist()
    return loads


def _branch(name: str, count: int, turn: int) -> Found:
    found = peer_branch.follow()
    return {"cpu_s": found["cpu_s"], "numbers": found["loads"], "points": found["points"]}
