"""Each misprint of the paper (docs/paper.md): as printed it fails, as mended it holds."""

import sys
from collections.abc import Callable
from itertools import permutations, product
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from references import HALF_MOEBIUS
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from ribbonopt.solution.solution import Solution

sys.path.append(str(Path(__file__).resolve().parents[2] / "scripts"))
from paper.found import Found
from paper.misprints import Misprint, branch, misprints
from paper.relations import on_arrays, regularized, sheet

Solved = Callable[..., Solution]


@pytest.fixture(scope="module")
def found() -> Found:
    return Found()


@pytest.fixture(scope="module")
def shown(found: Found) -> dict[str, Misprint]:
    return {row.place: row for row in misprints(found)}


def test_what_is_printed_fails_and_what_is_mended_holds(shown: dict[str, Misprint]) -> None:
    assert list(shown)[:4] == ["(5.1)", "(6.2)", "(7.2)", "(B 1)"]
    for row in shown.values():
        assert row.as_printed > 0.05, row.place
        assert row.as_mended < 1e-5, row.place


# (5.1): r(1/2) . e_i = 0 for i = x, y.


def test_the_ribbon_does_not_fulfil_its_ends_as_printed(shown: dict[str, Misprint]) -> None:
    assert shown["(5.1)"].as_printed == pytest.approx(HALF_MOEBIUS["x_end"], rel=1e-9)
    assert shown["(5.1)"].as_mended < 1e-12


def test_a_straight_ribbon_fulfils_them(solved: Solved) -> None:
    found = solved("paper/printed_half")
    s = np.linspace(0, 0.5, 51)
    np.testing.assert_allclose(found.sample(s, "r"), np.outer(s, [0, 0, 1]), atol=1e-12)
    np.testing.assert_allclose(found.sample(s, "u3"), np.pi, rtol=1e-11)
    # W_F = 2 u3^2 (section 4) on a length of 1/2, and m3 = 4 u3
    assert found.energy == pytest.approx(np.pi**2, rel=1e-11)
    assert abs(found.m0[2]) == pytest.approx(4 * np.pi, rel=1e-11)


# (6.2): three products of directors.


def products_of(frame: np.ndarray) -> np.ndarray:
    """Return d1(1).d2(0), d2(1).d3(0), d3(1).d1(0) of an end frame, rows d_i(1) along d_j(0)."""
    return np.array([frame[0, 1], frame[1, 2], frame[2, 0]])


def printed_frames() -> list[np.ndarray]:
    signed = [
        np.diag(signs) @ np.eye(3)[list(order)]
        for order in permutations(range(3))
        for signs in product((1.0, -1.0), repeat=3)
    ]
    return [f for f in signed if np.linalg.det(f) > 0 and not products_of(f).any()]


def test_eight_frames_fulfil_the_three_products() -> None:
    frames = printed_frames()
    assert len(frames) == 8
    band = np.diag([-1.0, -1.0, 1.0])
    assert sum(np.array_equal(frame, band) for frame in frames) == 1


def test_no_other_frame_does() -> None:
    frames, reached = printed_frames(), set()
    for start in Rotation.random(60, random_state=4):
        result = least_squares(
            lambda w, start=start: products_of((Rotation.from_rotvec(w) * start).as_matrix()),
            np.zeros(3),
            xtol=1e-15,
            ftol=1e-15,
            gtol=1e-15,
        )
        if result.cost < 1e-24:
            frame = (Rotation.from_rotvec(result.x) * start).as_matrix()
            gaps = [float(np.abs(frame - other).max()) for other in frames]
            assert min(gaps) < 1e-6
            reached.add(int(np.argmin(gaps)))
    assert reached == set(range(8))


def test_a_flat_ring_fulfils_the_ends_as_printed(solved: Solved) -> None:
    found = solved("paper/printed_whole")
    s = np.linspace(0, 1, 21)
    np.testing.assert_allclose(np.abs(found.sample(s, "u2")), 2 * np.pi, rtol=1e-10)
    np.testing.assert_allclose(found.sample(s, "u3"), 0, atol=1e-10)
    assert found.energy == pytest.approx(2 * np.pi**2, rel=1e-10)
    assert found.energy < HALF_MOEBIUS["H"] - 30  # E = H of the band


# (7.2): the first root.


def test_the_printed_root_gives_no_invariant(shown: dict[str, Misprint]) -> None:
    # Both agree where m3 changes sign, so that the drift is more than what the printed one is off
    # at s = 0, M^2/2 - (|m2| + M)^2/8.
    m2, m3 = HALF_MOEBIUS["m0"][1:]
    size = np.hypot(m2, m3)
    off = size**2 / 2 - (abs(m2) + size) ** 2 / 8
    assert off > 20
    assert shown["(7.2)"].as_printed > off
    assert shown["(7.2)"].as_mended < 1e-9


# (B 1): the sign of m2 chi.


@pytest.mark.parametrize("chi", [1, -1])
def test_the_printed_inverse_returns_the_moment_with_the_other_sign(chi: int) -> None:
    m2, m3 = np.random.default_rng(8).uniform(-4, 4, (2, 200))

    def back(sign: int) -> tuple[np.ndarray, np.ndarray]:
        u2, u3 = branch(m2, m3, chi, sign)
        return u2 * (1 - u3**4 / u2**4), 2 * u3 * (1 + u3**2 / u2**2)  # (2.4), (2.5)

    for sign, factor in ((1, -1), (-1, 1)):
        found = back(sign)
        np.testing.assert_allclose(found[0], factor * m2, rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(found[1], m3, rtol=1e-6, atol=1e-6)


# Section 7: H = 57.5.


def test_the_printed_invariant_is_that_of_rounded_loads(solved: Solved) -> None:
    H = float(solved("paper/moebius_sadowsky").start["H"])
    assert f"{H:.1f}" == f"{HALF_MOEBIUS['H']:.1f}" == "57.4"
    m2, m3, n3 = 2.01, -8.87, 42.1
    assert f"{(m2 + np.hypot(m2, m3)) ** 2 / 8 + n3:.1f}" == "57.5"


# Section 5: u_i(1) = -u_i(0).


def test_only_the_bending_strain_turns_over(solved: Solved) -> None:
    found = solved("paper/moebius_regularized")
    u2, u3 = (found.sample([0.0, 1.0], name) for name in ("u2", "u3"))
    assert u2[1] == pytest.approx(-u2[0], rel=1e-10)
    assert u3[1] == pytest.approx(u3[0], rel=1e-10)


# What is right only in a way.


def test_the_energy_is_locally_convex_everywhere() -> None:
    u = ca.SX.sym("u", 2)
    W = sheet(1).stored(u[0], u[1])
    hessian = ca.Function("hessian", [u], [ca.hessian(W, u)[0]])
    for u2, u3 in np.random.default_rng(2).uniform(-3, 3, (50, 2)):
        exact = 2 * (1 + (u3 / u2) ** 2) ** 3
        matrix = hessian([u2, u3]).full()
        assert np.linalg.det(matrix) == pytest.approx(exact, rel=1e-7)
        assert matrix[0, 0] > 0


def test_the_regularised_law_keeps_a_kink_in_the_twist() -> None:
    h = 1e-7
    strains = [on_arrays(regularized(0.01).strains, m2, 3.0) for m2 in (-h, 0.0, h)]
    u2, u3 = np.array(strains).T
    np.testing.assert_allclose(np.diff(u3) / h, [-0.25, 0.25], rtol=1e-5)
    slopes = np.diff(u2) / h
    assert slopes[0] == pytest.approx(slopes[1], rel=1e-4)
