"""Shipped scenes with supports, loops and no guess: each against the truth that it names."""

from collections.abc import Callable

import numpy as np
import pytest
from references import REGULARIZED, VARIATIONAL, agrees
from scipy.integrate import solve_ivp
from scipy.special import ellipe, ellipk

from ribbonopt.checks.topology import count_half_twists
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]
Array = np.ndarray
NAMES = ("band_three", "elastica_pinned", "end_moment", "moebius_whole", "twisted_stretched")


@pytest.mark.parametrize("name", NAMES)
def test_they_need_no_guess(solved: Solved, name: str) -> None:
    assert solved(name).scene.guess == "auto"
    assert solved(name).verification.worst_condition < 1e-8


# A moment on the free end.


@pytest.mark.parametrize("moment", [4, -7])
def test_end_moment_bends_the_ribbon_on_a_sphere(solved: Solved, moment: float) -> None:
    found = solved("end_moment", f"parameters.moment={moment}")
    s = np.linspace(0, 1, 200)
    np.testing.assert_allclose(found.sample(s, "n"), 0, atol=1e-11)
    m = found.sample(s, "m")
    np.testing.assert_allclose(m, np.tile([0, 0.8 * moment, 0.6 * moment], (200, 1)), atol=1e-11)
    # At the clamp m2 = 0.8 |m|: H = (0.8 + 1)^2 |m|^2 / 8 by the law of the paper.
    H = 1.8**2 * moment**2 / 8
    np.testing.assert_allclose(found.sample(s, "H"), H, rtol=1e-10)
    radius = abs(moment) / (2 * H)
    # The sphere touches the ribbon's faces: its centre is on the normal of the clamp.
    r = found.sample(s, "r")
    centre = np.linalg.lstsq(
        np.column_stack([2 * r, np.ones(200)]), np.sum(r**2, axis=1), rcond=None
    )[0][:3]
    np.testing.assert_allclose(np.linalg.norm(r - centre, axis=1), radius, rtol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(centre), radius, rtol=1e-9)


# A planar elastica between hinges.


@pytest.mark.parametrize("angle", [60, 100])
def test_elastica_pinned_is_that_of_the_tables(solved: Solved, angle: float) -> None:
    found = solved("elastica_pinned", f"parameters.angle={angle}")
    m = np.sin(np.radians(angle) / 2) ** 2
    force, distance = 4 * ellipk(m) ** 2, 2 * ellipe(m) / ellipk(m) - 1
    np.testing.assert_allclose(found.n0, [0, 0, -force], rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(found.sample(1.0, "r"), [0, 0, distance], atol=1e-8)
    np.testing.assert_allclose(found.sample([0.0, 1.0], "m"), 0, atol=1e-9)
    # Energy: the integral of (2 k sqrt(P) cn)^2 / 2 over half a period of 4 K.
    energy = 2 * force * (ellipe(m) / ellipk(m) - 1 + m)
    assert found.energy == pytest.approx(energy, rel=1e-7)


def test_elastica_pinned_has_the_printed_digits(solved: Solved) -> None:
    found = solved("elastica_pinned")
    assert agrees(-float(found.n0[2]) / np.pi**2, "1.1517196")
    assert agrees(float(found.sample(1.0, "r")[2]), "0.74101961")


# A ribbon twisted and nearly taut.


def strains(m2: float, m3: float, delta: float) -> tuple[float, float]:
    """Inverse of the variational law, as SCIENCE prints it."""
    q, M = np.hypot(m2, delta * m3), np.hypot(m2, m3)
    return m2 * (q + M) ** 2 / (4 * q * M), m3 * (q + M) * (q + delta**2 * M) / (4 * q * M)


@pytest.mark.parametrize("overrides", [(), ("parameters.turn=-120", "parameters.slack=0.15")])
def test_twisted_stretched_is_integrated_to_its_far_end(
    solved: Solved, overrides: tuple[str, ...]
) -> None:
    fine = "transcription={type: collocation, scheme: gauss, degree: 8, intervals: 70}"
    found = solved("twisted_stretched", fine, *overrides)
    delta = found.scene.law.delta

    def rates(_: float, y: Array) -> Array:
        d, n, m = y[3:12].reshape(3, 3), y[12:15], y[15:]
        u2, u3 = strains(d[1] @ m, d[2] @ m, delta)
        turn = np.cross(u2 * d[1] + u3 * d[2], d).ravel()
        return np.concatenate([d[2], turn, np.zeros(3), np.cross(n, d[2])])

    y = np.concatenate([np.zeros(3), np.eye(3).ravel(), found.n0, found.m0])
    end = solve_ivp(rates, (0, 1), y, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    numbers = found.scene.parameters
    turn = np.radians(numbers["turn"])
    c, s = np.cos(turn), np.sin(turn)
    np.testing.assert_allclose(end[:3], [0, 0, 1 - numbers["slack"]], atol=1e-7)
    np.testing.assert_allclose(end[3:12], [c, s, 0, -s, c, 0, 0, 0, 1], atol=1e-7)


def test_twisted_stretched_the_other_way_is_the_mirror_image(solved: Solved) -> None:
    left, right = (solved("twisted_stretched", f"parameters.turn={t}") for t in (90, -90))
    assert right.energy == pytest.approx(left.energy, rel=1e-9)
    twist = [found.sample(0.0, "dot(n, m)") for found in (left, right)]
    assert twist[0] == pytest.approx(-twist[1], rel=1e-7)
    assert abs(twist[0]) > 1


# Closed bands.


def test_band_three_is_that_of_two_other_programs(solved: Solved) -> None:
    found = solved("band_three")
    n, m = (np.abs(found.sample(0.0, f"[{v}1, {v}2, {v}3]")) for v in "nm")
    np.testing.assert_allclose(n, [0, 157.21, 101.74], atol=5e-3)
    np.testing.assert_allclose(m, [0, 11.55, 29.64], atol=5e-3)
    assert count_half_twists(found) == 3


def test_band_three_lies_where_its_scene_says(solved: Solved) -> None:
    # Carried to itself by thirds of a turn about y and flips about x: axes at 0 and 60 degrees.
    found = solved("band_three")
    start, end = (found.sample(s, "r") for s in found.scene.interval)
    np.testing.assert_allclose(start[1:], 0, atol=1e-12)
    np.testing.assert_allclose(np.cross(end, [-0.5, 0, np.sqrt(0.75)]), 0, atol=1e-12)
    d1, d2 = found.sample(found.scene.interval[0], "d1"), found.sample(1 / 6, "d2")
    np.testing.assert_allclose(np.abs(d1), [1, 0, 0], atol=1e-12)
    np.testing.assert_allclose(np.abs(d2), [0.5, 0, np.sqrt(0.75)], atol=1e-12)
    # No force and no moment along the axes of the flips.
    for name in "nm":
        assert abs(found.sample(0.0, f"{name}1")) < 1e-9
        assert abs(found.sample(1 / 6, f"{name}2")) < 1e-9


def test_band_of_five_is_the_same_scene_with_other_numbers(solved: Solved) -> None:
    five = ("boundary.loop.half_twists=5", "interval=[0, 0.1]")
    assert count_half_twists(solved("band_three", *five)) == 5


@pytest.mark.parametrize("delta", VARIATIONAL)
def test_moebius_whole_has_the_numbers_of_its_half(solved: Solved, delta: float) -> None:
    found = solved("moebius_whole", f"law.delta={delta}")
    # To the accuracy of its mesh where m2 changes sign; the loop has length 1.
    u2, H = map(float, VARIATIONAL[delta])
    assert found.u0[1] == pytest.approx(u2, rel=4e-8)
    assert found.start["H"] == pytest.approx(H, rel=4e-8)
    assert found.energy == pytest.approx(H, rel=4e-8)
    assert count_half_twists(found) == 1


def test_moebius_whole_under_the_law_of_the_paper(solved: Solved) -> None:
    found = solved("moebius_whole", "law={type: regularized, epsilon: 0.01}")
    expected = REGULARIZED[0.01]
    np.testing.assert_allclose(found.n0, expected["n0"], rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(found.m0, expected["m0"], rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(found.u0[1], expected["u2"][0], rtol=1e-6)
