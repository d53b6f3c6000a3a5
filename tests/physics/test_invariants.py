"""What mechanics promises of every solution, whoever computed it."""

from collections.abc import Callable

import numpy as np
import pytest
from references import HALF_MOEBIUS
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from ribbonopt.accuracy.estimate import SAFETY, estimate_error
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import Boundary, Directors, End, LoadGuess, Sadowsky, Scene
from ribbonopt.solution.solution import Solution

Solved = Callable[..., Solution]
Array = np.ndarray
FINE = "transcription={type: collocation, scheme: gauss, degree: 8, intervals: 10}"
SCENES = {
    "cantilever": (),
    "elastica_clamped": ("transcription={type: collocation, degree: 8, intervals: 12}",),
    "helix": (),
    "moebius_half": ("transcription={type: collocation, degree: 8, intervals: 10}",),
    "moebius_half_full": ("transcription={type: collocation, degree: 8, intervals: 10}",),
    "moebius_kirchhoff": ("transcription={type: collocation, degree: 8, intervals: 10}",),
    # Their laws change fast where m2 passes zero.
    "moebius_regularized": (
        "transcription={type: collocation, degree: 8, intervals: 200}",
        "solver={type: newton}",
    ),
    "moebius_variational": (
        "transcription={type: collocation, degree: 8, intervals: 80}",
        "solver={type: newton}",
    ),
}
each_scene = pytest.mark.parametrize("name", SCENES)


@each_scene
def test_force_and_twisting_moment_are_constant(solved: Solved, name: str) -> None:
    found = solved(name)
    s = np.linspace(*found.scene.interval, 97)
    n, n_dot_m = found.sample(s, "n"), found.sample(s, "dot(n, m)")
    m = np.linalg.norm(found.sample(s, "m"), axis=1).max()
    assert np.abs(n - n[0]).max() <= 1e-12 * np.abs(n).max()
    assert np.abs(n_dot_m - n_dot_m[0]).max() <= 1e-12 * np.linalg.norm(n[0]) * m


@each_scene
def test_gauss_keeps_the_directors_orthonormal(solved: Solved, name: str) -> None:
    found = solved(name)
    frames = np.stack([found.sample(found.nodes, d) for d in ("d1", "d2", "d3")], axis=1)
    assert np.abs(frames @ frames.swapaxes(1, 2) - np.eye(3)).max() < 1e-12


def test_gauss_keeps_quaternions_normal(solved: Solved) -> None:
    found = solved("moebius_half")
    nodes, _, _ = found.dense.blocks.layout.unpack(found.dense.w)
    q = nodes[:, [found.problem.state_names.index(f"q{i}") for i in range(4)]]
    assert np.abs(np.linalg.norm(q, axis=1) - 1).max() < 1e-12


@pytest.mark.parametrize("name", sorted(set(SCENES) - {"moebius_regularized"}))
def test_hamiltonian_is_constant_where_the_law_has_an_energy(solved: Solved, name: str) -> None:
    found = solved(name, *SCENES[name])
    s = np.linspace(*found.scene.interval, 97)
    H = found.sample(s, "H")
    assert np.abs(H - H[0]).max() <= 1e-11 * np.abs(H).max()


def paper_strains(scene: Scene, m2: float, m3: float) -> tuple[float, float]:
    """Strains by the formulas as the paper prints them; both moments of a law may be zero."""
    numbers, kind = scene.law, scene.law.type
    if m3 == 0:  # (4.2) is 0 / 0; lambda* = 0
        return m2, 0.0
    a2 = (m2 / m3) ** 2
    # (4.2), its difference written as a quotient
    lam = 1 / (1 + 2 * a2 + 2 * np.sqrt(a2**2 + a2))
    if kind == "variational":
        q, M, delta = np.hypot(m2, numbers.delta * m3), np.hypot(m2, m3), numbers.delta
        return m2 * (q + M) ** 2 / (4 * q * M), m3 * (q + M) * (q + delta**2 * M) / (4 * q * M)
    rho = getattr(numbers, "rho", 1.0)
    epsilon = getattr(numbers, "epsilon", 0.0)
    bending = (1 - rho * (lam - epsilon)) * (1 + rho * lam)  # (4.3), (6.1), (C 1)
    return m2 / bending, m3 / (2 * (1 + rho * lam))


def rates(scene: Scene) -> Callable[[float, Array], Array]:
    """Return the 18 derivatives of eq. (4.5): r, d1, d2, d3, n, m."""

    def of(_: float, y: Array) -> Array:
        d, n, m = y[3:12].reshape(3, 3), y[12:15], y[15:18]
        u2, u3 = paper_strains(scene, d[1] @ m, d[2] @ m)
        darboux = u2 * d[1] + u3 * d[2]
        return np.concatenate([d[2], np.cross(darboux, d).ravel(), np.zeros(3), np.cross(n, d[2])])

    return of


@each_scene
def test_integration_from_the_start_meets_the_end(solved: Solved, name: str) -> None:
    found = solved(name, *SCENES[name])
    names = ("r", "d1", "d2", "d3", "n", "m")
    a, b = found.scene.interval
    y, expected = (np.concatenate([found.sample(s, k) for k in names]) for s in (a, b))
    middle = (a + b) / 2
    # Stop where the regularised law has its kink.
    for left, right in ((a, middle), (middle, b)):
        y = solve_ivp(
            rates(found.scene), (left, right), y, method="DOP853", rtol=1e-13, atol=1e-13
        ).y[:, -1]
    np.testing.assert_allclose(y, expected, rtol=0, atol=1e-9 * max(1, np.abs(expected).max()))


U2, U3 = 3.0, -1.5
ETA = U3 / U2
HELIX_M = np.array([0, U2 * (1 - ETA**4), 2 * U3 * (1 + ETA**2)])
HELIX_N = np.array([0, U2 * U3 * (1 + ETA**2) ** 2, (U3 * (1 + ETA**2)) ** 2])


def helix_end() -> tuple[Array, Array]:
    """Position and frame (columns) at s = 1 of the helix that starts in the lab frame."""
    u = np.array([0, U2, U3])
    length = np.linalg.norm(u)
    axis = u / length
    frame = Rotation.from_rotvec(u).as_matrix()
    e3 = np.array([0.0, 0.0, 1.0])
    across = e3 - axis * (axis @ e3)
    position = (
        axis * (axis @ e3)
        + (across * np.sin(length) + np.cross(axis, across) * (1 - np.cos(length))) / length
    )
    return position, frame


def clamped(start: tuple[Array, Array], end: tuple[Array, Array], n: Array, m: Array) -> Scene:
    """Return a scene clamped at both ends by position and frame; n and m are nearly right."""

    def clamp(position: Array, frame: Array) -> End:
        d1, d2, d3 = (tuple(column) for column in frame.T.tolist())
        return End(position=tuple(position.tolist()), directors=Directors(d1=d1, d2=d2, d3=d3))

    guess = LoadGuess(tuple((0.95 * n).tolist()), tuple((0.95 * m).tolist()))
    return Scene("clamped", Sadowsky(), Boundary(clamp(*start), clamp(*end)), guess)


def test_clamps_of_a_helix_give_the_helix() -> None:
    found = solve(clamped((np.zeros(3), np.eye(3)), helix_end(), HELIX_N, HELIX_M))
    np.testing.assert_allclose(found.n0, HELIX_N, atol=1e-9)
    np.testing.assert_allclose(found.m0, HELIX_M, atol=1e-9)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_rigid_motions_turn_force_and_moment_along(seed: int) -> None:
    Q = Rotation.from_quat(np.random.default_rng(seed).standard_normal(4)).as_matrix()
    shift = np.array([5.0, -2.0, 1.0]) * seed
    position, frame = helix_end()
    start, end = (shift, Q), (shift + Q @ position, Q @ frame)
    found = solve(clamped(start, end, Q @ HELIX_N, Q @ HELIX_M))
    assert found.verified, found.message
    np.testing.assert_allclose(found.n0, Q @ HELIX_N, atol=1e-9)
    np.testing.assert_allclose(found.m0, Q @ HELIX_M, atol=1e-9)
    assert found.energy == pytest.approx(U2**2 * (1 + ETA**2) ** 2 / 2, rel=1e-11)


def test_a_ribbon_read_backwards_is_the_same_ribbon() -> None:
    position, frame = helix_end()
    turn = np.diag([1.0, -1.0, -1.0])  # d2 and d3 reversed
    end_moment = frame @ HELIX_M
    found = solve(clamped((position, frame @ turn), (np.zeros(3), turn), -HELIX_N, -end_moment))
    assert found.verified, found.message
    np.testing.assert_allclose(found.n0, -HELIX_N, atol=1e-9)
    np.testing.assert_allclose(found.m0, -end_moment, atol=1e-9)
    np.testing.assert_allclose(found.u0, [0, U2, U3], atol=1e-9)


def test_without_force_the_centre_line_lies_on_a_sphere() -> None:
    # section 7: n = 0, radius |m| / (2 H)
    m = np.array([0.7, 1.0, 0.6])
    scene = Scene(
        "free of force",
        Sadowsky(),
        Boundary(
            End(position=(0.0, 0.0, 0.0), directors="identity"),
            End(force=(0.0, 0.0, 0.0), moment=tuple(m.tolist())),
        ),
        LoadGuess((0.0, 0.0, 0.0), (0.6, 1.0, 0.5)),
    )
    found = solve(scene)
    assert found.verified, found.message
    r = found.sample(np.linspace(0, 1, 60), "r")
    # Least-squares sphere: 2 c . r + (R^2 - c^2) = r^2.
    matrix = np.column_stack([2 * r, np.ones(len(r))])
    fit, _, rank, _ = np.linalg.lstsq(matrix, (r**2).sum(axis=1), rcond=None)
    radius = np.sqrt(fit[3] + fit[:3] @ fit[:3])
    assert rank == 4
    assert np.abs(matrix @ fit - (r**2).sum(axis=1)).max() < 1e-10
    assert radius == pytest.approx(np.linalg.norm(m) / (2 * float(found.start["H"])), rel=1e-7)


@pytest.mark.parametrize("degree", [2, 4, 6])
@pytest.mark.parametrize("intervals", [5, 10, 20])
@pytest.mark.parametrize("scheme", ["gauss", "radau"])
def test_estimated_errors_are_honest(
    solved: Solved, scheme: str, degree: int, intervals: int
) -> None:
    law = "law={type: single_sheet, chi: 1}"
    mesh = f"scheme: {scheme}, degree: {degree}, intervals: {intervals}"
    mesh = f"transcription={{type: collocation, {mesh}}}"
    found = solved("moebius_half", law, mesh, "solver={type: newton}")
    estimate = estimate_error(found)
    H = HALF_MOEBIUS["H"]
    true = {
        "n0": np.abs(found.n0 - HALF_MOEBIUS["n0"]).max(),
        "m0": np.abs(found.m0 - HALF_MOEBIUS["m0"]).max(),
        "u0": abs(found.u0[1] - HALF_MOEBIUS["u0"][1]),
        "H0": abs(float(found.start["H"]) - H),
        "energy": abs(found.energy - H / 2),
    }
    rounding = 1e-12
    for name, error in true.items():
        assert error <= estimate[name] + rounding, name
        assert estimate[name] <= 10 * SAFETY * error + rounding, name
