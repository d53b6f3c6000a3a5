"""Orders of convergence, measured against those that the schemes declare."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from analytic import by_newton, implicit, rational, rational_exact
from references import HALF_MOEBIUS
from scipy.integrate import solve_ivp

from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.transcription import gauss, radau

SCHEMES = {"gauss": gauss, "radau": radau}
#: intervals whose errors are asymptotic and above rounding, by order
RIBBON_MESHES = {
    1: (256, 512),
    2: (64, 128),
    3: (32, 64, 128),
    4: (16, 32, 64),
    5: (16, 32, 64),
    6: (8, 16, 32),
    7: (16, 32),
    8: (16, 32),
}
OTHER_MESHES = {order: meshes for order, meshes in RIBBON_MESHES.items()} | {
    7: (8, 16, 32),
    8: (6, 12),
}
each_scheme = pytest.mark.parametrize("scheme", SCHEMES)
each_degree = pytest.mark.parametrize("degree", [1, 2, 3, 4])


def slope(counts: tuple[int, ...], errors: list[float]) -> float:
    """Return the order: minus the slope of log error over log number of intervals."""
    return -float(np.polyfit(np.log(counts), np.log(errors), 1)[0])


def half_moebius(configs: Path, scheme: str, degree: int, intervals: int) -> Solution:
    """Solve with the analytic law: Radau has a stage where Sadowsky's law jumps, s = 1/2."""
    mesh = f"scheme: {scheme}, degree: {degree}, intervals: {intervals}"
    transcription = f"transcription={{type: collocation, {mesh}}}"
    overrides = ["law={type: single_sheet, chi: 1}", "solver={type: newton}", transcription]
    return solve(load_scene(configs / "moebius_half.yaml", overrides))


@each_scheme
@each_degree
def test_ribbon_converges_at_the_declared_order(configs: Path, scheme: str, degree: int) -> None:
    order = SCHEMES[scheme](degree).order
    errors = []
    for intervals in RIBBON_MESHES[order]:
        found = half_moebius(configs, scheme, degree, intervals)
        gaps = np.concatenate([found.n0 - HALF_MOEBIUS["n0"], found.m0 - HALF_MOEBIUS["m0"]])
        errors.append(np.abs(gaps).max())
    assert slope(RIBBON_MESHES[order], errors) == pytest.approx(order, abs=0.3)


@each_scheme
@each_degree
def test_nodes_converge_at_the_declared_order(scheme: str, degree: int) -> None:
    order = SCHEMES[scheme](degree).order
    errors = []
    for intervals in OTHER_MESHES[order]:
        _, dense = by_newton(rational(), scheme, degree, intervals)
        s = dense.nodes(0)
        errors.append(np.abs(dense.states(0, s) - rational_exact(s)).max())
    assert slope(OTHER_MESHES[order], errors) == pytest.approx(order, abs=0.3)


def between(nodes: np.ndarray) -> np.ndarray:
    """Return points inside every element."""
    share = np.array([0.21, 0.55, 0.83])
    return (nodes[:-1, None] + np.diff(nodes)[:, None] * share).ravel()


@each_scheme
@each_degree
def test_points_between_nodes_converge_at_the_declared_order(scheme: str, degree: int) -> None:
    order = SCHEMES[scheme](degree).order
    errors = []
    for intervals in OTHER_MESHES[order]:
        _, dense = by_newton(rational(), scheme, degree, intervals)
        assert dense.order == order
        s = between(dense.nodes(0))
        errors.append(np.abs(dense.states(0, s) - rational_exact(s)).max())
    assert slope(OTHER_MESHES[order], errors) == pytest.approx(order, abs=0.3)


@pytest.fixture(scope="module")
def exact_shape() -> Callable[[np.ndarray], np.ndarray]:
    """Return r(s) of the half Moebius ribbon, integrated from its 28-digit force and moment."""
    n, m0 = np.array(HALF_MOEBIUS["n0"]), np.array(HALF_MOEBIUS["m0"])

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        r, d = y[:3], y[3:].reshape(3, 3)
        m = d @ (m0 + np.cross(n, r))
        M = np.hypot(m[1], m[2])
        u2, u3 = (m[1] + M) ** 2 / (4 * M), m[2] * (m[1] + M) / (4 * M)
        return np.concatenate([d[2], np.cross(u2 * d[1] + u3 * d[2], d).ravel()])

    start = np.concatenate([np.zeros(3), np.eye(3).ravel()])
    solution = solve_ivp(
        rates, (0, 0.5), start, method="DOP853", rtol=3e-14, atol=1e-14, dense_output=True,
        max_step=1e-3,
    )  # fmt: skip
    return lambda s: solution.sol(s)[:3].T


@each_scheme
@pytest.mark.parametrize("degree", [2, 3, 4])
def test_samples_of_a_ribbon_converge_at_the_order_of_the_scheme(
    configs: Path,
    exact_shape: Callable[[np.ndarray], np.ndarray],
    scheme: str,
    degree: int,
) -> None:
    order = SCHEMES[scheme](degree).order
    errors = []
    for intervals in RIBBON_MESHES[order]:
        found = half_moebius(configs, scheme, degree, intervals)
        assert found.dense.order == order
        s = between(found.nodes)
        errors.append(np.abs(found.sample(s, "r") - exact_shape(s)).max())
    assert slope(RIBBON_MESHES[order], errors) == pytest.approx(order, abs=0.3)


@each_scheme
@pytest.mark.parametrize("degree", [1, 2, 3])
def test_with_algebraic_variables_points_have_the_declared_order(scheme: str, degree: int) -> None:
    declared = SCHEMES[scheme](degree).order
    meshes, errors = ((8, 16, 32) if declared < 5 else (2, 4, 8)), []
    for intervals in meshes:
        _, dense = by_newton(implicit(), scheme, degree, intervals)
        s = between(dense.nodes(0))
        errors.append(np.abs(dense.states(0, s)[:, 0] - np.exp(s)).max())
    assert dense.order == declared
    assert slope(meshes, errors) == pytest.approx(declared, abs=0.3)
