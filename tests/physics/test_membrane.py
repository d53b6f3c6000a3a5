"""Finite stiffness in the ribbon's own plane: clamps integrated again, rods, limits, mixtures."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from membrane_truth import Law, integrated, rod, sheet, smoothed, turned
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation
from test_mixture import clamp as random_clamp
from test_mixture import draw

from ribbonopt import Continuation, buckling_loads, load_scene, prepare, solve, summarize
from ribbonopt.checks.stability import negative_directions, second_variation
from ribbonopt.scene import (
    Boundary,
    Collocation,
    ContinuationStage,
    Directors,
    End,
    Kirchhoff,
    Loads,
    Membrane,
    PointLoad,
    Rod,
    Sadowsky,
    Scene,
    Variational,
    Wunderlich,
)
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT

Array = np.ndarray
#: end position, rotation vector, and the sheets of Sadowsky's ribbon: SCIENCE-NEXT, head
C = (np.array([0.68, 0.15, 0.31]), np.array([0.0, 2.4, 0.6]), (1,))
S = (np.array([0.3, 0.06, 0.9]), np.array([0.0, -0.6, 0.5]), (1, -1))
FINITE = {"bending": 7.0, "stretching": 1e3}
LAWS: dict[str, tuple[Any, tuple[Law, ...]]] = {
    "rod": (Kirchhoff(B2=1.0, B3=0.8), (rod(1.0, 0.8),)),
    "smooth": (Variational(delta=0.1), (smoothed(0.1),)),
}


def clamp(law: Any, place: Array, turn: Array, **settings: Any) -> Scene:
    """Clamped at the origin with the lab's frame, and at a place, turned."""
    ends = []
    for r, frame in ((np.zeros(3), np.eye(3)), (place, Rotation.from_rotvec(turn).as_matrix())):
        x, y, z = map(float, r)
        d1, d2, d3 = (tuple(column.tolist()) for column in frame.T)
        ends.append(End("clamped", position=(x, y, z), directors=Directors(d1, d2, d3)))
    return Scene("clamp", law, Boundary(*ends), **{"tolerance": 1e-10, **settings})


def off(found: Solution, laws: tuple[Law, ...], place: Array, turn: Array, **more: Any) -> float:
    """How far the end of the ribbon integrated from the loads found is from its clamp."""
    end = integrated(laws, found.n0, found.m0, **more)
    return end.off(place, Rotation.from_rotvec(turn).as_matrix())


@pytest.mark.parametrize("formulation", ["inverted", "algebraic", "differentiated", "energy"])
@pytest.mark.parametrize("name", LAWS)
def test_a_clamp_integrated_again(name: str, formulation: Any) -> None:
    law, laws = LAWS[name]
    settings = {"formulation": formulation, "tolerance": None}
    found = solve(clamp(law, *C[:2], membrane=Membrane(**FINITE), **settings))
    assert found.verified
    assert off(found, laws, *C[:2], B1=7.0, EA=1e3) < 1e-10
    plain = solve(clamp(law, *C[:2]))
    assert np.abs(found.n0 - plain.n0).max() > 0.1  # it matters


@pytest.mark.parametrize(("goal", "formulation"), [(C, "inverted"), (C, "energy"), (S, "inverted")])
@pytest.mark.parametrize("finite", [{"bending": 7.0}, {"stretching": 1e3}, FINITE])
def test_sadowskys_clamps_integrated_again(goal: Any, finite: Any, formulation: Any) -> None:
    place, turn, sheets = goal
    settings = {"formulation": formulation, "tolerance": 1e-10}
    if formulation == "energy":
        settings["tolerance"] = None
    found = solve(clamp(Sadowsky(), place, turn, membrane=Membrane(**finite), **settings))
    assert found.verified and found.sheets in ((), sheets)
    more = {"B1": finite.get("bending", np.inf), "EA": finite.get("stretching", np.inf)}
    assert off(found, tuple(map(sheet, sheets)), place, turn, **more) < 1e-9
    for name in ("H", "n_dot_m"):
        along = found.sample(np.linspace(0, 1, 9), name)
        assert np.ptp(along) < 1e-9 * np.abs(along).max()
    assert negative_directions(found) == 0


@pytest.mark.parametrize("formulation", ["inverted", "algebraic", "differentiated", "energy"])
def test_kirchhoffs_law_with_b1_is_the_rod(formulation: Any) -> None:
    settings: dict[str, Any] = {"formulation": formulation, "tolerance": None}
    whole = solve(clamp(Rod(B=(3.0, 1.0, 0.8)), *C[:2], **settings))
    law = Kirchhoff(B2=1.0, B3=0.8)
    found = solve(clamp(law, *C[:2], membrane=Membrane(bending=3.0), **settings))
    s = np.linspace(0, 1, 7)
    for name in ("r", "d1", "n", "m", "u", "H", "energy"):
        np.testing.assert_allclose(found.sample(s, name), whole.sample(s, name), atol=1e-12)


def test_one_that_is_isotropic_spins() -> None:
    """Half a ring between two clamps on one axis: SCIENCE-NEXT, section 4."""
    ends = Boundary(
        End(position=(0.0, 0.0, 0.0), directors="identity"),
        End(position=(0.0, 0.0, 0.7), directors="identity"),
    )
    whole = Scene("spin", Rod(B=(1.0, 1.0, 0.8)), ends, tolerance=1e-9)
    law = Kirchhoff(B2=1.0, B3=0.8)
    said = [second_variation(solve(whole))]
    for B1 in (1.0, 1.7):
        scene = replace(whole, law=law, membrane=Membrane(bending=B1))
        said.append(second_variation(solve(scene)))
    assert not any(isinstance(one, str) for one in said)
    assert [one.spins for one in said] == [True, True, False]  # type: ignore[union-attr]


def test_stiff_ones_tend_to_the_rigid_one_as_one_over_their_stiffness() -> None:
    rigid = solve(clamp(Sadowsky(), *C[:2]))
    for name, sizes in (("bending", (1e4, 1e6)), ("stretching", (1e5, 1e7))):
        gaps = []
        for size in sizes:
            found = solve(clamp(Sadowsky(), *C[:2], membrane=Membrane(**{name: size})))
            gaps.append(np.abs(found.n0 - rigid.n0).max() * size)
        assert gaps[0] > 1 and gaps[1] == pytest.approx(gaps[0], rel=0.02)


def test_bars_cover() -> None:
    """The truth is a Newton step of the independent integration, from the answer of a wide mesh."""
    scene = clamp(Sadowsky(), *C[:2], membrane=Membrane(**FINITE), tolerance=1e-5)
    bars = summarize(rough := solve(scene))["error_estimate"]
    found = solve(replace(scene, tolerance=1e-11))
    assert off(found, (sheet(1),), *C[:2], B1=7.0, EA=1e3) < 1e-10
    for name in ("n0", "m0", "energy"):
        gap = np.abs(np.array(getattr(rough, name)) - getattr(found, name)).max()
        assert gap < bars[name] + 1e-10


def test_states_of_all_kinds_say_the_same() -> None:
    finite = Membrane(**FINITE)
    reduced = solve(clamp(Sadowsky(), *C[:2], membrane=finite))
    full = solve(clamp(Sadowsky(), *C[:2], membrane=finite, states="full"))
    np.testing.assert_allclose(full.n0, reduced.n0, atol=1e-9)
    place, turn = np.array([0.3, 0.0, 0.6]), np.array([0.0, 1.0, 0.0])
    law = Kirchhoff(B2=1.5)
    planar = solve(clamp(law, place, turn, membrane=finite, states="planar"))
    space = solve(clamp(law, place, turn, membrane=finite))
    np.testing.assert_allclose(planar.n0, space.n0, atol=1e-9)
    assert off(planar, (rod(1.5, 2.0),), place, turn, B1=7.0, EA=1e3) < 1e-10


@pytest.mark.parametrize("formulation", ["inverted", "energy"])
def test_a_dead_load_along_it(formulation: Any) -> None:
    f = np.array([2.0, 4.0, -4.0])
    settings: dict[str, Any] = {"formulation": formulation, "tolerance": None}
    if formulation == "inverted":
        settings["tolerance"] = 1e-10
    scene = clamp(
        Sadowsky(), *C[:2], membrane=Membrane(**FINITE), loads=Loads(force=(2, 4, -4)), **settings
    )
    found = solve(scene)
    assert found.verified
    assert off(found, (sheet(1),), *C[:2], B1=7.0, EA=1e3, force=lambda s: f) < 1e-8
    s = np.linspace(0, 1, 9)
    level = found.sample(s, "H") + found.sample(s, "r") @ f
    assert np.ptp(level) < 1e-8
    assert negative_directions(found) == 0


def test_a_dead_load_at_one_place_of_it() -> None:
    """Of both forms: n falls by the load, the ribbon is integrated piece by piece."""
    P, at = np.array([1.5, -2.0, 3.0]), 0.4
    scene = clamp(
        Sadowsky(),
        *C[:2],
        membrane=Membrane(**FINITE),
        loads=Loads(points=(PointLoad(at=at, force=(1.5, -2.0, 3.0)),)),
    )
    found = solve(scene)
    least = solve(replace(scene, formulation="energy", tolerance=None))
    assert found.verified and least.verified
    first = integrated((sheet(1),), found.n0, found.m0, at, B1=7.0, EA=1e3)
    second = integrated(
        (sheet(1),), first.n - P, first.m, 1 - at, B1=7.0, EA=1e3, frame=first.frame
    )
    end = second._replace(r=second.r + first.r)
    assert end.off(C[0], Rotation.from_rotvec(C[1]).as_matrix()) < 1e-9
    np.testing.assert_allclose(least.energy, found.energy, rtol=1e-4)  # one mesh, across the jump


def test_its_equations_serve_any_stiffness() -> None:
    """Stiffnesses are numbers of the problem: no new equations for another."""
    scene = clamp(Sadowsky(), *C[:2], membrane=Membrane(**FINITE))
    prepared = prepare(scene)
    other = replace(scene, membrane=Membrane(bending=50.0, stretching=2e4))
    assert off(prepared.solve(other), (sheet(1),), *C[:2], B1=50.0, EA=2e4) < 1e-9


def test_wunderlichs_law_by_both_forms() -> None:
    """States of the law's own go through; equilibrium and least energy share no equations of it."""
    scene = clamp(Wunderlich(width=0.05), *C[:2], membrane=Membrane(**FINITE), tolerance=1e-9)
    found = solve(scene)
    mesh = Collocation(intervals=40)
    least = solve(replace(scene, formulation="energy", tolerance=None, transcription=mesh))
    assert found.verified and least.verified
    assert least.energy == pytest.approx(found.energy, abs=1e-8)
    np.testing.assert_allclose(least.n0, found.n0, atol=1e-5)
    s = np.linspace(0, 1, 9)
    for name in ("H", "n_dot_m"):
        assert np.ptp(found.sample(s, name)) < 1e-9
    np.testing.assert_allclose(found.sample(s, "u1"), found.sample(s, "m1") / 7, atol=1e-12)
    sadowsky = solve(replace(scene, law=Sadowsky()))
    narrow = solve(replace(scene, law=Wunderlich(width=0.01)))
    gaps = [np.abs(one.n0 - sadowsky.n0).max() for one in (found, narrow)]
    assert gaps[1] < gaps[0] / 5 < 0.05


@pytest.mark.parametrize(("number", "kinds"), [(4, (-1, 0, 1, -1)), (5, (1, 0, 1))])
def test_mixtures_integrated_again(number: int, kinds: tuple[int, ...]) -> None:
    """Along them u2 is what keeps D = (1 + e) n1 + m1 m3 (1/4 - 1/B1) zero, written out here."""
    place, frame = draw(number)
    B1, EA = 100.0, 1e5
    scene = replace(random_clamp(place, frame), membrane=Membrane(B1, EA))
    found = solve(scene)
    assert found.verified and found.sheets == kinds
    ends = [0.0, *found.switch_points, 1.0]
    i = kinds.index(0)

    def mixed(n: Array, m: Array) -> Array:
        e, share = n[2] / EA, 1 / 4 - 1 / B1
        K = (1 + e) * n[2] - n[0] ** 2 / EA + share * (m[2] ** 2 - m[0] ** 2)
        turning = (1 + e) * n[1] * (m[2] / 4 + share * m[2]) - n[0] * n[1] * m[0] / (B1 * EA)
        return np.array([m[0] / B1, turning / K, m[2] / 4])

    def rates(s: float, y: Array) -> Array:
        R, n, m = y[3:12].reshape(3, 3), y[12:15], y[15:18]
        along = (1 + R[:, 2] @ n / EA) * R[:, 2]
        turn = R @ turned(mixed(R.T @ n, R.T @ m))
        return np.concatenate([along, turn.ravel(), np.zeros(3), np.cross(n, along)])

    def state(s: float) -> Array:
        R = np.stack([found.sample(s, f"d{j}") for j in (1, 2, 3)], axis=1)
        return np.concatenate([found.sample(s, "r"), R.ravel(), *map(found.sample, (s, s), "nm")])

    run = solve_ivp(rates, ends[i : i + 2], state(ends[i]), "DOP853", rtol=1e-12, atol=1e-12)
    last = state(ends[i + 1])
    np.testing.assert_allclose(run.y[:12, -1], last[:12], rtol=0, atol=1e-7)
    np.testing.assert_allclose(run.y[12:, -1], last[12:], rtol=1e-7, atol=1e-6)
    m2 = np.einsum("ik,ik->k", run.y[4:12:3], run.y[15:])
    assert np.abs(m2).max() < 1e-6 * np.abs(run.y[15:]).max()


def test_it_sinks_in_its_plane_before_it_buckles_sideways(configs: Path) -> None:
    """Two searches that share none of it: an infinitesimal deflection, and a branch point.

    The smooth law at delta = 1 is the rod with B2 = B3 = 1 but has no linearisation at m = 0.
    """
    scene = replace(load_scene(configs / "lateral_buckling.yaml"), record={})
    scene = replace(scene, membrane=Membrane(bending=10.0), parameters={"q": 13.0})
    bare = replace(scene, law=Variational(delta=1.0), continuation=None)
    (found, *_) = buckling_loads(bare, "parameters.q", 10.0, 30.0)
    stage = ContinuationStage("parameters.q", to=16.0, from_=13.0, largest=1.0)
    walk = Continuation(replace(scene, law=Kirchhoff(B2=1.0, B3=1.0), continuation=stage))
    (point,) = (p for p in walk if p.kind == BRANCH_POINT)
    assert found.value == pytest.approx(point.row["parameters.q"], abs=1e-8)
    assert found.value > 12.85376332 * 1.1  # rigid in its plane: SCIENCE-NEXT, section 7
