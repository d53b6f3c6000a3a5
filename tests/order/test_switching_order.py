"""Order of convergence across a sign change of m2: kept in phases, lost without.

Odd numbers of intervals, so that no node is at s = 1/2, where m2 of the whole Moebius ribbon
changes sign. Gauss of degree 3: order 6.
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from references import HALF_MOEBIUS, REGULARIZED

from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution

SADOWSKY = "law={type: sadowsky}"
SMOOTHED = "law={type: regularized, epsilon: 0.01}"
#: in phases, fine enough for the pole of (6.1) at chi m2 = -epsilon |m3| / 2
FINE = (601, 1201)


def whole(configs: Path, intervals: int, *overrides: str) -> Solution:
    mesh = f"transcription={{type: collocation, scheme: gauss, degree: 3, intervals: {intervals}}}"
    return solve(load_scene(configs / "moebius_regularized.yaml", [mesh, *overrides]))


def order(found: list[Solution], truth: Mapping[str, tuple[float, ...]]) -> float:
    """Return the slope of log error over log number of intervals."""
    counts = [solution.dense.blocks.layout.element_count for solution in found]
    gaps = [np.concatenate([s.n0 - truth["n0"], s.m0 - truth["m0"]]) for s in found]
    assert all(solution.verified for solution in found)
    return -float(np.polyfit(np.log(counts), np.log(np.abs(gaps).max(axis=1)), 1)[0])


def test_sadowsky_keeps_the_order_in_phases(configs: Path) -> None:
    found = [whole(configs, n, SADOWSKY, "guess=auto") for n in (11, 21, 41)]
    assert all(solution.sheets == (1, -1) for solution in found)
    assert order(found, HALF_MOEBIUS) >= 5.5


def test_sadowsky_without_phases_is_no_solution(configs: Path) -> None:
    # an element across the jump of u2: there is no order to measure, and none is claimed
    found = whole(configs, 11, SADOWSKY, "switching=off")
    assert not found.verified
    assert np.abs(found.n0 - HALF_MOEBIUS["n0"]).max() > 1e-2


@pytest.mark.slow
def test_regularized_keeps_the_order_in_phases(configs: Path) -> None:
    found = [whole(configs, n, SMOOTHED) for n in FINE]
    assert all(solution.sheets == (1, -1) for solution in found)
    assert order(found, REGULARIZED[0.01]) >= 5.5


@pytest.mark.parametrize(
    "meshes", [(21, 41, 81), pytest.param(FINE, marks=pytest.mark.slow)], ids=["coarse", "fine"]
)
def test_regularized_without_phases_loses_the_order(configs: Path, meshes: tuple[int, ...]) -> None:
    found = [whole(configs, n, SMOOTHED, "switching=off") for n in meshes]
    assert not any(solution.sheets for solution in found)
    assert order(found, REGULARIZED[0.01]) <= 3.5
