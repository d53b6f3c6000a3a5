"""A law with a state of its own along the ribbon, against shooting by another program."""

from typing import Any

import numpy as np
import pytest
from clamps import EQUATIONS, GENERIC
from scipy.integrate import solve_ivp
from scipy.optimize import root
from scipy.spatial.transform import Rotation
from user_modules import Import

from ribbonopt import solve
from ribbonopt.errors import ModelError
from ribbonopt.scene import Scene

END = np.array([0.68, 0.15, 0.31])
FRAME = Rotation.from_rotvec([0, 2.4, 0.6]).as_matrix()
GAIN = 0.1


def rates(_: float, y: np.ndarray) -> np.ndarray:
    """Return r', D', n', m' and eta', D having the directors as columns."""
    D, n, m, eta = y[3:12].reshape(3, 3), y[12:15], y[15:18], y[18]
    m2, m3 = m @ D[:, 1], m @ D[:, 2]
    u = np.array([0, m2 + GAIN * eta, m3 / 2])
    cross = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
    turn = D @ cross
    return np.concatenate([D[:, 2], turn.ravel(), np.zeros(3), np.cross(n, D[:, 2]), [m2 - eta]])


def shot(loads: np.ndarray) -> np.ndarray:
    start = np.concatenate([np.zeros(3), np.eye(3).ravel(), loads, [0.0]])
    return np.asarray(solve_ivp(rates, (0, 1), start, "DOP853", rtol=1e-12, atol=1e-12).y[:, -1])


def missed(loads: np.ndarray) -> np.ndarray:
    y = shot(loads)
    return np.concatenate(
        [y[:3] - END, Rotation.from_matrix(y[3:12].reshape(3, 3) @ FRAME.T).as_rotvec()]
    )


@pytest.mark.parametrize("formulation", EQUATIONS)
def test_a_curvature_that_relaxes_along_the_ribbon(user: Import, formulation: Any) -> None:
    law = user("relaxing").Relaxing(GAIN)
    found = solve(Scene("relaxing", law, GENERIC, formulation=formulation))
    assert found.verified
    # From somewhere near, so that it finds the same of the equilibria.
    true = root(missed, np.concatenate([found.n0, found.m0]).round(1), tol=1e-12)
    assert np.abs(missed(true.x)).max() < 1e-10
    assert np.abs(true.x - np.concatenate([found.n0, found.m0]).round(1)).max() > 1e-3
    np.testing.assert_allclose(np.concatenate([found.n0, found.m0]), true.x, rtol=0, atol=1e-8)
    assert found.sample(1.0, "own.eta") == pytest.approx(shot(true.x)[18], abs=1e-8)
    assert found.sample(0.0, "own.eta") == pytest.approx(0, abs=1e-12)


def test_a_law_without_an_energy_says_so(user: Import) -> None:
    law = user("relaxing").Relaxing(GAIN)
    with pytest.raises(ModelError, match="the law relaxing has no energy"):
        solve(Scene("relaxing", law, GENERIC, formulation="energy"))


def test_what_a_width_does_to_its_state_only_the_law_can_say(user: Import) -> None:
    law = user("relaxing").Relaxing(GAIN)
    with pytest.raises(ModelError, match=r"width: the law has states of its own \(eta\)"):
        solve(Scene("relaxing", law, GENERIC, width="1 - s/2"))
