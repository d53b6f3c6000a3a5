"""Finite stiffness in the ribbon's own plane: clamps integrated again, rods, limits, mixtures."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from membrane_truth import Law, integrated, rod, sheet, smoothed
from scipy.spatial.transform import Rotation

from ribbonopt import prepare, solve, summarize
from ribbonopt.checks.stability import negative_directions, second_variation
from ribbonopt.scene import (
    Boundary,
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
)
from ribbonopt.solution.solution import Solution

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
