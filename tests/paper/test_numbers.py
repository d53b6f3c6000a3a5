"""Each number of the references, with the equation or figure it belongs to."""

from collections.abc import Callable

import numpy as np
import pytest
from mpmath import mp
from references import (
    CANTILEVER_DEFLECTION,
    ELASTICA,
    HALF_MOEBIUS,
    REGULARIZED,
    VARIATIONAL,
    agrees,
)

from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]
FINE = "transcription={type: collocation, scheme: gauss, degree: 8, intervals: 10}"
each_solver = pytest.mark.parametrize("solver", ["ipopt", "newton", "auto"])
each_form = pytest.mark.parametrize("name", ["moebius_half", "moebius_half_full"])


def gap(found: np.ndarray, exact: tuple[float, ...]) -> float:
    """Return the largest error relative to each number (to the largest, where it is zero)."""
    reference = np.array(exact)
    scale = np.where(reference == 0, np.abs(reference).max(), np.abs(reference))
    return float((np.abs(found - reference) / scale).max())


@each_form
@each_solver
def test_half_moebius_to_twelve_digits(solved: Solved, name: str, solver: str) -> None:
    # (4.5), (5.1) with y, z in place of x, y
    found = solved(name, FINE, f"solver={{type: {solver}}}")
    assert gap(found.n0, HALF_MOEBIUS["n0"]) < 1e-12
    assert gap(found.m0, HALF_MOEBIUS["m0"]) < 1e-12
    assert found.u0[1] == pytest.approx(HALF_MOEBIUS["u0"][1], rel=1e-12)


@each_form
def test_half_moebius_as_shipped_to_eight_digits(solved: Solved, name: str) -> None:
    found = solved(name)
    assert gap(found.n0, HALF_MOEBIUS["n0"]) < 1e-8
    assert gap(found.m0, HALF_MOEBIUS["m0"]) < 1e-8
    assert found.u0[1] == pytest.approx(HALF_MOEBIUS["u0"][1], rel=1e-8)


@each_form
@each_solver
def test_half_moebius_hamiltonian_and_energy(solved: Solved, name: str, solver: str) -> None:
    # section 7: H = 57.5, and E = H L for a closed loop, here half of it
    found = solved(name, FINE, f"solver={{type: {solver}}}")
    assert float(found.start["H"]) == pytest.approx(HALF_MOEBIUS["H"], rel=1e-11)
    assert found.energy == pytest.approx(HALF_MOEBIUS["H"] / 2, rel=1e-11)


def test_half_moebius_further_numbers(solved: Solved) -> None:
    found = solved("moebius_half", FINE)
    assert agrees(float(found.start["n_dot_m"]), "-285.740082717")
    assert agrees(found.u0[2], "-2.706318441")
    assert found.u0[0] == 0
    assert found.sample(0.5, "r")[0] == pytest.approx(HALF_MOEBIUS["x_end"], rel=1e-12)
    assert agrees(abs(found.sample(0.5, "u3")), "4.934876749")


def test_half_moebius_twist(solved: Solved) -> None:
    # turns of the whole loop; digits by Runge-Kutta integration from the 28-digit n(0), m(0)
    assert agrees(abs(2 * solved("moebius_half", FINE).twist), "0.323311779125")


def test_half_moebius_ends_with_the_strain_jump_of_figure_4(solved: Solved) -> None:
    # m2 = 0 at s = 1/2, where |u2| tends to |u3|
    found = solved("moebius_half", FINE)
    assert found.sample(0.5, "m2") == pytest.approx(0, abs=1e-10)
    assert abs(found.sample(0.5 - 1e-9, "eta")) == pytest.approx(1, abs=1e-6)
    assert (np.abs(found.sample(np.linspace(0, 0.499, 200), "eta")) <= 1).all()


def test_whole_moebius_as_shipped(solved: Solved) -> None:
    # (6.1), (6.2), epsilon = 0.01
    found = solved("moebius_regularized")
    exact = REGULARIZED[0.01]
    assert gap(found.n0, exact["n0"]) < 1e-6
    assert gap(found.m0, exact["m0"]) < 1e-6
    assert found.u0[1] == pytest.approx(exact["u2"][0], rel=1e-6)


def test_whole_moebius_closes(solved: Solved) -> None:
    found = solved("moebius_regularized")
    np.testing.assert_allclose(found.sample(1.0, "r"), 0, atol=1e-6)
    frames = [[found.sample(s, d) for d in ("d1", "d2", "d3")] for s in (0.0, 1.0)]
    np.testing.assert_allclose(frames[1], np.diag([-1, -1, 1]) @ frames[0], atol=1e-10)


@pytest.mark.parametrize("epsilon", [1e-2, 1e-3])
def test_half_moebius_regularized(solved: Solved, epsilon: float) -> None:
    # the same law on half the loop, (5.1)
    law = f"law={{type: regularized, epsilon: {epsilon}}}"
    mesh = "transcription={type: collocation, scheme: gauss, degree: 8, intervals: 200}"
    found = solved("moebius_half", law, mesh, "solver={type: newton}")
    exact = REGULARIZED[epsilon]
    assert gap(found.n0, exact["n0"]) < 1e-6
    assert gap(found.m0, exact["m0"]) < 1e-6
    assert found.u0[1] == pytest.approx(exact["u2"][0], rel=1e-6)


def test_whole_moebius_with_less_smoothing(solved: Solved) -> None:
    mesh = "transcription={type: collocation, scheme: gauss, degree: 8, intervals: 200}"
    found = solved("moebius_regularized", "law.epsilon=1e-3", mesh, "solver={type: newton}")
    exact = REGULARIZED[1e-3]
    assert gap(found.n0, exact["n0"]) < 1e-6
    assert gap(found.m0, exact["m0"]) < 1e-6


def test_regularized_hamiltonian_drifts_as_measured(solved: Solved) -> None:
    # (6.1) is not a gradient
    H = solved("moebius_regularized").sample([0.0, 0.5, 1.0], "H")
    assert [f"{h:.2f}" for h in H] == ["58.16", "55.43", "58.16"]


@pytest.mark.parametrize("delta", VARIATIONAL)
def test_variational_law(solved: Solved, delta: float) -> None:
    u2, H = VARIATIONAL[delta]
    found = solved("moebius_variational", f"law.delta={delta}")
    assert agrees(found.u0[1], u2)
    assert agrees(float(found.start["H"]), H)


@pytest.mark.parametrize("shortening", ELASTICA)
def test_clamped_elastica(solved: Solved, shortening: float) -> None:
    exact = ELASTICA[shortening]
    found = solved("elastica_clamped", f"parameters.shortening={shortening}")
    s = np.linspace(0, 1, 401)
    assert agrees(-found.n0[2], exact.force)
    assert agrees(abs(found.sample(0.5, "r")[0]), exact.deflection)
    assert agrees(np.abs(found.sample(s, "u2")).max(), exact.curvature)
    assert agrees(found.energy, exact.energy)
    np.testing.assert_allclose(found.sample(s, "r")[:, 1], 0, atol=1e-14)


@pytest.mark.parametrize("shortening", ELASTICA)
def test_clamped_elastica_by_elliptic_integrals(solved: Solved, shortening: float) -> None:
    # Euler: chord 2 E / K - 1, force 16 K^2, deflection k / K, curvature 8 k K
    found = solved("elastica_clamped", f"parameters.shortening={shortening}", FINE)
    with mp.workdps(30):
        parameter = mp.findroot(
            lambda m: 2 * mp.ellipe(m) / mp.ellipk(m) - 2 + mp.mpf(shortening), (0.3, 0.7)
        )
        K, k = float(mp.ellipk(parameter)), float(mp.sqrt(parameter))
    assert -found.n0[2] == pytest.approx(16 * K**2, rel=1e-10)
    assert abs(found.sample(0.5, "r")[0]) == pytest.approx(k / K, rel=1e-10)
    assert abs(found.u0[1]) == pytest.approx(8 * k * K, rel=1e-10)


def test_cantilever(solved: Solved) -> None:
    found = solved("cantilever")
    assert agrees(abs(found.sample(1.0, "r")[0]), CANTILEVER_DEFLECTION)
    np.testing.assert_allclose(found.n0, [1, 0, 0], atol=1e-12)
    np.testing.assert_allclose(found.sample(1.0, "m"), 0, atol=1e-12)


@pytest.mark.parametrize(("curvature", "torsion"), [(4, 2), (3, -2.5), (-4, 1)])
def test_helix_is_exact_everywhere(solved: Solved, curvature: float, torsion: float) -> None:
    u2, u3 = float(curvature), float(torsion)
    eta = u3 / u2
    m = np.array([0, u2 * (1 - eta**4), 2 * u3 * (1 + eta**2)])
    n = np.array([0, u2 * u3 * (1 + eta**2) ** 2, u3**2 * (1 + eta**2) ** 2])
    found = solved(
        "helix",
        f"parameters={{curvature: {curvature}, torsion: {torsion}}}",
        f"guess={{force: {(0.9 * n).tolist()}, moment: {(0.9 * m).tolist()}}}",
    )
    s = np.linspace(0, 1, 101)
    components = [found.sample(s, name) for name in ("m1", "m2", "m3", "n1", "n2", "n3")]
    exact = np.concatenate([m, n])[:, None]
    np.testing.assert_allclose(np.array(components), np.tile(exact, 101), atol=1e-9)
    np.testing.assert_allclose(found.sample(s, "u2"), u2, atol=1e-9)
    np.testing.assert_allclose(found.sample(s, "u3"), u3, atol=1e-9)
    H = u2**2 * (1 + eta**2) ** 2 * (1 + 2 * eta**2) / 2
    np.testing.assert_allclose(found.sample(s, "H"), H, rtol=1e-11)


def test_homotopy_starts_at_the_rod(solved: Solved) -> None:
    # (C 1) at rho = 0
    rod = solved("moebius_kirchhoff", "law={type: kirchhoff, B2: 1, B3: 2}")
    found = solved("moebius_kirchhoff")
    np.testing.assert_allclose(found.n0, rod.n0, rtol=1e-12, atol=1e-11)
    np.testing.assert_allclose(found.m0, rod.m0, rtol=1e-12, atol=1e-11)


def test_homotopy_ends_at_the_ribbon(solved: Solved) -> None:
    # (C 1) at rho = 1
    found = solved(
        "moebius_kirchhoff", "law.rho=1", "guess={force: [0, 40, 40], moment: [0, 2, -9]}"
    )
    assert gap(found.n0, HALF_MOEBIUS["n0"]) < 1e-8
    assert gap(found.m0, HALF_MOEBIUS["m0"]) < 1e-8
