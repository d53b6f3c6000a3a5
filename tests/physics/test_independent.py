"""The independent integrator by which answers are judged, against digits and exact solutions."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from independent import Law, Truth, polish, shot
from references import ELASTICA, HALF_MOEBIUS, REGULARIZED, VARIATIONAL, agrees

FRAME = np.eye(3)
Array = np.ndarray


def half_moebius(r: Array, d: Array, n: Array, m0: Array) -> Array:
    """(5.1) with r . ey = r . ez = 0 at the far end; n1 = m1 = 0 at the start."""
    return np.array([r[1], r[2], d[0, 0], d[2, 0], n[0], m0[0]])


def found(law: Law, off: float = 1e-4) -> Truth:
    """Half Moebius ribbon of a law, from loads that are off by about so much."""
    n, m0 = (np.array(HALF_MOEBIUS[k]) * (1 + off) for k in ("n0", "m0"))
    start = shot(law, n, m0, np.zeros(3), FRAME, 0.5)
    # m2 vanishes at the far end; beyond it it would change its sign.
    truth = polish(law, n, m0, start, half_moebius, length=0.5, kinds=(1,))
    assert truth.verdict == "found", truth.reason
    return truth


def test_half_moebius_of_sadowsky() -> None:
    path = found(Law("sadowsky")).path
    np.testing.assert_allclose(path.n, HALF_MOEBIUS["n0"], rtol=0, atol=5e-12)
    np.testing.assert_allclose(path.m0, HALF_MOEBIUS["m0"], rtol=0, atol=1e-12)
    at = path.at(np.array([0.0, 0.25, 0.5]))
    np.testing.assert_allclose(at["u"][0], HALF_MOEBIUS["u0"], rtol=0, atol=5e-10)  # as printed
    np.testing.assert_allclose(at["H"], HALF_MOEBIUS["H"], rtol=1e-13)
    assert at["r"][2, 0] == pytest.approx(HALF_MOEBIUS["x_end"], abs=1e-13)
    assert path.energy == pytest.approx(HALF_MOEBIUS["H"] / 2, rel=1e-13)  # E = H L


@pytest.mark.parametrize("epsilon", REGULARIZED)
def test_half_moebius_of_the_regularized_law(epsilon: float) -> None:
    truth, exact = found(Law("regularized", epsilon), 1e-3), REGULARIZED[epsilon]
    np.testing.assert_allclose(truth.path.n, exact["n0"], rtol=0, atol=5e-12)
    np.testing.assert_allclose(truth.path.m0, exact["m0"], rtol=0, atol=1e-12)
    assert truth.path.at(np.zeros(1))["u2"][0] == pytest.approx(exact["u2"][0], abs=1e-12)


@pytest.mark.parametrize("delta", VARIATIONAL)
def test_half_moebius_of_the_variational_law(delta: float) -> None:
    start = found(Law("variational", delta), 1e-3).path.at(np.zeros(1))
    for name, printed in zip(("u2", "H"), VARIATIONAL[delta], strict=True):
        assert agrees(start[name][0], printed)


def clamped(law: Law, n: Array, m0: Array, off: float, **phases: object) -> Truth:
    """Integrate given loads, and find them again between clamps from loads that are off."""
    s = np.array([0.0, 1.0])
    exact = shot(law, n, m0, np.zeros(3), FRAME)
    near = shot(law, n + off, m0 + off, np.zeros(3), FRAME)
    places, frames = exact(s)
    return polish(law, n + off, m0 + off, near, (places[1], frames[1]), **phases)


def test_the_error_of_the_truth_is_bounded_by_its_coarse_mesh() -> None:
    """A rod and a helix of the sheet, whose loads are known."""
    u2, u3 = 3.0, 2.0
    eta = u3 / u2
    helix = (
        np.array([0.0, u2 * u3 * (1 + eta**2) ** 2, u3**2 * (1 + eta**2) ** 2]),
        np.array([0.0, u2 * (1 - eta**4), 2 * u3 * (1 + eta**2)]),
    )
    rod = np.array([3.0, -2.0, 5.0]), np.array([1.0, 4.0, -3.0])
    for law, (n, m0) in ((Law("sadowsky"), helix), (Law("kirchhoff"), rod)):
        truth = clamped(law, n, m0, 1e-3)
        assert truth.verdict == "found", truth.reason
        doubt = np.abs(truth.path.n - truth.coarse.n).max()
        assert np.abs(truth.path.n - n).max() < max(1e-11, 10 * doubt)
        assert doubt < 1e-9


def test_a_jump_of_the_curvature_is_a_phase_of_its_own() -> None:
    """H, which no equation asks for, is the same on both sides."""
    n, m0 = np.array([30.0, -10.0, 8.0]), np.array([0.3, 6.0, 9.0])
    truth = clamped(Law("sadowsky"), n, m0, 1e-5)
    assert truth.verdict == "found", truth.reason
    assert len(truth.path.kinds) > 1
    H = truth.path.at(np.linspace(0, 1, 57))["H"]
    np.testing.assert_allclose(H, H[0], rtol=0, atol=1e-11)


def test_sharp_layers_are_seen() -> None:
    """H is kept by the variational law through layers of 1e-5 of the length."""
    n, m0 = np.array([30.0, -10.0, 8.0]), np.array([0.3, 6.0, 9.0])
    truth = clamped(Law("variational", 1e-4), n, m0, 0.0)
    assert truth.verdict == "found", truth.reason
    H = truth.path.at(np.linspace(0, 1, 57))["H"]
    np.testing.assert_allclose(H, H[0], rtol=0, atol=1e-10)


@pytest.mark.parametrize("shortening", ELASTICA)
def test_elastica(shortening: float) -> None:
    """Planar: clamped along x; the arch lies in the plane of d1 and d3."""
    printed = ELASTICA[shortening]
    frame = np.array([[0.0, 0, 1], [0, -1, 0], [1, 0, 0]])  # d1 = z, d2 = -y, d3 = x
    law = Law("kirchhoff", stiffness=(1.0, 1.0))
    n, m0 = np.array([-float(printed.force), 0, 0]), np.array([0, -float(printed.curvature), 0])
    start = shot(law, n, m0, np.zeros(3), frame)
    truth = polish(law, n, m0, start, (np.array([1 - shortening, 0, 0]), frame))
    assert truth.verdict == "found", truth.reason
    assert agrees(-truth.path.n[0], printed.force)
    assert agrees(abs(truth.path.at(np.array([0.5]))["r"][0, 2]), printed.deflection)
    assert agrees(truth.path.energy, printed.energy)


def test_it_shares_nothing_with_the_package() -> None:
    tests = Path(__file__).resolve().parents[1]
    code = (
        "import sys, independent; print([m for m in sys.modules if m in ('ribbonopt', 'casadi')])"
    )
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=tests, capture_output=True, text=True, check=True
    )
    assert run.stdout.strip() == "[]"
