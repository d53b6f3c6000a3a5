"""The shipped ring: its circle, where that buckles, and where the branch that leaves it ends."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation

SCENE = Path(__file__).parents[2] / "configs" / "twisted_ring.yaml"
CRITICAL = 2 * np.pi * np.sqrt(3)


def test_it_is_a_circle(solved: Callable[..., Solution]) -> None:
    found = solved("twisted_ring")
    np.testing.assert_allclose(found.n0, [0, -10 * np.pi, 0], atol=1e-8)
    np.testing.assert_allclose(found.m0, [0, 2 * np.pi, -5], atol=1e-9)
    assert found.energy == pytest.approx((4 * np.pi**2 + 25) / 4, rel=1e-10)


@pytest.mark.slow
def test_its_branches() -> None:
    points = list(Continuation(load_scene(SCENE)))
    circle = [point for point in points if point.row["branch"] == 0]
    (first,) = [point for point in circle if point.kind == "branch point"]
    assert first.position == pytest.approx(CRITICAL, abs=1e-10)
    assert {p.row["negative"] for p in circle if p.position < CRITICAL - 1e-3} == {0}
    assert {p.row["negative"] for p in circle if p.position > CRITICAL + 1e-3} == {1}
    side = [point for point in points if point.row["branch"] == 1]
    assert {p.row["negative"] for p in side if p.kind == "point"} == {1}
    places = sorted(p.position for p in side if p.kind == "branch point")
    expected = [4 * np.pi - CRITICAL, 4 * np.pi - CRITICAL, CRITICAL]
    np.testing.assert_allclose(places, expected, atol=1e-9)
