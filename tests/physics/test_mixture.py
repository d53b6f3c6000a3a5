"""Clamped ribbons of Sadowsky's law that change sheet: jumps, and mixtures of both sheets.

Each phase is integrated again by DOP853 with the equations written out here. The exact case is a
helix with |u2| < |u3|, which is a mixture: n = 4 u3 (u2 d2 + u3 d3), m = 4 u3 d3, energy 2 u3^2.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from ribbonopt.checks.arcs import Arcs
from ribbonopt.checks.verify import verify
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.scene import Collocation, Scene, loads_scene
from ribbonopt.scene.loads import Loads
from ribbonopt.solution.potential import potential
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

Array = np.ndarray
SADOWSKY = "{type: sadowsky}"
VARIATIONAL = "{type: variational, delta: 0.01}"
#: kinds of the phases by the number of the draw
MIXED = {0: (1, -1, 0, 1), 4: (-1, 0, 1), 5: (1, 0, 1)}
JUMPS = {2: (1, -1), 13: (-1, 1, -1), 1: (-1, 1, -1, 1)}


def draw(number: int) -> tuple[Array, Array]:
    """Return position (3,) and directors (3, 3), as columns, of the end of a random clamp."""
    rng = np.random.default_rng(1)
    for _ in range(number + 1):
        q = rng.normal(size=4)
        distance, v = rng.uniform(0.3, 0.95), rng.normal(size=3)
    directors = Rotation.from_quat(q[[1, 2, 3, 0]]).as_matrix()
    return distance * v / np.linalg.norm(v), directors


def clamp(
    position: Array,
    directors: Array,
    *,
    start: Array | None = None,
    law: str = SADOWSKY,
    tolerance: float | None = 1e-8,
    mesh: str = "degree: 6, intervals: 20",
) -> Scene:
    """Return the ribbon from the origin, and the directors `start`, to these."""

    def frame(d: Array) -> str:
        return "{" + ", ".join(f"d{i + 1}: {d[:, i].tolist()}" for i in range(3)) + "}"

    return loads_scene(
        f"""name: clamp
law: {law}
boundary:
  start: {{position: [0, 0, 0], directors: {frame(np.eye(3) if start is None else start)}}}
  end: {{position: {position.tolist()}, directors: {frame(directors)}}}
transcription: {{type: collocation, scheme: gauss, {mesh}}}
"""
        + (f"tolerance: {tolerance}\n" if tolerance else "")
    )


@cache
def solved(number: int) -> Solution:
    found = solve(clamp(*draw(number)))
    assert found.verified, found.message
    return found


def rates(kind: int) -> Callable[[float, Array], Array]:
    """Return y' of y = r, d1, d2, d3, n, m, energy on one sheet (+1, -1) or a mixture (0)."""

    def rates_at(_: float, y: Array) -> Array:
        d, n, m = y[3:12].reshape(3, 3), y[12:15], y[15:18]
        _, n2, n3 = d @ n
        m1, m2, m3 = d @ m
        if kind:
            M = np.hypot(m2, m3)
            u2, u3 = kind * (kind * m2 + M) ** 2 / (4 * M), m3 * (kind * m2 + M) / (4 * M)
            energy = (u2**2 + u3**2) ** 2 / (2 * u2**2)  # (2.8)
        else:
            u3 = m3 / 4
            u2 = 2 * n2 * u3 / (n3 + m3 * u3 - m1**2 / 4)
            energy = 2 * u3**2
        turn = np.cross(u2 * d[1] + u3 * d[2], d).ravel()
        return np.concatenate([d[2], turn, np.zeros(3), np.cross(n, d[2]), [energy]])

    return rates_at


def integrated(kind: int, y: Array, a: float, b: float) -> Array:
    run = solve_ivp(rates(kind), (a, b), y, method="DOP853", rtol=1e-12, atol=1e-12)
    assert run.success
    return run.y[:, -1]


def state(found: Solution, s: float) -> Array:
    names = ("r", "d1", "d2", "d3", "n", "m")
    return np.concatenate([*(found.sample(s, name) for name in names), [0.0]])


def ends(found: Solution) -> Array:
    return np.concatenate([[0.0], found.switch_points, [1.0]])


def assert_same(found: Array, exact: Array, tolerance: float) -> None:
    """Assert that lengths and directors agree, and loads relative to the largest."""
    np.testing.assert_allclose(found[:12], exact[:12], rtol=0, atol=tolerance)
    loads = tolerance * np.abs(exact[12:18]).max()
    np.testing.assert_allclose(found[12:18], exact[12:18], rtol=0, atol=loads)


@pytest.mark.parametrize("number", [*MIXED, *JUMPS])
def test_each_phase_integrated_again(number: int) -> None:
    found = solved(number)
    assert found.sheets == (MIXED | JUMPS)[number]
    position, directors = draw(number)
    energy, s = 0.0, ends(found)
    for kind, a, b in zip(found.sheets, s[:-1], s[1:], strict=True):
        # where two phases meet, everything sampled but u2 is of both
        end = integrated(kind, state(found, a), a, b)
        assert_same(state(found, b), end, 1e-7)
        m2 = end[6:9] @ end[15:18]
        if b < 1:
            assert abs(m2) < 1e-7 * np.abs(end[15:18]).max()
        energy += end[18]
    np.testing.assert_allclose(end[:3], position, rtol=0, atol=1e-7)
    np.testing.assert_allclose(end[3:12].reshape(3, 3).T, directors, rtol=0, atol=1e-7)
    assert found.energy == pytest.approx(energy, rel=1e-8)


@pytest.mark.parametrize("number", MIXED)
def test_mixture_keeps_its_relations(number: int) -> None:
    found = solved(number)
    i = found.sheets.index(0)
    a, b = ends(found)[i : i + 2]
    assert b - a > 0.01
    s = np.linspace(a + 1e-9, b - 1e-9, 41)
    o = found.outputs(s)
    m1, m2, m3, n1, n2, n3 = (o[name] for name in ("m1", "m2", "m3", "n1", "n2", "n3"))
    u2, u3 = o["u2"], o["u3"]
    loads = np.abs(o["m"]).max()
    np.testing.assert_allclose(m2, 0, atol=1e-7 * loads)
    np.testing.assert_allclose(n1 + m1 * m3 / 4, 0, atol=1e-7 * np.abs(o["n"]).max())
    np.testing.assert_allclose(u3, m3 / 4, rtol=1e-12)
    K = n3 + m3 * u3 - m1**2 / 4
    assert (K >= 0).all()
    np.testing.assert_allclose(u2, 2 * n2 * u3 / K, rtol=1e-9, atol=1e-9)
    assert (np.abs(u2) <= np.abs(u3)).all()
    np.testing.assert_allclose(o["energy"], 2 * u3**2, rtol=1e-12)
    # W_Leg + n3 is the same on both sides of every switch, and along the arc
    H = found.outputs(np.linspace(0, 1, 101))["H"]
    np.testing.assert_allclose(H, H[0], rtol=1e-7)


@pytest.mark.parametrize("number", MIXED)
def test_energy_of_a_mixture_is_that_of_its_twist(number: int) -> None:
    # alone and in the sum: Gauss points of this test's own on every phase
    found = solved(number)
    x, w = np.polynomial.legendre.leggauss(24)
    total, s = 0.0, ends(found)
    for kind, a, b in zip(found.sheets, s[:-1], s[1:], strict=True):
        o = found.outputs((a + b) / 2 + (b - a) / 2 * x)
        u2, u3 = o["u2"], o["u3"]
        density = (u2**2 + u3**2) ** 2 / (2 * u2**2) if kind else 2 * u3**2
        total += (b - a) / 2 * w @ density
    assert found.energy == pytest.approx(total, rel=1e-7)


@pytest.mark.parametrize(("number", "points"), [(4, (0.601, 0.804)), (5, (0.259, 0.789))])
def test_switches_are_where_another_program_found_them(
    number: int, points: tuple[float, float]
) -> None:
    np.testing.assert_allclose(solved(number).switch_points, points, rtol=0, atol=6e-4)


def helix_between_sheets() -> tuple[Array, Array, Array]:
    """Return the states at s = 0, 0.3, 1 of a helix from 0.3 to 0.7 and one sheet either side."""
    u2, u3 = 1.5, 2.5
    n, m = 4 * u3 * np.array([0, u2, u3]), np.array([0, 0, 4 * u3])
    entering = np.concatenate([np.zeros(3), np.eye(3).ravel(), n, m, [0.0]])
    start = integrated(1, entering, 0.3, 0.0)
    end = integrated(-1, integrated(0, entering, 0.3, 0.7), 0.7, 1.0)
    return start, entering, end


def test_helix_between_two_sheets_is_found_again() -> None:
    start, entering, end = helix_between_sheets()
    # the design itself: m2 has the signs of its phases, and the arc is a helix
    m2 = [y[6:9] @ y[15:18] for y in (start, end)]
    assert m2[0] > 1
    assert m2[1] < -1
    frames = start[3:12].reshape(3, 3).T, end[3:12].reshape(3, 3).T
    found = solve(clamp(end[:3] - start[:3], frames[1], start=frames[0]))
    assert found.verified, found.message
    assert found.sheets == (1, 0, -1)
    np.testing.assert_allclose(found.switch_points, [0.3, 0.7], rtol=0, atol=1e-8)
    for s, y in ((0.0, start), (0.3, entering), (1.0, end)):
        exact = y - np.concatenate([start[:3], np.zeros(16)])
        assert_same(state(found, s), exact, 1e-8)
    o = found.outputs(np.linspace(0.301, 0.699, 21))
    np.testing.assert_allclose(o["u2"], 1.5, rtol=1e-7)
    np.testing.assert_allclose(o["u3"], 2.5, rtol=1e-7)
    np.testing.assert_allclose(o["energy"], 12.5, rtol=1e-7)
    assert found.energy == pytest.approx(end[18] - start[18], rel=1e-9)


@pytest.mark.parametrize(
    ("number", "kinds", "switches"),
    [(4, (-1, 1), (0.7,)), (5, (1, -1, 1), (0.26, 0.79)), (0, (1, -1, 1), (0.33, 0.81))],
)
def test_jumps_in_place_of_a_mixture_are_refused(
    number: int, kinds: tuple[int, ...], switches: tuple[float, ...]
) -> None:
    # The equations have a solution with these phases, in which m2 has signs that they exclude.
    prepared = prepare(clamp(*draw(number), tolerance=None))
    smooth = solve(clamp(*draw(number), law=VARIATIONAL, tolerance=None))
    search = prepared.search()
    assert not search.run_in(Arcs(kinds, np.array(switches)), smooth)
    assert search.last is not None
    best = search.last.best
    assert best is not None
    s = ends(best)
    wrong = [
        (kind * best.sample(np.linspace(a, b, 50)[1:-1], "m2")).min() < -1e-3
        for kind, a, b in zip(kinds, s[:-1], s[1:], strict=True)
    ]
    assert any(wrong)
    assert best.status is Status.WRONG_SOLUTION
    assert "m2 has the wrong sign" in best.message


@pytest.mark.slow
@pytest.mark.parametrize(
    ("sheets", "says"),
    [
        ((1, 0, 1), None),
        ((-1, 0, 1), "wrong sign between s = 0 and"),
        ((1, 0, -1), "wrong sign between s = 0.7"),
        ((0, 0, 1), "not a mixture"),
        # m2 is zero all along: no sign is wrong, but one sheet has |eta| <= 1
        ((1, 1, 1), "|eta|"),
    ],
)
def test_phases_that_are_not_so_are_refused(sheets: tuple[int, ...], says: str | None) -> None:
    prepared = prepare(clamp(*draw(5), tolerance=None))
    found = replace(prepared.solve(), sheets=sheets)
    problems = "; ".join(verify(found, prepared.ribbon).problems)
    assert (says in problems) if says else not problems


@pytest.mark.parametrize("hint", [(0.7,), (0.6, 0.7, 0.8)])
def test_switches_that_are_not_there_do_no_harm(hint: tuple[float, ...]) -> None:
    found = solve(replace(clamp(*draw(4)), switching=hint))
    assert found.verified, found.message
    assert found.sheets == MIXED[4]
    assert found.energy == pytest.approx(solved(4).energy, rel=1e-8)


@pytest.mark.parametrize("number", JUMPS)
def test_meshes_of_clamps_with_jumps_agree(number: int) -> None:
    coarse, fine = (
        solve(clamp(*draw(number), tolerance=tolerance, mesh="degree: 4, intervals: 10"))
        for tolerance in (1e-8, 1e-11)
    )
    assert coarse.sheets == fine.sheets == JUMPS[number]
    assert len(coarse.nodes) < len(fine.nodes)
    loads = max(np.abs(fine.n0).max(), np.abs(fine.m0).max())
    for name in ("n0", "m0"):
        gap = np.abs(getattr(coarse, name) - getattr(fine, name)).max()
        assert gap <= 1e-8 * loads
    np.testing.assert_allclose(coarse.switch_points, fine.switch_points, rtol=0, atol=1e-7)
    assert coarse.energy == pytest.approx(fine.energy, rel=1e-8)


@pytest.mark.parametrize(
    "loads",
    [
        pytest.param(Loads(force=(1.0, -2.0, 1.5)), marks=pytest.mark.slow),
        pytest.param(Loads(force=(0.0, "3*s", 0.0)), marks=pytest.mark.slow),
        pytest.param(Loads(couple=(0.3, -0.4, 0.5)), marks=pytest.mark.slow),
        Loads(couple=(0.0, "s", "0.5*s**2")),
        Loads(pressure=1.5),
    ],
)
def test_loads_turn_a_mixture_so_that_m2_stays_zero(loads: Loads) -> None:
    """Verified in each phase: m2 and n1 + m1 u3 + c2 are zero all along, the far clamp is met."""
    found = solve(replace(clamp(*draw(4)), loads=loads))
    assert found.verified, found.message
    assert found.sheets[:3] == (-1, 0, 1)
    if loads.force is not None:  # the convexified energy knows of no phases
        scene = replace(found.scene, formulation="energy", tolerance=None)
        other = solve(replace(scene, transcription=Collocation(degree=3, intervals=120)))
        assert other.verified
        assert potential(other) == pytest.approx(potential(found), rel=1e-5)
