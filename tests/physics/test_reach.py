"""Scenes that a start must reach from nothing: strong loads, many turns, uneven rods.

Truths: first integrals of the planar elastica, helices, and integration by scipy.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_bvp, solve_ivp

from ribbonopt.mechanics.rotations import turns_about
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import loads_scene
from ribbonopt.solution.solution import Solution

LAWS = {
    "sadowsky": "{type: sadowsky}",
    "variational": "{type: variational, delta: 0.01}",
    "rod": "{type: kirchhoff, B2: 1, B3: 2}",
}


def cantilever(law: str, force: list[float], *more: str, angle: float = 0.0) -> Solution:
    """Solve a ribbon clamped at the start, turned by an angle about y, under a dead force."""
    return solve(
        loads_scene(
            f"name: a\nlaw: {law}\nboundary:\n"
            f"  start: {{support: clamped, position: [0, 0, 0], directors: "
            f"{{turns: [{{y: {angle}}}]}}}}\n"
            f"  end: {{support: free, force: {[float(f) for f in force]}}}\n" + "\n".join(more)
        )
    )


# Strong loads.


@pytest.mark.parametrize(
    ("law", "angle", "force"),
    [
        ("sadowsky", 90, 1e4),
        ("sadowsky", 90, -3e3),
        ("sadowsky", -90, 1e6),
        ("rod", 60, 1e5),
        ("variational", 60, -1e4),
        ("rod", 10, -1e5),
    ],
)
def test_strong_pulls_bend_a_layer_next_to_the_clamp(law: str, angle: float, force: float) -> None:
    """m2^2 / 2 + T cos(angle to the force) is constant; at the free end m2 and the angle are 0."""
    found = cantilever(LAWS[law], [0, 0, force], "tolerance: 1e-8", angle=np.deg2rad(angle))
    assert found.verified, found.message
    cosine = np.sign(force) * np.cos(np.deg2rad(angle))
    expected = np.sqrt(2 * abs(force) * (1 - cosine))
    assert abs(found.start["m2"]) == pytest.approx(expected, rel=1e-7)
    # Towards the force: its tangent turns by the smaller angle.
    assert found.start["m2"] * angle * force < 0
    np.testing.assert_allclose(found.sample(1.0, "d3"), [0, 0, np.sign(force)], atol=1e-4)


def test_mirror_images_are_both_found() -> None:
    one, other = (cantilever(LAWS["sadowsky"], [0, 0, 3e3], angle=a * np.pi / 2) for a in (1, -1))
    assert one.verified
    assert other.verified
    assert one.energy == pytest.approx(other.energy, rel=1e-6)
    assert one.start["m2"] == pytest.approx(-other.start["m2"], rel=1e-6)


@pytest.mark.parametrize("law", ["rod", "variational"])
@pytest.mark.parametrize("force", [[5e2, 1e3, 2e3], [-3e3, 1e3, 5e3]])
def test_strong_loads_sideways_are_integrated_to_a_free_end(law: str, force: list[float]) -> None:
    """From the moment found, integration by scipy ends where nothing bends the ribbon."""
    found = cantilever(LAWS[law], force, "tolerance: 1e-9")
    assert found.verified, found.message

    def strains(m2: float, m3: float) -> tuple[float, float]:
        if law == "rod":
            return m2, m3 / 2
        M, q, d = np.hypot(m2, m3), np.hypot(m2, 0.01 * m3), 0.01
        return m2 * (q + M) ** 2 / (4 * q * M), m3 * (q + M) * (q + d**2 * M) / (4 * q * M)

    def rates(s: float, x: np.ndarray) -> np.ndarray:
        r, frame = x[:3], x[3:].reshape(3, 3)
        m = found.m0 + np.cross(found.n0, r)
        u = np.array([0.0, *strains(float(m @ frame[:, 1]), float(m @ frame[:, 2]))])
        turned = np.cross(u, np.eye(3)).T  # columns u x e_i: d_i' along the directors
        return np.concatenate([frame[:, 2], (frame @ turned).ravel()])

    # Into the layer only: beyond it a pulled ribbon magnifies what rounding leaves.
    last = 4 / np.sqrt(np.linalg.norm(force))
    start = np.concatenate([np.zeros(3), np.eye(3).ravel()])
    truth = solve_ivp(rates, (0, last), start, method="DOP853", rtol=1e-11, atol=1e-12)
    size = np.abs(found.sample(last, "r")).max()
    np.testing.assert_allclose(truth.y[:3, -1], found.sample(last, "r"), atol=1e-5 * size)
    np.testing.assert_allclose(found.n0, force, rtol=1e-9)


def test_heavy_weight_is_brought_on_too() -> None:
    """A horizontal strip of weight 1e3 per length hangs down: angle'' = -w (1 - s) cos(angle)."""
    weight = 1e3
    found = cantilever(LAWS["rod"], [0, 0, 0], "loads: {force: [-1e3, 0, 0]}", "tolerance: 1e-8")
    assert found.verified, found.message

    def rates(s: np.ndarray, x: np.ndarray) -> np.ndarray:
        return np.array([x[1], -weight * (1 - s) * np.cos(x[0])])

    s = np.linspace(0, 1, 401)
    guess = np.array([np.pi / 2 * (1 - np.exp(-30 * s)), 15 * np.pi * np.exp(-30 * s)])
    truth = solve_bvp(
        rates, lambda a, b: np.array([a[0], b[1]]), s, guess, tol=1e-9, max_nodes=100000
    )
    assert truth.success
    assert abs(found.start["m2"]) == pytest.approx(truth.y[1, 0], rel=1e-7)
    assert found.sample(1.0, "d3")[0] == pytest.approx(-np.sin(truth.y[0, -1]), rel=1e-7)


# Many turns: the guess decides how many intervals there are.


@pytest.mark.parametrize("turns", [1, 10, 25])
def test_a_roll_of_many_turns_is_found_from_nothing(turns: int) -> None:
    moment = 2 * np.pi * turns
    found = solve(
        loads_scene(
            "name: roll\nlaw: {type: sadowsky}\ntolerance: 1e-9\nboundary:\n"
            "  start: {support: clamped, position: [0, 0, 0], directors: identity}\n"
            f"  end: {{support: free, moment: [0, {moment!r}, 0]}}\n"
        )
    )
    assert found.verified, found.message
    assert found.energy == pytest.approx(moment**2 / 2, rel=1e-9)
    np.testing.assert_allclose(found.at_nodes["m2"], moment, rtol=1e-9)


@pytest.mark.parametrize(("turns", "eta"), [(30, 0.3), (12, 0.6)])
def test_a_helix_between_clamps_is_found_from_its_strains(turns: int, eta: float) -> None:
    """Exact for any constant strains: E = u2^2 (1 + eta^2)^2 / 2."""
    u2 = float(2 * np.pi * turns / np.hypot(1, eta))
    u = np.array([0.0, u2, eta * u2])
    frame = turns_about(u[None])[0]
    size, axis = float(np.linalg.norm(u)), u / np.linalg.norm(u)
    along = axis * axis[2]
    across = np.eye(3)[2] - along
    end = along + (np.sin(size) * across + (1 - np.cos(size)) * np.cross(axis, [0, 0, 1])) / size
    columns = ", ".join(f"d{i + 1}: {[float(v) for v in frame[:, i]]}" for i in range(3))
    found = solve(
        loads_scene(
            "name: h\nlaw: {type: sadowsky}\ntolerance: 1e-8\nboundary:\n"
            "  start: {support: clamped, position: [0, 0, 0], directors: identity}\n"
            f"  end: {{support: clamped, position: {[float(v) for v in end]}, "
            f"directors: {{{columns}}}}}\n"
            f"guess: {{strains: [{u2!r}, {eta * u2!r}]}}\n"
        )
    )
    assert found.verified, found.message
    assert not found.given_up
    assert found.energy == pytest.approx(u2**2 * (1 + eta**2) ** 2 / 2, rel=1e-8)


def test_a_roll_from_loads_or_a_helix_needs_as_many_intervals() -> None:
    text = (
        "name: roll\nlaw: {type: kirchhoff, B2: 1, B3: 2}\nboundary:\n"
        "  start: {support: clamped, position: [0, 0, 0], directors: identity}\n"
        "  end: {support: free, moment: [0, 100, 0]}\n"
    )
    for guess in ("{force: [0, 0, 0], moment: [0, 99, 0]}", "{arc: 99}"):
        found = solve(loads_scene(f"{text}guess: {guess}\n"))
        assert found.verified, found.message
        assert not found.given_up
        assert len(found.nodes) - 1 > 30
        assert found.energy == pytest.approx(5e3, rel=1e-4)


# Uneven rods.


def half_moebius(law: str) -> Solution:
    return solve(
        loads_scene(
            f"name: hk\nlaw: {law}\ninterval: [0, 0.5]\ntolerance: 1e-8\nboundary:\n"
            "  start: {position: [0, 0, 0], directors: identity, force: {d1: 0}, "
            "moment: {d1: 0}}\n"
            "  end: {position: {y: 0, z: 0}, d1: {x: 0}, d3: {x: 0}}\n"
        )
    )


@pytest.mark.parametrize("ratio", [1e-3, 1e-2, 1e2, 1e3])
def test_rods_of_any_ratio_of_stiffnesses_are_found(ratio: float) -> None:
    """H = W_Leg + n3 is constant, and E = H L of a closed loop without load."""
    found = half_moebius(f"{{type: kirchhoff, B2: 1, B3: {ratio!r}}}")
    assert found.verified, found.message
    H = found.at_nodes["H"]
    np.testing.assert_allclose(H, H[0], rtol=1e-6)
    assert found.energy == pytest.approx(H[0] / 2, rel=1e-6)
    if ratio < 1:  # twist is nearly free: the circle's energy is approached from above
        assert np.pi**2 < found.energy < np.pi**2 * (1 + 10 * np.sqrt(ratio))


def test_a_failure_of_a_rod_does_not_speak_of_smooth_laws() -> None:
    from ribbonopt.solvers import Status

    assert "smooth law" not in Status.NO_START.value


# Several starts.


@pytest.mark.parametrize("distance", [-0.5, 0.4])
def test_more_starts_find_what_fewer_find(distance: float) -> None:
    energies = []
    for starts in (2, 5):
        found = solve(
            loads_scene(
                f"name: s\nlaw: {{type: sadowsky}}\nstarts: {starts}\nboundary:\n"
                "  start: {support: clamped, position: [0, 0, 0], directors: identity}\n"
                f"  end: {{support: clamped, position: [0, 0, {distance}], "
                "directors: identity}\n"
            )
        )
        assert found.verified, found.message
        energies.append([f.energy for f in (found, *found.others)])
    for fewer, more in pairwise(energies):
        for energy in fewer:
            assert min(abs(energy - e) for e in more) < 1e-3 * energy
