"""The ordinary rod: known clamps by every formulation, symmetries, limits, a plane, no guess."""

from dataclasses import replace
from itertools import pairwise, product
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from ribbonopt import prepare, solve, summarize
from ribbonopt.checks.stability import negative_directions
from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.scene import (
    Boundary,
    Collocation,
    Directors,
    End,
    Kirchhoff,
    Loop,
    Rod,
    Scene,
    Shooting,
)
from ribbonopt.solution.solution import Solution

ROD = Rod(B=(3.0, 1.0, 0.8), natural=(0.4, 1.0, -0.5))
PLACE, TURN = np.array([0.68, 0.15, 0.31]), Rotation.from_rotvec([0.0, 2.4, 0.6])
#: SCIENCE-NEXT, section 4: by shooting of order eight and by collocation of the energy
KNOWN: dict[str, Any] = {
    "n0": (-1.8666739446, 0.5032061909, -0.5680288001),
    "m0": (0.1092371051, 0.8535486222, 1.2298306407),
    "energy": 1.505672122148,
}
ALONG = {"H": 1.0258628878, "n_dot_m": -0.4729783301}
MIDDLE = (0.3246011853, 2.6168669231, 0.6153729954)


def clamp(
    law: Rod | Kirchhoff = ROD,
    place: np.ndarray = PLACE,
    turn: Rotation = TURN,
    first: Rotation | None = None,
    **settings: Any,
) -> Scene:
    """Clamped at the origin with a frame (the lab's), and at a place with a frame."""
    ends = []
    for r, frame in ((np.zeros(3), first or Rotation.identity()), (place, turn)):
        x, y, z = map(float, r)
        d1, d2, d3 = (tuple(column.tolist()) for column in frame.as_matrix().T)
        ends.append(End("clamped", position=(x, y, z), directors=Directors(d1, d2, d3)))
    return Scene("clamp", law, Boundary(*ends), **{"tolerance": 1e-10, **settings})


FORMULATIONS = ["inverted", "algebraic", "differentiated", "energy"]
WAYS = [
    (f, s, Collocation(intervals=24)) for f, s in product(FORMULATIONS[:3], ("reduced", "full"))
]
WAYS += [("energy", "reduced", Collocation(intervals=24)), ("inverted", "reduced", Shooting())]


@pytest.mark.parametrize(("formulation", "states", "mesh"), WAYS)
def test_the_generic_clamp(formulation: Any, states: Any, mesh: Any) -> None:
    settings = {"formulation": formulation, "states": states, "transcription": mesh}
    found = solve(clamp(tolerance=None, **settings))
    assert found.verified
    close = 1e-9 if formulation == "energy" else 1e-10  # costates, to IPOPT's tolerance
    for name, value in KNOWN.items():
        np.testing.assert_allclose(getattr(found, name), value, rtol=0, atol=close)
    np.testing.assert_allclose(found.sample(0.5, "u"), MIDDLE, rtol=0, atol=close)
    s = np.linspace(0, 1, 7)
    for name, value in ALONG.items():
        np.testing.assert_allclose(found.sample(s, name), value, rtol=0, atol=close)
    assert negative_directions(found) == 0
    assert found.switch_points.size == 0 and not found.sheets


def test_bars_cover_and_nothing_is_said_of_a_surface() -> None:
    summary = summarize(solve(clamp()))
    bars = summary["error_estimate"]
    for name, value in KNOWN.items():
        off = np.abs(np.array(summary[name]) - value).max()
        assert off < bars[name] + 1e-10 / 2
    assert summary["law"] == {"type": "rod", "B": [3.0, 1.0, 0.8], "natural": [0.4, 1.0, -0.5]}
    assert summary["warnings"] == [] and summary["phases"] == []


def test_in_a_mirror() -> None:
    """Across y = 0: d2 and moments are reversed besides, and so are u1 and u3."""
    M, here = np.diag([1.0, -1.0, 1.0]), solve(clamp())
    frame = Rotation.from_matrix(M @ TURN.as_matrix() @ M)
    there = solve(clamp(Rod(B=ROD.B, natural=(-0.4, 1.0, 0.5)), M @ PLACE, frame))
    np.testing.assert_allclose(there.n0, M @ here.n0, rtol=0, atol=1e-10)
    np.testing.assert_allclose(there.m0, -M @ here.m0, rtol=0, atol=1e-10)
    assert there.energy == pytest.approx(here.energy, abs=1e-11)


def test_turned_in_space_and_about_itself() -> None:
    """Another frame of the lab; then d1 and d2 of the section by other names."""
    turn, here = Rotation.from_rotvec([0.3, -1.1, 2.0]), solve(clamp())
    there = solve(clamp(ROD, turn.apply(PLACE), turn * TURN, turn))
    np.testing.assert_allclose(there.n0, turn.apply(here.n0), rtol=0, atol=1e-10)
    np.testing.assert_allclose(there.m0, turn.apply(here.m0), rtol=0, atol=1e-10)
    quarter = Rotation.from_rotvec([0, 0, np.pi / 2])  # d1 becomes d2, d2 becomes -d1
    named = Rod(B=(1.0, 3.0, 0.8), natural=(1.0, -0.4, -0.5))
    there = solve(clamp(named, PLACE, TURN * quarter, quarter))
    np.testing.assert_allclose(there.n0, here.n0, rtol=0, atol=1e-10)
    np.testing.assert_allclose(there.m0, here.m0, rtol=0, atol=1e-10)


def test_kirchhoffs_rod_is_the_limit_of_a_stiff_one() -> None:
    limit = solve(clamp(Kirchhoff(B2=1.0, B3=0.8)))
    off = []
    for B1 in (1e4, 1e6, 1e8):
        found = solve(clamp(Rod(B=(B1, 1.0, 0.8))))
        assert found.verified
        off.append(np.abs(found.n0 - limit.n0).max() * B1)
    np.testing.assert_allclose(off, off[0], rtol=1e-2)


@pytest.mark.parametrize("formulation", FORMULATIONS[:3])
def test_in_a_plane_it_is_a_rod_that_bends_about_d2_alone(formulation: Any) -> None:
    """With k2 the moments are those of a rod without, less B2 k2: the shape is the same."""
    turn, place = Rotation.from_rotvec([0, 1.0, 0]), np.array([0.3, 0, 0.6])
    law = Rod(B=(3.0, 1.5, 0.8), natural=(0.0, 2.0, 0.0))
    found = solve(clamp(law, place, turn, states="planar", formulation=formulation))
    plain = solve(clamp(Kirchhoff(B2=1.5), place, turn, states="planar"))
    assert found.verified
    np.testing.assert_allclose(found.n0, plain.n0, rtol=0, atol=1e-8)
    np.testing.assert_allclose(found.m0, plain.m0 - (0, 3.0, 0), rtol=0, atol=1e-8)
    # W - W of the plain rod: -B2 k2 times the turn of the end, which is 1, and B2 k2^2 / 2.
    assert found.energy == pytest.approx(plain.energy - 3.0 + 3.0, abs=1e-8)


def test_what_leads_out_of_the_plane_is_refused() -> None:
    turn, place = Rotation.from_rotvec([0, 1.0, 0]), np.array([0.3, 0, 0.6])
    for natural in ((0.1, 0.0, 0.0), (0.0, 1.0, 0.1)):
        with pytest.raises(ModelError, match="natural strains of law rod lead out of the plane"):
            prepare(clamp(Rod(natural=natural), place, turn, states="planar"))
    flat = prepare(clamp(Rod(), place, turn, states="planar"))
    with pytest.raises(ModelError, match="natural strains of law rod lead out of the plane"):
        flat.solve(clamp(Rod(natural=(0.0, 0.0, 0.1)), place, turn, states="planar"))


def test_a_piece_of_a_loop_stands_for_all_while_natural_strains_have_its_symmetry() -> None:
    start = End(position=(0.0, 0.0, 0.0), directors="identity")
    half = Scene("ring", Rod(), Boundary(start, loop=Loop(0, "half")), interval=(0.0, 0.5))
    prepared = prepare(half)
    assert prepared.solve(replace(half, law=Rod(natural=(0.0, 1.0, 2.0)))).verified
    with pytest.raises(ModelError, match="more than its numbers"):
        prepared.solve(replace(half, law=Rod(natural=(0.1, 0.0, 0.0))))
    with pytest.raises(ModelError, match="by flips about d1, after which the natural strains"):
        prepare(replace(half, law=Rod(natural=(0.1, 0.0, 0.0))))


def random_clamps(count: int) -> list[Scene]:
    rng = np.random.default_rng(1)
    scenes = []
    for _ in range(count):
        direction = rng.normal(size=3)
        place = rng.uniform(0.3, 0.95) * direction / np.linalg.norm(direction)
        turn = Rotation.from_quat(rng.normal(size=4))
        B1, B2, B3 = np.exp(rng.uniform(np.log(0.05), np.log(20), 3)).tolist()
        k1, k2, k3 = rng.uniform(-5, 5, 3).tolist()
        mesh = Collocation(degree=6, intervals=40)
        scenes.append(
            clamp(Rod(B=(B1, B2, B3), natural=(k1, k2, k3)), place, turn, transcription=mesh)
        )
    return scenes


def confirmed(found: Solution) -> bool:
    """Whether an integration from the start, in up to 16 parts, meets the shape and the clamp."""
    law, s = found.scene.law, np.linspace(0, 1, 17)
    assert isinstance(law, Rod)
    B, k = np.array(law.B), np.array(law.natural)

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        d, m = y[3:12].reshape(3, 3), y[12:]
        w = d.T @ (d @ m / B + k)
        return np.concatenate([d[2], *(np.cross(w, x) for x in d), np.cross(found.n0, d[2])])

    names = ("r", "d1", "d2", "d3", "m")
    states = np.concatenate([found.sample(s, name) for name in names], axis=1)
    for parts in (1, 2, 4, 8, 16):
        rows = range(0, 17, 16 // parts)
        gaps = [
            solve_ivp(rates, (s[a], s[b]), states[a], "DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
            - states[b]
            for a, b in pairwise(rows)
        ]
        if np.abs(gaps).max() < 1e-7 * (1 + np.abs(states).max()):
            return True
    return False


def counted(scenes: list[Scene]) -> int:
    prepared, count = prepare(scenes[0]), 0
    for scene in scenes:
        try:
            found = prepared.solve(scene)
        except ConvergenceError:  # one of the 30 bends to 112 / L
            continue
        count += found.verified and confirmed(found)
    return count


def test_random_clamps_are_solved_from_nothing() -> None:
    assert counted(random_clamps(2)) == 2  # the first of the 30 below


@pytest.mark.slow
def test_more_random_clamps_are_solved_from_nothing() -> None:
    assert counted(random_clamps(30)) >= 29


def test_natural_strains_from_one_to_the_next_without_building_again() -> None:
    """A sweep: dW/dk2 = - integral of m2, since the shape is stationary."""
    prepared, h = prepare(clamp()), 1e-3
    nodes, weights = np.polynomial.legendre.leggauss(40)

    def at(k2: float) -> Solution:
        found = prepared.solve(clamp(Rod(B=ROD.B, natural=(0.4, k2, -0.5))))
        assert found.verified
        return found

    for k2 in (0.0, 2.5, 5.0):
        slope = (at(k2 + h).energy - at(k2 - h).energy) / (2 * h)
        expected = -(weights @ at(k2).sample((nodes + 1) / 2, "m2")) / 2
        assert slope == pytest.approx(expected, abs=1e-6)
