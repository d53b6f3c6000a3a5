"""Frames as scenes write them: four ways to say a rotation, against scipy's rotations."""

import math
from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from ribbonopt.mechanics.ends.frames import components, frame_of, number, unit
from ribbonopt.mechanics.rotations import turn_vector
from ribbonopt.scene import (
    AnyVector,
    Directors,
    End,
    LabVector,
    Quaternion,
    RotationVector,
    Turn,
    Turns,
)

Array = np.ndarray
EPS = 1e-15
LAB, DIRECTORS = ("x", "y", "z"), ("d1", "d2", "d3")
PAIRS = (("d1", "d2"), ("d2", "d3"), ("d1", "d3"))

angles = st.floats(-10, 10)
triples = st.tuples(angles, angles, angles)
quaternions = (
    st.tuples(*[st.floats(-1, 1)] * 4)
    .filter(lambda q: math.hypot(*q) > 1e-2)
    .map(lambda q: tuple(v / math.hypot(*q) for v in q))
)
axes = st.sampled_from([*LAB, *DIRECTORS])
turns = st.lists(st.tuples(axes, angles), min_size=1, max_size=6)


def frame(rotation: object, **parameters: float) -> Array:
    found = frame_of(End(directors=rotation), parameters)
    assert found is not None
    return found


def turned(*steps: tuple[str, float | str], **parameters: float) -> Array:
    return frame(Turns(tuple(Turn(**{axis: angle}) for axis, angle in steps)), **parameters)


def directors(matrix: Array, names: Sequence[str] = DIRECTORS) -> Directors:
    columns = {f"d{i + 1}": tuple(matrix[:, i].tolist()) for i in range(3)}
    return Directors(**{name: columns[name] for name in names})


def about(axis: str, angle: float) -> Array:
    """Matrix of a rotation about x, y or z (or d1, d2, d3, written in directors), by scipy."""
    index = (LAB if axis in LAB else DIRECTORS).index(axis)
    return Rotation.from_rotvec(angle * np.eye(3)[index]).as_matrix()


def test_the_identity_is_the_lab() -> None:
    assert (frame("identity") == np.eye(3)).all()


def test_what_is_not_whole_is_no_frame() -> None:
    assert frame_of(End(), {}) is None
    assert frame_of(End(d1=(1, 0, 0)), {}) is None
    assert frame_of(End(d1=(1, 0, 0), d2=LabVector(x=0)), {}) is None
    assert frame_of(End(d1=LabVector(x=0), d3=LabVector(x=0)), {}) is None


def test_columns_are_the_directors() -> None:
    found = frame(Directors(d1=(0, 1, 0), d2=(0, 0, 1)))
    np.testing.assert_array_equal(found, [[0, 0, 1], [1, 0, 0], [0, 1, 0]])


@settings(max_examples=40)
@given(quaternions)
@example((1.0, 0.0, 0.0, 0.0))
@example((0.0, 0.6, 0.0, 0.8))
def test_quaternions_have_their_scalar_first(q: tuple[float, ...]) -> None:
    expected = Rotation.from_quat([*q[1:], q[0]]).as_matrix()
    np.testing.assert_allclose(frame(Quaternion(q)), expected, rtol=0, atol=2 * EPS)


def test_a_quaternion_turns_the_lab_axes_to_the_directors() -> None:
    # A quarter of a turn about x: d2 is z, d3 is -y.
    half = math.sqrt(0.5)
    found = frame(Quaternion((half, half, 0, 0)))
    np.testing.assert_allclose(found, [[1, 0, 0], [0, 0, -1], [0, 1, 0]], atol=EPS)


@settings(max_examples=40)
@given(triples)
@example((0.0, 0.0, 0.0))
@example((0.0, 1e-300, 0.0))
@example((1e-9, -2e-9, 0.5e-9))
@example((0.0, math.pi, 0.0))
def test_rotation_vectors_are_axis_times_angle(vector: tuple[float, ...]) -> None:
    found = frame(RotationVector(vector))
    expected = Rotation.from_rotvec(vector).as_matrix()
    # An angle of 17 has an error of 17 eps in itself.
    atol = 2 * EPS * (1 + math.hypot(*vector))
    np.testing.assert_allclose(found, expected, rtol=0, atol=atol)


@settings(max_examples=40)
@given(quaternions, st.sampled_from([*PAIRS, DIRECTORS]))
def test_two_directors_are_as_good_as_three(q: tuple[float, ...], names: Sequence[str]) -> None:
    expected = Rotation.from_quat(q).as_matrix()
    np.testing.assert_allclose(frame(directors(expected, names)), expected, rtol=0, atol=2 * EPS)
    end = End(**{name: getattr(directors(expected), name) for name in names})
    np.testing.assert_allclose(frame_of(end, {}), expected, rtol=0, atol=2 * EPS)


@settings(max_examples=40)
@given(quaternions, st.sampled_from([*PAIRS, DIRECTORS]), st.integers(0, 99))
def test_directors_that_are_nearly_a_frame_become_one(
    q: tuple[float, ...], names: Sequence[str], seed: int
) -> None:
    exact = Rotation.from_quat(q).as_matrix()
    off = 5e-7 * np.random.default_rng(seed).uniform(-1, 1, (3, 3))
    found = frame(directors(exact + off, names))
    assert np.abs(found.T @ found - np.eye(3)).max() < 2 * EPS
    assert np.linalg.det(found) == pytest.approx(1)
    assert np.abs(found - exact).max() < 3e-6


@settings(max_examples=40)
@given(turns)
def test_turns_about_lab_axes_come_before_and_those_about_directors_after(
    steps: list[tuple[str, float]],
) -> None:
    expected = np.eye(3)
    for axis, angle in steps:
        turn = about(axis, angle)
        expected = turn @ expected if axis in LAB else expected @ turn
    size = sum(abs(angle) for _, angle in steps)
    np.testing.assert_allclose(turned(*steps), expected, rtol=0, atol=2 * EPS * (3 + size))


@settings(max_examples=40)
@given(triples)
def test_turns_are_the_euler_angles_of_scipy(angle: tuple[float, ...]) -> None:
    lab = turned(*zip("xyz", angle, strict=True))
    own = turned(*zip(DIRECTORS, angle, strict=True))
    atol = 2 * EPS * (3 + sum(map(abs, angle)))
    extrinsic = Rotation.from_euler("xyz", angle).as_matrix()
    intrinsic = Rotation.from_euler("XYZ", angle).as_matrix()
    np.testing.assert_allclose(lab, extrinsic, rtol=0, atol=atol)
    np.testing.assert_allclose(own, intrinsic, rtol=0, atol=atol)


def test_turns_by_hand() -> None:
    quarter = math.pi / 2
    # About x: d3 = -y, d2 = z. Then about z: -y -> x, z stays, x -> y.
    lab = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    np.testing.assert_allclose(turned(("x", quarter), ("z", quarter)), lab, atol=EPS)
    # About x, then about d3 = -y: d1 = x -> z, d2 = z -> -x.
    own = [[0, -1, 0], [0, 0, -1], [1, 0, 0]]
    np.testing.assert_allclose(turned(("x", quarter), ("d3", quarter)), own, atol=EPS)


@settings(max_examples=40)
@given(quaternions)
@example((math.cos(0.4), 0.0, math.sin(0.4), 0.0))
@example((0.0, 0.6, 0.0, 0.8))
def test_four_ways_of_one_rotation_are_one_frame(q: tuple[float, ...]) -> None:
    rotation = Rotation.from_quat([*q[1:], q[0]])
    R = rotation.as_matrix()
    sines = max(abs(R[0, 2]), abs(R[2, 0]))  # of the second Euler angles, lab and directors
    assume(sines < 1 - 1e-6)  # there the other two are not defined
    extrinsic, intrinsic = rotation.as_euler("zyx"), rotation.as_euler("ZYX")
    ways = {
        "quaternion": frame(Quaternion(q)),
        "opposite quaternion": frame(Quaternion(tuple(-v for v in q))),
        "directors": frame(directors(R)),
        "rotation vector": frame(RotationVector(tuple(rotation.as_rotvec().tolist()))),
        "lab turns": turned(*zip("zyx", extrinsic.tolist(), strict=True)),
        "turns": turned(*zip(("d3", "d2", "d1"), intrinsic.tolist(), strict=True)),
    }
    # Euler angles lose digits near where they are not defined.
    lost = 1 / math.sqrt(1 - sines**2)
    for name, matrix in ways.items():
        atol = 2 * EPS * (lost if "turns" in name else 1)
        np.testing.assert_allclose(matrix, ways["quaternion"], rtol=0, atol=atol, err_msg=name)


def test_one_rotation_said_in_exact_numbers_is_one_frame() -> None:
    # 2 pi / 3 about (1, 1, 1): x -> y -> z -> x.
    third = 2 * math.pi / 3 / math.sqrt(3)
    quarter = math.pi / 2
    ways = [
        frame(Directors(d1=(0, 1, 0), d2=(0, 0, 1), d3=(1, 0, 0))),
        frame(Quaternion((0.5, 0.5, 0.5, 0.5))),
        frame(RotationVector((third, third, third))),
        turned(("x", quarter), ("z", quarter)),
        turned(("d3", quarter), ("d1", quarter)),
    ]
    for matrix in ways:
        np.testing.assert_allclose(matrix, [[0, 0, 1], [1, 0, 0], [0, 1, 0]], rtol=0, atol=EPS)


def test_numbers_may_be_formulas_of_parameters() -> None:
    numbers = {"turn": 30.0, "c": 0.6, "s": 0.8}
    tilt = [[0.6, 0, 0.8], [0, 1, 0], [-0.8, 0, 0.6]]
    np.testing.assert_allclose(
        frame(Directors(d1=("c", 0, "-s"), d3=("s", "0*turn", "c")), **numbers), tilt, atol=EPS
    )
    found = frame(RotationVector(("2*turn*deg", 0, 0)), **numbers)
    np.testing.assert_allclose(found, about("x", math.pi / 3), atol=EPS)
    found = turned(("y", "3*turn*deg"), ("d3", "pi/2"), **numbers)
    np.testing.assert_allclose(found, [[0, 0, 1], [1, 0, 0], [0, 1, 0]], atol=EPS)
    half = frame(Quaternion(("sqrt(c**2)", 0, "s", 0)), **numbers)
    expected = Rotation.from_quat([0, 0.8, 0, 0.6]).as_matrix()
    np.testing.assert_allclose(half, expected, atol=EPS)


@settings(max_examples=40)
@given(triples)
def test_the_turn_vector_is_the_shortest_rotation_vector(vector: tuple[float, ...]) -> None:
    rotation = Rotation.from_rotvec(vector)
    found, expected = turn_vector(rotation.as_matrix()), rotation.as_rotvec()
    if np.linalg.norm(expected) > math.pi - 1e-6:  # half a turn about either sense of the axis
        expected *= np.sign(expected @ found)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14)


def test_values_of_a_scene() -> None:
    assert number("2*a + 1", {"a": 0.25}) == 1.5
    assert components(None, {}) == {}
    assert components((1, "a", 3), {"a": 2.0}) == {"x": 1, "y": 2, "z": 3}
    assert components(LabVector(y="-a"), {"a": 2.0}) == {"y": -2}
    assert components(AnyVector(x=0, d2=5), {}) == {"x": 0, "d2": 5}
    np.testing.assert_allclose(unit((0, "3*a", 4), {"a": 1.0}), [0, 0.6, 0.8], atol=EPS)
