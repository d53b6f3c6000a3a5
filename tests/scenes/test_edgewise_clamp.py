"""The shipped scene of a strip that gives in its own plane, against the truth in its header."""

from pathlib import Path

import numpy as np
import pytest
from membrane_truth import integrated, sheet
from scipy.optimize import root
from scipy.spatial.transform import Rotation

from ribbonopt import Continuation, load_scene, solve
from ribbonopt.studies.continuation.walk.points import POINT

PLACE, FRAME = (0.68, 0.15, 0.31), Rotation.from_rotvec([0.0, 2.4, 0.6])
TRUTH = {
    900.0: (-3.7264473612, -4.7416448106, -2.1128234374, 3.1341274717, 1.7467643947, -0.0766045911),
    9.0: (-2.5586108402, -0.6335018429, -0.6637178673, 0.9656898543, 1.8359135661, 0.7816201424),
}


@pytest.mark.parametrize("B1", TRUTH)
def test_the_truth_is_what_shooting_finds(B1: float) -> None:
    def gap(loads: np.ndarray) -> np.ndarray:
        end = integrated((sheet(1),), loads[:3], loads[3:], B1=B1, EA=120000.0)
        turn = FRAME.inv() * Rotation.from_matrix(end.frame)
        return np.concatenate([end.r - PLACE, turn.as_rotvec()])

    found = root(gap, np.array(TRUTH[B1]) + 0.01, tol=1e-12)
    np.testing.assert_allclose(found.x, TRUTH[B1], rtol=0, atol=6e-11)


def test_solved_and_continued(configs: Path) -> None:
    scene = load_scene(configs / "edgewise_clamp.yaml")
    found = solve(scene)
    assert found.verified
    np.testing.assert_allclose([*found.n0, *found.m0], TRUTH[900.0], rtol=0, atol=2e-10)
    points = [point for point in Continuation(scene) if point.kind == POINT]
    last = points[-1].solution
    np.testing.assert_allclose([*last.n0, *last.m0], TRUTH[9.0], rtol=0, atol=2e-10)
    assert points[-1].row["sideways"] == pytest.approx(TRUTH[9.0][3] / 9, abs=1e-10)
