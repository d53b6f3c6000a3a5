"""Clamps turned by more than half a turn: whole turns count.

A straight rod under tension has the torque of its twist, B3 2 pi turns (Sadowsky's relaxed law: 4).
The rest is counted from sampled frames: the angle of the twist about the axis of the clamps.
"""

import numpy as np
import pytest
from _pytest.mark.structures import ParameterSet
from scipy.spatial.transform import Rotation

from ribbonopt.mechanics.ends.winding import winding
from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import Boundary, End, RotationVector, Turn, Turns, loads_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT

Array = np.ndarray
ROD, SADOWSKY = "{type: kirchhoff, B2: 1, B3: 2}", "{type: sadowsky}"
PAPER, SMOOTH = "{type: regularized, epsilon: 0.001}", "{type: variational, delta: 0.01}"


def slow(value: float) -> ParameterSet:
    return pytest.param(value, marks=pytest.mark.slow)


PULLED = """name: pulled
law: {law}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end:
    position: {{x: 0, y: 0}}
    directors: {{turns: [{{z: 360*{turns}*deg}}]}}
    force: {{z: 200}}
tolerance: 1e-9
"""
HELD = """name: held
law: {law}
boundary:
  start: {{support: clamped, position: [0, 0, 0], directors: identity}}
  end: {{support: clamped, position: [0, 0, {z}], directors: {{{frame}}}}}
tolerance: 1e-8
"""


def turned(found: Solution) -> float:
    """Turns about the lab's z axis from end to end, followed along the ribbon."""
    o = found.outputs(np.linspace(*found.scene.interval, 2001))
    frames = np.stack([o[name] for name in ("d1", "d2", "d3")], axis=2)
    _, _, z, w = Rotation.from_matrix(frames).as_quat().T
    assert (z**2 + w**2).min() > 1e-3  # else it is not defined
    return float(np.diff(np.unwrap(2 * np.arctan2(z, w)))[:].sum() / (2 * np.pi))


@pytest.mark.parametrize(
    ("law", "stiffness"), [(ROD, 2.0), (SADOWSKY, 4.0), (PAPER, 4.0), (SMOOTH, 4 / 1.01**2)]
)
@pytest.mark.parametrize("turns", [0.25, -0.5, 1.5, 3, *map(slow, (0.75, 1, -2, 2.3))])
def test_a_straight_ribbon_has_the_torque_of_all_its_turns(
    law: str, stiffness: float, turns: float
) -> None:
    found = solve(loads_scene(PULLED.format(law=law, turns=turns)))
    assert found.verified, found.message
    assert not found.given_up
    twist = 2 * np.pi * turns
    np.testing.assert_allclose(found.m0, [0, 0, stiffness * twist], rtol=1e-8, atol=1e-6)
    np.testing.assert_allclose(found.n0, [0, 0, 200], rtol=1e-9, atol=1e-6)
    assert found.energy == pytest.approx(stiffness * twist**2 / 2, rel=1e-8)


@pytest.mark.parametrize(("law", "z"), [(ROD, 0.9), (ROD, 0.99), (SADOWSKY, 0.9), (PAPER, 0.99)])
@pytest.mark.parametrize("turns", [1.5, *map(slow, (1.0, -1.5))])
def test_clamps_nearer_than_the_length_are_wound_as_they_say(
    law: str, z: float, turns: float
) -> None:
    frame = f"turns: [{{z: 360*{turns}*deg}}]"
    found = solve(loads_scene(HELD.format(law=law, z=z, frame=frame)))
    assert found.verified, found.message
    assert turned(found) == pytest.approx(turns, abs=1e-3)


@pytest.mark.slow
def test_a_pulled_rod_buckles_where_it_should() -> None:
    # Known buckling loads of B2 = 1, B3 = 2 under a tension of 200, in turns.
    more = "parameters: {turns: 0.3}\ncontinuation: {parameter: parameters.turns, to: 3}\n"
    scene = loads_scene(PULLED.format(law=ROD, turns="turns") + more)
    found = [p.position for p in Continuation(scene) if p.kind == BRANCH_POINT]
    np.testing.assert_allclose(found, [2.33104, 2.53415, 2.80458], atol=6e-6)


def test_ways_to_write_the_same_turns_agree() -> None:
    ways = (
        "turns: [{z: 3*pi}]",
        "turns: [{d3: 540*deg}]",
        "turns: [{z: 180*deg}, {z: 360*deg}]",
        "rotation_vector: [0, 0, 3*pi]",
    )
    energies = [solve(loads_scene(HELD.format(law=ROD, z=0.9, frame=way))).energy for way in ways]
    np.testing.assert_allclose(energies, energies[0], rtol=1e-8)
    shortest = solve(loads_scene(HELD.format(law=ROD, z=0.9, frame="turns: [{z: pi}]"))).energy
    assert shortest < energies[0] - 10


def test_turns_that_cannot_be_kept_are_told() -> None:
    # That near, the ribbon passes round its own end and loses two turns.
    found = solve(loads_scene(HELD.format(law=ROD, z=0.5, frame="turns: [{z: 720*deg}]")))
    assert found.verified, found.message
    assert any("the whole turns of the ends" in text for text in found.given_up)


@pytest.mark.parametrize("angle", [0.5, np.pi / 2, np.pi, -np.pi])
def test_up_to_half_a_turn_nothing_is_wound(angle: float) -> None:
    assert winding(Boundary(End(directors="identity"), _turned(angle)), {}) is None


@pytest.mark.parametrize("angle", [3.2, -3.2, 2 * np.pi, 3 * np.pi, -5 * np.pi, 19.0])
@pytest.mark.parametrize("axis", ["z", "d2"])
def test_a_single_rotation_is_taken_at_its_word(angle: float, axis: str) -> None:
    vector = angle * np.eye(3)[2 if axis == "z" else 1]
    found = winding(Boundary(End(directors="identity"), _turned(angle, axis)), {})
    np.testing.assert_allclose(found, vector, atol=1e-12)
    end = End(directors=RotationVector(tuple(vector.tolist())))
    np.testing.assert_allclose(winding(Boundary(End(directors="identity"), end), {}), vector)


def test_turns_count_from_those_of_the_start() -> None:
    start, end = _turned(4 * np.pi), _turned(4 * np.pi + 1.0)
    np.testing.assert_allclose(winding(Boundary(start, end), {}), [0, 0, 1.0], atol=1e-9)
    np.testing.assert_allclose(winding(Boundary(end, start), {}), [0, 0, -1.0], atol=1e-9)


def test_further_small_turns_change_the_axis_but_not_the_count() -> None:
    end = End(directors=Turns((Turn(z=5 * np.pi), Turn(x=0.1), Turn(d2=-0.05))))
    found = winding(Boundary(End(directors="identity"), end), {})
    assert found is not None
    frame = Rotation.from_rotvec([0.1, 0, 0]) * Rotation.from_rotvec([0, 0, 5 * np.pi])
    frame = frame * Rotation.from_rotvec([0, -0.05, 0])
    np.testing.assert_allclose(
        Rotation.from_rotvec(found).as_matrix(), frame.as_matrix(), atol=1e-12
    )
    assert np.linalg.norm(found) == pytest.approx(5 * np.pi, abs=0.1)
    assert found[2] > 0


def _turned(angle: float, axis: str = "z") -> End:
    return End(directors=Turns((Turn(**{axis: angle}),)))  # type: ignore[arg-type]
