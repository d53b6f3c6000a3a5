"""Figure 5d, appendix C and the planar elastica, as branches of `ribbonopt continue`.

Truth: 28-digit numbers where there are any; half intervals, each solved by itself; elliptic
integrals.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from references import ELASTICA, HALF_MOEBIUS, REGULARIZED, VARIATIONAL, agrees
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from ribbonopt.scene import load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.recorded import value_of
from ribbonopt.studies.continuation.walk.points import POINT, Point

Array = np.ndarray
Solved = Callable[..., Solution]
LIMIT = HALF_MOEBIUS["u0"][1]
SMOOTHED = "law={{type: regularized, epsilon: {!r}}}"


def followed(path: Path, *overrides: str) -> list[Point]:
    """Return all points of a scene's continuation, which reaches its goal."""
    continuation = Continuation(load_scene(path, overrides))
    points = list(continuation)
    assert continuation.ending.reached, continuation.ending.reason
    assert all(point.solution.verified for point in points)
    return points


def column(points: list[Point], name: str) -> Array:
    return np.array([point.row[name] for point in points])


def gap(found: Solution, n0: object, m0: object) -> float:
    """Return the error of the loads, relative to the largest."""
    error = max(np.abs(found.n0 - n0).max(), np.abs(found.m0 - m0).max())
    return float(error / np.abs(n0).max())


def slope(x: Array, y: Array) -> float:
    return float(np.polyfit(np.log(x), np.log(np.abs(y - LIMIT)), 1)[0])


# Figure 5d: epsilon to zero on the whole Moebius ribbon, and delta beside it.


@pytest.fixture(scope="module")
def to_sadowsky(configs: Path) -> list[Point]:
    return followed(configs / "moebius_epsilon.yaml")


def test_figure_5d_has_points_over_seven_decades(to_sadowsky: list[Point]) -> None:
    epsilon = column(to_sadowsky, "law.epsilon")
    assert len(epsilon) >= 20
    assert (epsilon[0], epsilon[-1]) == (0.1, 1e-8)
    assert (np.diff(epsilon) < 0).all()
    assert set(column(to_sadowsky, "kind")) == {POINT}
    assert (column(to_sadowsky, "error") < 1e-8).all()
    for point in to_sadowsky:
        assert point.solution.sheets == (1, -1)
        np.testing.assert_allclose(point.row["switches"], [0.5], rtol=0, atol=1e-10)
        assert point.row["negative"] is None  # (6.1) has no energy


@pytest.mark.parametrize("epsilon", REGULARIZED)
def test_figure_5d_goes_through_the_28_digit_numbers(
    to_sadowsky: list[Point], epsilon: float
) -> None:
    (point,) = (point for point in to_sadowsky if value_of(point.row) == epsilon)
    exact = REGULARIZED[epsilon]
    assert gap(point.solution, exact["n0"], exact["m0"]) < 1e-8
    assert point.row["u2"] == pytest.approx(exact["u2"][0], rel=1e-8)


@pytest.mark.parametrize("every", [3, pytest.param(1, marks=pytest.mark.slow)])
def test_figure_5d_is_that_of_half_intervals(
    to_sadowsky: list[Point], solved: Solved, every: int
) -> None:
    assert len(to_sadowsky[::every]) >= 6
    for point in to_sadowsky[::every]:
        epsilon = value_of(point.row)
        truth = solved("moebius_half", SMOOTHED.format(epsilon), "tolerance=1e-11")
        assert gap(point.solution, truth.n0, truth.m0) < 1e-8, epsilon
        assert point.row["u2"] == pytest.approx(truth.u0[1], rel=1e-8), epsilon


def test_figure_5d_tends_to_sadowsky_as_epsilon(to_sadowsky: list[Point]) -> None:
    epsilon, u2 = column(to_sadowsky, "law.epsilon"), column(to_sadowsky, "u2")
    assert slope(epsilon[-10:], u2[-10:]) == pytest.approx(1, abs=2e-3)  # measured: 1.00002
    assert u2[-1] == pytest.approx(LIMIT - 5.3078 * epsilon[-1], abs=1e-9)
    # On the line through the last two points to epsilon = 0; measured: 3e-11.
    rate = (u2[-2] - u2[-1]) / (epsilon[-2] - epsilon[-1])
    assert u2[-1] - rate * epsilon[-1] == pytest.approx(LIMIT, abs=1e-9)


def test_delta_tends_to_sadowsky_faster(configs: Path) -> None:
    stage = "{parameter: law.delta, scale: log, values: [0.1, 0.03, 0.01, 3e-3, 2e-3, 1e-3]}"
    law = "law={type: variational, delta: 0.1}"
    points = followed(configs / "moebius_whole.yaml", law, f"continuation={stage}")
    delta, u2 = column(points, "law.delta"), column(points, "u2")
    for value, (printed, H) in VARIATIONAL.items():
        (row,) = (point.row for point in points if value_of(point.row) == value)
        assert agrees(row["u2"], printed) and agrees(row["H0"], H)
        assert row["energy"] == pytest.approx(row["H0"], rel=1e-9)  # E = H L of a loop
    small = delta < 4e-3
    assert slope(delta[small], u2[small]) == pytest.approx(1.7, abs=0.05)
    assert LIMIT - u2[-1] == pytest.approx(6.9e-5, abs=1e-6)
    assert set(column(points, "negative")) == {0}


# Appendix C: from rod to ribbon.


@pytest.mark.parametrize(
    "whole", [(), ("interval=[0, 1]", "boundary={loop: {half_twists: 1}}")], ids=["half", "whole"]
)
def test_appendix_c_from_rod_to_ribbon(
    configs: Path, solved: Solved, whole: tuple[str, ...]
) -> None:
    points = followed(configs / "rod_to_ribbon.yaml", *whole)
    rho, epsilon = ([point for point in points if point.stage == stage] for stage in (0, 1))
    rod = solved("moebius_half", "law={type: homotopy, rho: 0, epsilon: 0.1}", "tolerance=1e-11")
    ribbon = solved("moebius_half", SMOOTHED.format(0.1), "tolerance=1e-11")
    last = solved("moebius_half", SMOOTHED.format(1e-8), "tolerance=1e-11")
    ends = ((rho[0], 0, rod), (rho[-1], 1, ribbon), (epsilon[0], 0.1, ribbon))
    for point, value, truth in (*ends, (epsilon[-1], 1e-8, last)):
        assert value_of(point.row) == value
        assert gap(point.solution, truth.n0, truth.m0) < 1e-8
        assert point.row["u2"] == pytest.approx(truth.u0[1], rel=1e-8)
    assert len(rho) >= 10
    # What is left at epsilon = 1e-8 is known to first order.
    assert epsilon[-1].row["u2"] == pytest.approx(LIMIT - 5.3078e-8, abs=1e-8)
    assert gap(epsilon[-1].solution, HALF_MOEBIUS["n0"], HALF_MOEBIUS["m0"]) < 3e-8


# The planar elastica.


def test_elastica_goes_through_its_shortenings(configs: Path) -> None:
    points = followed(configs / "elastica_shortening.yaml")
    rows = {value_of(point.row): point.row for point in points if point.kind == POINT}
    assert {0.25, 0.5, 1.0} <= rows.keys()
    for shortening, row in rows.items():
        m = brentq(lambda m, d=shortening: 2 - 2 * ellipe(m) / ellipk(m) - d, 0, 0.9, xtol=1e-15)
        K, E = ellipk(m), ellipe(m)
        force = 16 * K**2
        assert row["axial"] == pytest.approx(force, rel=1e-9)
        assert row["deflection"] == pytest.approx(np.sqrt(m) / K, rel=1e-9)
        assert row["curvature"] == pytest.approx(2 * np.sqrt(m * force), rel=1e-9)
        assert row["energy"] == pytest.approx(2 * force * (E / K - 1 + m), rel=1e-9)
    for shortening, printed in ELASTICA.items():
        row = rows[shortening]
        assert agrees(row["axial"], printed.force)
        assert agrees(row["deflection"], printed.deflection)
        assert agrees(row["curvature"], printed.curvature)
        assert agrees(row["energy"], printed.energy)


def test_largest_curvature_of_the_elastica_is_where_it_is_recorded(solved: Solved) -> None:
    curvature = np.abs(solved("elastica_shortening").sample(np.linspace(0, 1, 1001), "u2"))
    assert curvature.argmax() in (0, 500, 1000)
    assert curvature[500] == pytest.approx(curvature[0], rel=1e-9)
