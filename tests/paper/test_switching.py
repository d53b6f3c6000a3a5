"""The whole Moebius ribbon in two phases, for the law itself and its regularisations (6.1), (C 1).

Truth: 28-digit numbers where there are any, else the half interval, on which m2 keeps its sign; its
loads are integrated again by DOP853 with the equations written out here.
"""

from collections.abc import Callable
from pathlib import Path

import casadi as ca
import mpmath as mp
import numpy as np
import pytest
from references import HALF_MOEBIUS, REGULARIZED
from scipy.integrate import solve_ivp

from ribbonopt.mechanics.laws.blended import RegularizedLaw
from ribbonopt.mechanics.laws.law import RibbonLaw
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution

Array = np.ndarray
SADOWSKY = "law={type: sadowsky}"
SMOOTHED = "law={{type: regularized, epsilon: {}}}"
HOMOTOPY = "law={{type: homotopy, rho: 0.5, epsilon: {}}}"


def whole(configs: Path, *overrides: str) -> Solution:
    return verified(configs / "moebius_regularized.yaml", *overrides)


def half(configs: Path, *overrides: str) -> Solution:
    return verified(configs / "moebius_half.yaml", *overrides)


def verified(path: Path, *overrides: str) -> Solution:
    found = solve(load_scene(path, overrides))
    assert found.verified, found.message
    return found


def gap(found: Solution, n0: object, m0: object) -> float:
    """Return the error of the loads, relative to the largest."""
    error = max(np.abs(found.n0 - n0).max(), np.abs(found.m0 - m0).max())
    return float(error / np.abs(n0).max())


def rates(rho: float, epsilon: float) -> Callable[[float, Array], Array]:
    """Return y' of y = r, d1, d2, d3, n, m by (4.5) and (C 1) as printed; (6.1) at rho = 1."""

    def rates_at(_: float, y: Array) -> Array:
        d, n, m = y[3:12].reshape(3, 3), y[12:15], y[15:18]
        _, m2, m3 = d @ m
        M, mu = np.hypot(m2, m3), abs(m2)
        lam = (M - mu) / (M + mu)
        u2 = m2 / (2 * mu / (M + mu) + epsilon if rho == 1 else 1 - rho * (lam - epsilon))
        u2, u3 = u2 / (1 + rho * lam), m3 / (2 * (1 + rho * lam))
        turn = np.cross(u2 * d[1] + u3 * d[2], d)
        return np.concatenate([d[2], turn.ravel(), np.zeros(3), np.cross(n, d[2])])

    return rates_at


def misses_of_the_half(n0: Array, m0: Array, rho: float, epsilon: float) -> float:
    """Return by how much these loads miss (5.1): y = z = 0, d1x = d3x = 0 at s = 1/2."""
    y = np.concatenate([np.zeros(3), np.eye(3).ravel(), n0, m0])
    law = rates(rho, epsilon)
    end = solve_ivp(law, (0, 0.5), y, method="DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
    return float(np.abs(end[[1, 2, 3, 9]]).max())


def test_hand_written_equations_have_the_known_solutions() -> None:
    # so that the tests below may lean on them; and they notice an error of 1e-8
    for epsilon, exact in {0.0: HALF_MOEBIUS, **REGULARIZED}.items():
        loads = np.array(exact["n0"]), np.array(exact["m0"])
        assert misses_of_the_half(*loads, 1, epsilon) < 1e-11
        assert misses_of_the_half(loads[0] * (1 + 1e-8), loads[1], 1, epsilon) > 1e-9


def test_sadowsky_by_two_phases(configs: Path) -> None:
    found = whole(configs, SADOWSKY, "tolerance=1e-12")
    assert found.sheets == (1, -1)
    np.testing.assert_allclose(found.switch_points, [0.5], rtol=0, atol=1e-11)
    assert gap(found, HALF_MOEBIUS["n0"], HALF_MOEBIUS["m0"]) < 1e-11
    assert found.energy == pytest.approx(HALF_MOEBIUS["H"], rel=1e-11)  # E = H L of a loop
    H = found.sample(np.linspace(0, 1, 101), "H")
    np.testing.assert_allclose(H, HALF_MOEBIUS["H"], rtol=1e-11)


def test_strains_of_sadowsky_jump_and_the_rest_does_not(configs: Path) -> None:
    # figure 4; at the switch u3 = m3 / 4, and u2 flips between +-|m3| / 4
    found = whole(configs, SADOWSKY, "guess=auto")
    ends = 0.5 + np.array([-1e-12, 1e-12])
    m3, u2, u3 = (found.sample(ends, name) for name in ("m3", "u2", "u3"))
    np.testing.assert_allclose(u2, [abs(m3[0]) / 4, -abs(m3[0]) / 4], rtol=1e-9)
    np.testing.assert_allclose(u3, m3 / 4, rtol=1e-9)
    assert abs(m3[0]) == pytest.approx(4 * 4.934876749, rel=1e-9)
    for name in ("r", "d1", "d2", "d3", "n", "m"):
        before, after = found.sample(ends, name)
        np.testing.assert_allclose(before, after, rtol=0, atol=1e-9)


@pytest.mark.parametrize("epsilon", REGULARIZED)
def test_regularized_to_ten_digits(configs: Path, epsilon: float) -> None:
    found = whole(configs, SMOOTHED.format(epsilon), "tolerance=1e-11")
    exact = REGULARIZED[epsilon]
    assert found.sheets == (1, -1)
    np.testing.assert_allclose(found.switch_points, [0.5], rtol=0, atol=1e-8)
    assert gap(found, exact["n0"], exact["m0"]) < 1e-10
    assert found.u0[1] == pytest.approx(exact["u2"][0], rel=1e-10)


@pytest.mark.parametrize("epsilon", [1e-4, 1e-6, 1e-8])
def test_nearly_sadowsky(configs: Path, epsilon: float) -> None:
    law = SMOOTHED.format(epsilon)
    truth = solve(load_scene(configs / "moebius_half.yaml", [law, "tolerance=1e-11"]))
    assert misses_of_the_half(truth.n0, truth.m0, 1, epsilon) < 1e-10
    found = whole(configs, law, "tolerance=1e-9")
    assert found.sheets == (1, -1)
    assert gap(found, truth.n0, truth.m0) < 1e-9


@pytest.mark.parametrize("epsilon", [1e-4, 1e-6, 1e-8])
def test_layer_at_the_end_of_the_half_meets_a_tolerance(configs: Path, epsilon: float) -> None:
    # (6.1) changes within chi m2 = -epsilon |m3| / 2 of m2 = 0, here the end of the interval
    assert half(configs, SMOOTHED.format(epsilon), "tolerance=1e-11").verified


@pytest.mark.parametrize("epsilon", [0, 0.01])
def test_homotopy_between_rod_and_ribbon(configs: Path, epsilon: float) -> None:
    law = HOMOTOPY.format(epsilon)
    truth = half(configs, law, "tolerance=1e-11")
    assert misses_of_the_half(truth.n0, truth.m0, 0.5, epsilon) < 1e-10
    found = whole(configs, law, "tolerance=1e-9")
    assert found.sheets == (1, -1)
    np.testing.assert_allclose(found.switch_points, [0.5], rtol=0, atol=1e-9)
    assert gap(found, truth.n0, truth.m0) < 1e-9


def test_an_epsilon_of_rounding_is_sadowsky(configs: Path) -> None:
    # the loads depend on epsilon about linearly: 43.496 - 43.449 = 0.048 at epsilon = 1e-3
    law = SMOOTHED.format(1e-12)
    for found in (half(configs, law, "tolerance=1e-11"), whole(configs, law, "tolerance=1e-9")):
        assert gap(found, HALF_MOEBIUS["n0"], HALF_MOEBIUS["m0"]) < 1e-9
        assert misses_of_the_half(found.n0, found.m0, 1, 1e-12) < 1e-9


@pytest.mark.parametrize("epsilon", [1e-2, 1e-6, 1e-12, 0])
def test_law_is_evaluated_to_rounding_for_any_epsilon(epsilon: float) -> None:
    # (6.1) with 40 digits: u2 = m2 (M + mu)^2 / (2 M (2 mu + epsilon (M + mu)))
    law = RegularizedLaw(ca.SX(epsilon))
    a, b = ca.SX.sym("a"), ca.SX.sym("b")
    sheet = law.sheet(1)
    assert isinstance(sheet, RibbonLaw)
    strain = ca.Function("u", [a, b], [*law.strains(a, b), *sheet.strains(a, b)])
    for m2 in (3.0, 0.2, 1e-3, 1e-7, 1e-13, 1e-20):
        for m3 in (-7.0, 0.5, 1e-9):
            u2, u3, sheet2, sheet3 = (float(u) for u in strain(m2, m3))
            with mp.workdps(40):
                x, y, e = mp.mpf(m2), mp.mpf(m3), mp.mpf(epsilon)
                M = mp.sqrt(x * x + y * y)
                exact2 = float(x * (M + x) ** 2 / (2 * M * (2 * x + e * (M + x))))
                exact3 = float(y * (M + x) / (4 * M))
            assert u2 == pytest.approx(exact2, rel=1e-13)
            assert u3 == pytest.approx(exact3, rel=1e-13)
            assert (sheet2, sheet3) == pytest.approx((u2, u3), rel=1e-13)
