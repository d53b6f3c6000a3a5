"""Phases of Sadowsky's law along branches: born at clamps, between, as mixtures, and gone again.

Truth: the threshold of the sheared arch by shooting of symmetric halves, and the integrator in
`independent`, which knows nothing of this package.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from independent import Law, polish

from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import ContinuationStage, Scene, loads_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, KINK, POINT, Point

ARCH = """name: arch
law: {type: sadowsky}
parameters: {shear: 0}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, shear, 0.6875], directors: identity}
guess: {force: [0, 0, -46.97375812], moment: [0, 7.49816358, 0]}
tolerance: 1e-8
continuation: {parameter: parameters.shear, from: 0, to: 0.6, largest: 0.02}
"""
TURNED = """name: turned
law: {type: sadowsky}
parameters: {angle: 0}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end:
    support: clamped
    position: [0, 0, 0.7]
    directors: {turns: [{z: angle*deg}]}
tolerance: 1e-8
continuation: {parameter: parameters.angle, from: 0, to: 180, largest: 10}
"""
THRESHOLD = 0.25060501787  # of the sheared arch
SECOND = 0.38286571873  # where the state of height zero loses its symmetry
M2 = -0.02729  # at the clamp, where the shear is .251711: without phases there it is -.0775


def followed(text: str, **stage: object) -> tuple[list[Point[Solution]], Continuation]:
    """Return the points of a continuation with other settings of its stage."""
    scene = loads_scene(text)
    given = scene.continuation
    assert isinstance(given, ContinuationStage)
    continuation = Continuation(replace(scene, continuation=replace(given, **stage)))
    return list(continuation), continuation


def special(points: list[Point[Solution]]) -> list[tuple[str, float]]:
    return [(point.kind, point.position) for point in points if point.kind != POINT]


def truth(found: Solution) -> float:
    """Energy of the same equilibrium by the independent integrator."""

    def start(s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        o = found.outputs(s)
        return o["r"], np.stack([o["d1"], o["d2"], o["d3"]], axis=1)

    r, frame = (x[0] for x in start(np.array([1.0])))
    phases = {"kinds": found.sheets, "switches": list(found.switch_points)}
    exact = polish(Law("sadowsky"), found.n0, found.m0, start, (r, frame), **phases)
    assert exact.verdict == "found", exact.reason
    assert exact.path is not None
    assert exact.moved < 1e-6
    return exact.path.energy


@pytest.fixture(scope="module")
def arch() -> tuple[list[Point[Solution]], Continuation]:
    return followed(ARCH, to=0.3, switch=True)


@pytest.mark.parametrize("largest", [0.01, 0.03, 0.05, 0.3])
def test_the_arch_has_its_threshold_where_a_phase_is_born_at_the_clamps(largest: float) -> None:
    points, continuation = followed(ARCH, to=0.27, largest=largest)
    assert continuation.ending.reached
    ((kind, position),) = special(points)
    assert kind == KINK
    assert position == pytest.approx(THRESHOLD, abs=1e-9)
    before, after = points[-2:] if points[-2].kind == POINT else (points[-3], points[-1])
    assert before.position < THRESHOLD or before.solution.sheets == after.solution.sheets
    assert after.solution.sheets == (-1, 1, -1, 1, -1)


def test_moments_at_the_clamp_are_those_of_the_phases_there() -> None:
    points, _ = followed(ARCH, to=None, from_=None, values=(0.0, 0.24, 0.251711))
    assert points[-1].solution.sample(0.0, "m2") == pytest.approx(
        M2, abs=3e-5
    )  # to six digits of the shear


def test_asymmetric_arches_leave_linearly_and_are_mirror_images(
    arch: tuple[list[Point[Solution]], Continuation],
) -> None:
    points, continuation = arch
    sides = [[p for p in points if p.branch == k and p.kind == POINT] for k in (1, 2)]
    assert [side[0].solution.sheets for side in sides] == [(-1, 1, -1, 1), (1, -1, 1, -1)]
    prepared = continuation.prepared
    for side in sides:
        assert len(side) > 2
        off, found = [], side[0].solution
        for beyond in (4e-4, 2e-4, 1e-4):
            text = ARCH.replace("shear: 0}", f"shear: {THRESHOLD + beyond}}}")
            found = prepared.solve(loads_scene(text), guess=found, fallback=False)
            assert found.verified, found.message
            off.append(float(np.ptp(found.sample(np.array([0.0, 1.0]), "m2"))))
        # A pitchfork would have ratios of the square root of two.
        np.testing.assert_allclose(np.divide(off[:-1], off[1:]), 2.0, rtol=0.02)
    ends = [side[-1] for side in sides]
    assert ends[0].position == ends[1].position == 0.3
    assert ends[0].row["energy"] == pytest.approx(ends[1].row["energy"], rel=1e-8)
    assert ends[0].row["energy"] < points[-1].row["energy"] + 1e-9


def test_signs_are_those_of_stability_in_any_phases(
    arch: tuple[list[Point[Solution]], Continuation],
) -> None:
    points, _ = arch
    for point in points:
        if point.kind == POINT and point.branch == 0:
            assert point.sign == (-1 if point.position < THRESHOLD else 1)
        elif point.kind == POINT:  # stable, as the arch was
            assert point.sign == -1


@pytest.mark.slow
def test_asymmetric_arches_come_to_the_state_of_height_zero() -> None:
    # There m2 = m3 = 0 in the middle, and the law has no derivative.
    text = ARCH.replace("largest: 0.02", "largest: 0.02, stop: [middle < 3e-4]")
    text = text.replace("continuation", 'record: {middle: "dot(r, ex) at 0.5"}\ncontinuation')
    points, _ = followed(text, to=0.39, switch=True)
    for branch in (1, 2):
        last = [p for p in points if p.branch == branch and p.kind == POINT][-4:]
        middle, shear = [p.row["middle"] for p in last], [p.position for p in last]
        assert np.polyval(np.polyfit(middle, shear, 3), 0.0) == pytest.approx(SECOND, abs=1e-6)


@pytest.mark.slow
def test_the_arch_goes_on_with_a_mixture_born_inside() -> None:
    points, continuation = followed(ARCH)
    assert continuation.ending.reached
    assert [kind for kind, _ in special(points)] == [KINK, BRANCH_POINT]
    last = points[-1].solution
    assert last.sheets == (-1, 1, 0, 1, -1)
    assert last.energy == pytest.approx(truth(last), rel=1e-8)


PLACES = (20.0, 100.0, 200.0, 345.0, 352.0, 360.0)


@pytest.fixture(scope="module")
def turn() -> tuple[list[Point[Solution]], Continuation]:
    scene = loads_scene(TURNED)
    there = ContinuationStage("parameters.angle", values=(0.0, *PLACES), largest=10)
    back = replace(there, values=(*PLACES[::-1], 0.0))
    continuation = Continuation(replace(scene, continuation=(there, back)))
    return list(continuation), continuation


def landed(points: list[Point[Solution]], stage: int) -> Iterator[Point[Solution]]:
    for point in points:
        if point.stage == stage and point.kind == POINT and point.position in PLACES:
            yield point


@pytest.mark.slow
def test_a_clamp_is_turned_all_around_and_back(
    turn: tuple[list[Point[Solution]], Continuation],
) -> None:
    points, continuation = turn
    assert all(ending.reached for ending in continuation.endings.values())
    there = {point.position: point.solution for point in landed(points, 0)}
    back = {point.position: point.solution for point in landed(points, 1)}
    for place in PLACES[:-1]:
        assert there[place].sheets == back[place].sheets
        assert there[place].energy == pytest.approx(back[place].energy, rel=1e-8)
        np.testing.assert_allclose(there[place].switch_points, back[place].switch_points, atol=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("place", PLACES)
def test_points_of_the_turn_are_equilibria(
    turn: tuple[list[Point[Solution]], Continuation], place: float
) -> None:
    (point,) = (p for p in landed(turn[0], 0) if p.position == place)
    assert point.solution.energy == pytest.approx(truth(point.solution), rel=1e-8)


@pytest.mark.slow
def test_special_points_are_the_same_both_ways(
    turn: tuple[list[Point[Solution]], Continuation],
) -> None:
    ways = [special([p for p in turn[0] if p.stage == k]) for k in (0, 1)]
    assert [kind for kind, _ in ways[0]] == [KINK, BRANCH_POINT]
    assert [kind for kind, _ in ways[1]] == [BRANCH_POINT, KINK]
    np.testing.assert_allclose(
        [at for _, at in ways[0]], [at for _, at in reversed(ways[1])], rtol=0, atol=1e-6
    )


OFF = TURNED.replace("[0, 0, 0.7]", "[0.03, 0.06, 0.7]")


def test_births_that_change_no_sign_are_told_and_are_no_special_points() -> None:
    # Without the axis of symmetry one phase is born, and the kink dissolves.
    points, continuation = followed(OFF, from_=5.0, to=70.0)
    assert continuation.ending.reached
    told = [point for point in points[1:] if "phases:" in point.note]
    assert len(told) == 1
    assert [point for point in points if point.kind == KINK] == []
    assert {point.sign for point in points if point.kind == POINT} == {points[0].sign}
    last = points[-1].solution
    assert last.sheets == (-1, 1, -1, 1)
    assert last.energy == pytest.approx(truth(last), rel=1e-8)


def test_no_solution_is_verified_whose_strains_jump_without_a_phase(
    arch: tuple[list[Point[Solution]], Continuation],
) -> None:
    inside = next(p.solution for p in arch[0] if 0.1 < p.position < 0.2)
    scene: Scene = replace(inside.scene, switching="off", tolerance=None)
    attempt = prepare(scene).search().plain
    attempt.run(inside, quick=True, check=False)
    found = attempt.best
    assert found is not None
    assert found.status.converged  # Newton's method is content
    assert not attempt.check()
    assert "m2 changes sign" in attempt.best.message
