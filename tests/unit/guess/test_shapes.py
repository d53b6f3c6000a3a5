"""Shapes to start from: curves with frames, and where they put the ends of a scene."""

from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from ribbonopt.attempt.structure import Structure
from ribbonopt.guess import FollowerLoads, IntegratedLoads, ShapeGuess, guess_of, words
from ribbonopt.guess.named import loop_shape, shape_of
from ribbonopt.guess.placing import place_ends
from ribbonopt.guess.shapes import Chord, Helical, Perturbed, Shape, TwistedCircle
from ribbonopt.mechanics.section import RodFields
from ribbonopt.pipeline.prepared import solve
from ribbonopt.problem import Posed, Ribbon
from ribbonopt.problem.imposed import context
from ribbonopt.scene import (
    AnyVector,
    ArcGuess,
    Band,
    Boundary,
    Collocation,
    Directors,
    End,
    Helix,
    HelixGuess,
    LabVector,
    LoadGuess,
    Loop,
    MoebiusGuess,
    RotationVector,
    Sadowsky,
    Scene,
    StrainGuess,
    Turn,
    Turns,
    Variational,
    loads_scene,
    validate_scene,
)
from ribbonopt.solution.solution import Solution
from ribbonopt.starts.first_shape import follower_loads, shapes_for
from ribbonopt.starts.unfold import Unfolded

Array = np.ndarray
FRAME = Rotation.from_rotvec([0.4, -1.1, 0.3]).as_matrix()
OTHER = Rotation.from_rotvec([-2.0, 0.5, 1.3]).as_matrix()
PLACE, THERE = np.array([0.3, -0.2, 0.5]), np.array([0.8, 0.4, 1.9])
LENGTH = 2.5
CHORD = Chord((PLACE, FRAME), (THERE, OTHER), LENGTH, bow=0.8, turns=-1.0)
SHAPES: dict[str, Shape] = {
    "helix": Helical(PLACE, FRAME, np.array([0.7, 2.0, -1.5]), LENGTH),
    "straight": Helical(PLACE, FRAME, np.zeros(3), LENGTH),
    "arc": Helical(PLACE, FRAME, np.array([0.0, 1.3, 0.0]), LENGTH),
    "circle": TwistedCircle(PLACE, FRAME, 2 * np.pi, 0.0, LENGTH),
    "moebius": TwistedCircle(PLACE, FRAME, 2 * np.pi, 3 * np.pi, LENGTH),
    "half": TwistedCircle(PLACE, FRAME, np.pi, -np.pi / 2, LENGTH),
    "chord": CHORD,
    "perturbed": Perturbed.at_random(CHORD, 0.5, np.random.default_rng(3)),
}
each_shape = pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
f9 = np.linspace(0, 1, 9)


def axial(matrices: Array) -> Array:
    """Axial vectors (k, 3) of the antisymmetric parts of matrices (k, 3, 3)."""
    A = (matrices - matrices.swapaxes(1, 2)) / 2
    return np.stack([A[:, 2, 1], A[:, 0, 2], A[:, 1, 0]], axis=1)


@each_shape
def test_frames_are_orthonormal_and_right_handed(shape: Shape) -> None:
    R = shape.frames(f9)
    assert R.shape == (9, 3, 3)
    np.testing.assert_allclose(R.swapaxes(1, 2) @ R, np.tile(np.eye(3), (9, 1, 1)), atol=2e-15)
    np.testing.assert_allclose(np.linalg.det(R), 1, atol=1e-14)


@each_shape
def test_strains_are_the_rates_of_the_frames(shape: Shape) -> None:
    # d_i' = u x d_i, eq. (2.2), by differences of order 4.
    f, h = np.linspace(0.1, 0.9, 7), 1e-3
    weights = {-2: 1 / 12, -1: -2 / 3, 1: 2 / 3, 2: -1 / 12}
    rate = sum(w * shape.frames(f + j * h) for j, w in weights.items()) / (h * shape.length)
    expected = axial(shape.frames(f).swapaxes(1, 2) @ rate)
    size = 1 + np.abs(expected).max()
    np.testing.assert_allclose(shape.strains(f), expected, atol=2e-8 * size)


@each_shape
def test_strains_are_finite_up_to_the_ends(shape: Shape) -> None:
    near, ends = shape.strains(np.array([2e-5, 1 - 2e-5])), shape.strains(np.array([0.0, 1.0]))
    np.testing.assert_allclose(ends, near, atol=0.02 * (1 + np.abs(near).max()))


@pytest.mark.parametrize("name", ["helix", "straight", "arc", "circle", "moebius", "half"])
def test_curves_with_tangent_d3(name: str) -> None:
    shape, f, h = SHAPES[name], np.linspace(0.1, 0.9, 7), 1e-3
    weights = {-2: 1 / 12, -1: -2 / 3, 1: 2 / 3, 2: -1 / 12}
    rate = sum(w * shape.positions(f + j * h) for j, w in weights.items()) / (h * shape.length)
    np.testing.assert_allclose(rate, shape.frames(f)[:, :, 2], atol=1e-9)


@pytest.mark.parametrize("name", ["helix", "straight", "arc", "circle", "moebius", "half"])
def test_curves_begin_where_they_are_put(name: str) -> None:
    start = np.zeros(1)
    np.testing.assert_allclose(SHAPES[name].positions(start)[0], PLACE, atol=1e-15)
    np.testing.assert_allclose(SHAPES[name].frames(start)[0], FRAME, atol=1e-15)


def test_a_helix_is_the_solution_of_its_equations() -> None:
    shape = SHAPES["helix"]
    u = np.array([0.7, 2.0, -1.5])

    def rates(_: float, y: Array) -> Array:
        R = y[3:].reshape(3, 3)
        K = np.cross(u, np.eye(3)).T  # K v = u x v
        return np.concatenate([R[:, 2], (R @ K).ravel()])

    y = np.concatenate([PLACE, FRAME.ravel()])
    end = solve_ivp(rates, (0, LENGTH), y, method="DOP853", rtol=1e-12, atol=1e-12).y[:, -1]
    np.testing.assert_allclose(shape.positions(np.ones(1))[0], end[:3], atol=1e-10)
    np.testing.assert_allclose(shape.frames(np.ones(1))[0], end[3:].reshape(3, 3), atol=1e-10)


@pytest.mark.parametrize("size", [1e-12, 1e-9, 1e-6, 1e-3])
def test_nearly_straight_arcs_are_nearly_straight(size: float) -> None:
    shape = Helical(np.zeros(3), np.eye(3), np.array([0.0, size, 0.0]), 1.0)
    expected = [[size / 2, 0, 1 - size**2 / 6]]
    np.testing.assert_allclose(shape.positions(np.ones(1)), expected, atol=2e-8 + size**3)


@pytest.mark.parametrize("name", ["circle", "moebius"])
def test_whole_circles_close(name: str) -> None:
    shape, ends = SHAPES[name], np.array([0.0, 1.0])
    r, R = shape.positions(ends), shape.frames(ends)
    np.testing.assert_allclose(r[1], r[0], atol=1e-14)
    sign = -1 if name == "moebius" else 1
    np.testing.assert_allclose(R[1], R[0] * [sign, sign, 1], atol=1e-14)
    centre = PLACE + LENGTH / (2 * np.pi) * FRAME[:, 0]  # bent towards d1
    off = np.linalg.norm(shape.positions(f9) - centre, axis=1)
    np.testing.assert_allclose(off, LENGTH / (2 * np.pi), atol=1e-14)


@pytest.mark.parametrize("half_twists", [-3, 1, 2, 5])
def test_twisted_circles_twist_by_half_twists(half_twists: int) -> None:
    shape = TwistedCircle(PLACE, FRAME, 2 * np.pi, np.pi * half_twists, LENGTH)
    u = shape.strains(np.linspace(0.1, 0.9, 5))
    np.testing.assert_allclose(u[:, 2], np.pi * half_twists / LENGTH, atol=1e-8)
    np.testing.assert_allclose(np.hypot(u[:, 0], u[:, 1]), 2 * np.pi / LENGTH, atol=1e-8)


rotations = st.integers(0, 10**6).map(lambda seed: Rotation.random(random_state=seed).as_matrix())


@settings(max_examples=40)
@given(rotations, rotations, st.floats(-2, 2), st.integers(-2, 2))
def test_chords_meet_both_ends(first: Array, last: Array, bow: float, turns: int) -> None:
    shape = Chord((PLACE, first), (THERE, last), LENGTH, bow, turns)
    ends = np.array([0.0, 1.0])
    np.testing.assert_allclose(shape.positions(ends), [PLACE, THERE], atol=1e-15)
    np.testing.assert_allclose(shape.frames(ends), [first, last], atol=1e-12)


def test_chords_between_opposite_frames_meet_both_ends() -> None:
    for axis in np.eye(3):
        last = FRAME @ Rotation.from_rotvec(np.pi * axis).as_matrix()
        shape = Chord((PLACE, FRAME), (THERE, last), LENGTH)
        np.testing.assert_allclose(shape.frames(np.array([0.0, 1.0])), [FRAME, last], atol=1e-14)


def test_whole_turns_are_twist_beyond_the_shortest_rotation() -> None:
    last = FRAME @ Rotation.from_rotvec([0, 0, 0.5]).as_matrix()
    for turns in (0, 1, -2):
        u = Chord((PLACE, FRAME), (THERE, last), LENGTH, 0.0, turns).strains(f9[1:-1])
        expected = (0.5 + 2 * np.pi * turns) / LENGTH
        np.testing.assert_allclose(u, np.tile([0, 0, expected], (7, 1)), atol=1e-8)


def test_a_bow_shortens_a_strip_as_a_small_buckle() -> None:
    # chord / length = mean of cos(bow sin) = 1 - bow^2 / 4
    shape = Chord((np.zeros(3), np.eye(3)), (np.array([0, 0, 0.96]), np.eye(3)), 1.0, 0.4)
    d3 = shape.frames(np.linspace(0, 1, 1001))[:, :, 2]
    mean = d3[:-1].mean(axis=0)
    np.testing.assert_allclose(mean, [0, 0, 1 - 0.4**2 / 4], atol=5e-4)
    assert np.abs(d3[:, 1]).max() < 1e-15


def test_straight_chords_are_recognised() -> None:
    end = PLACE + LENGTH * FRAME[:, 2]
    straight = Chord((PLACE, FRAME), (end, FRAME), LENGTH)
    assert straight.straight
    assert not replace(straight, end=(end - 1e-6, FRAME)).straight
    assert not replace(straight, end=(end, OTHER)).straight


@settings(max_examples=40)
@given(st.integers(0, 10**6), st.floats(0.1, 3))
def test_perturbations_leave_the_ends_alone(seed: int, amplitude: float) -> None:
    shape = Perturbed.at_random(CHORD, amplitude, np.random.default_rng(seed))
    ends, middle = np.array([0.0, 1.0]), np.array([0.37])
    np.testing.assert_allclose(shape.positions(ends), [PLACE, THERE], atol=1e-13)
    np.testing.assert_allclose(shape.frames(ends), CHORD.frames(ends), atol=1e-13)
    assert np.abs(shape.positions(middle) - CHORD.positions(middle)).max() > 1e-3 * amplitude
    assert np.abs(shape.frames(middle) - CHORD.frames(middle)).max() > 1e-3 * amplitude
    again = Perturbed.at_random(CHORD, amplitude, np.random.default_rng(seed))
    np.testing.assert_array_equal(again.positions(f9), shape.positions(f9))


@each_shape
def test_a_shape_guess_has_the_moment_of_a_rod_and_no_force(shape: Shape) -> None:
    fields = ShapeGuess(shape).fields(f9)
    u = np.einsum("kij,kj->ki", fields.frames, shape.strains(f9) * [0, 1, 2])
    np.testing.assert_array_equal(fields.n, 0)
    np.testing.assert_allclose(fields.m, u, atol=1e-12)


# What a scene names.

CLAMP = End("clamped", (0, 0, 0), directors="identity")
TILTED = End("clamped", (1, 2, 3), directors=RotationVector((0.0, 0.0, np.pi / 2)))


FREE = End()


def scene(start: End = CLAMP, end: End = FREE, **more: Any) -> Scene:
    loop = more.pop("loop", None)
    also = more.pop("also", ())
    law = more.pop("law", Sadowsky())
    return validate_scene(Scene("s", law, Boundary(start, end, also, loop), **more))


def test_named_shapes_have_the_strains_they_name() -> None:
    two = (0.0, 2.0)
    for guess, u in {
        StrainGuess((4, 2)): (0, 4, 2),
        ArcGuess("pi/2"): (0, np.pi / 4, 0),
        HelixGuess(Helix(3, 0.6)): (0, 3 * np.pi * 0.8, 3 * np.pi * 0.6),
        HelixGuess(Helix(-1, -0.6)): (0, -np.pi * 0.8, np.pi * 0.6),
        "circle": (0, np.pi, 0),
    }.items():
        shape = shape_of(Posed.of(scene(TILTED, guess=guess, interval=two)))
        assert shape is not None
        np.testing.assert_allclose(shape.strains(f9[1:-1]), np.tile(u, (7, 1)), atol=1e-8)
        np.testing.assert_allclose(shape.positions(f9)[0], [1, 2, 3])
        turned = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
        np.testing.assert_allclose(shape.frames(f9)[0], turned, atol=1e-15)


def test_a_named_helix_rises_by_its_share_and_turns_as_often() -> None:
    shape = shape_of(Posed.of(scene(guess=HelixGuess(Helix(3, 0.6)), interval=(0.0, 2.0))))
    assert shape is not None
    ends = np.array([0.0, 1.0])
    r = shape.positions(ends)
    assert np.linalg.norm(r[1] - r[0]) == pytest.approx(0.6 * 2)
    np.testing.assert_allclose(shape.frames(ends)[1], np.eye(3), atol=1e-13)


def test_no_shape_is_named_by_loads_or_by_nothing() -> None:
    assert shape_of(Posed.of(scene())) is None
    assert shape_of(Posed.of(scene(guess=LoadGuess((0, 0, 1), (0, 1, 0))))) is None
    posed = Posed.of(scene())
    assert guess_of(posed, Ribbon.of(posed)) is None


@pytest.mark.parametrize("half_twists", [2, -3, 5])
@pytest.mark.parametrize("piece", ["whole", "half", "fundamental"])
def test_twisted_circles_meet_the_conditions_of_their_loop(half_twists: int, piece: str) -> None:
    count = {"whole": 1, "half": 2, "fundamental": 2 * abs(half_twists)}[piece]
    band = Loop(half_twists, piece)  # type: ignore[arg-type]
    this = scene(End(), loop=band, interval=(0.0, 1 / count))
    guess = MoebiusGuess(Band(half_twists))
    named = shape_of(Posed.of(replace(this, guess=guess)))
    for shape in (named, *shapes_for(Posed.of(this))):
        assert shape is not None
        ends = np.array([0.0, 1.0])
        assert worst(this, shape.positions(ends), shape.frames(ends)) < 1e-14
        # The centre of the circle is where the axes meet.
        if piece == "fundamental":
            np.testing.assert_allclose(
                np.linalg.norm(shape.positions(f9), axis=1), 1 / (2 * np.pi), atol=1e-15
            )


def test_loop_shapes_are_pieces_of_one_circle() -> None:
    x, y, z = (float(v) for v in PLACE)
    d1, d2, d3 = (tuple(column) for column in FRAME.T.tolist())
    start = End(position=(x, y, z), directors=Directors(d1, d2, d3))
    this = scene(start, loop=Loop(3, "half"), interval=(0.0, 0.5))
    shape = loop_shape(Posed.of(this), Loop(3, "half"))
    whole = TwistedCircle(PLACE, FRAME, 2 * np.pi, 3 * np.pi, 1.0)
    np.testing.assert_allclose(shape.positions(f9), whole.positions(f9 / 2), atol=1e-15)
    np.testing.assert_allclose(shape.frames(f9), whole.frames(f9 / 2), atol=1e-14)


def test_every_guess_has_words() -> None:
    guesses = [
        "circle",
        LoadGuess((0, 0, 0), (0, 1, 0)),
        StrainGuess((1, 0)),
        ArcGuess(1),
        HelixGuess(Helix(1, 0.5)),
        MoebiusGuess(Band(1)),
    ]
    assert len({words(guess) for guess in guesses}) == len(guesses)


# Where ends may be.


def worst(this: Scene, r: Array, frames: Array) -> float:
    """Largest verdict on the conditions of positions and directors at given ends."""
    posed = Posed.of(replace(this, states="reduced"))
    ribbon = Ribbon.of(posed)
    zero = np.zeros((2, 3))
    x, _ = ribbon.model.pack(RodFields(r, frames, zero, zero), np.zeros(3))
    a, b = ca.SX.sym("a", 7), ca.SX.sym("b", 7)
    ends = context(ribbon, a, b, ca.SX.zeros(6))
    verdicts = [
        value for c in ribbon.conditions if c.kinematic for value in c.verdicts(ends).values()
    ]
    inputs = [a, b, ca.vertcat(*ribbon.theta.values())]
    function = ca.Function("verdicts", inputs, [ca.vertcat(*verdicts)])
    return float(np.abs(np.array(function(x[0], x[1], posed.values))).max())


HINGE = End("hinged", (0, 0, 0), axis="d2", along=(0, 1, 0))
SIDE = RotationVector((0.0, 1.2, 0.0))
BACK = Turns((Turn(y=np.pi),))
ENDS: dict[str, tuple[End, End, dict[str, Any]]] = {
    "clamped": (CLAMP, End("clamped", (0.2, 0.3, 0.5), directors=SIDE), {}),
    "clamped, turned back": (CLAMP, End("clamped", (0.2, 0.3, 0.5), directors=BACK), {}),
    "free": (CLAMP, End("free"), {}),
    "free start": (End("free"), End("clamped", (1, 2, 3), directors=SIDE), {}),
    "pinned": (CLAMP, End("pinned", (0.5, 0, 0.5)), {}),
    "pinned, both": (End("pinned", (1, 0, 0)), End("pinned", (1, 0.5, 0.5)), {}),
    "pinned start": (End("pinned", (1, 1, 0)), replace(HINGE, position=(0.3, 1, 0.6)), {}),
    "hinged": (HINGE, replace(HINGE, position=(0, 0, 0.7)), {}),
    "hinges at an angle": (HINGE, replace(HINGE, position=(0, 0, 0.7), along=(0, 1, 1)), {}),
    "opposite hinges": (HINGE, replace(HINGE, position=(0, 0, 0.7), along=(0, -1, 0)), {}),
    "hinge against a clamp": (CLAMP, replace(HINGE, position=(0, 0, 0.7), along=(0, -1, 0)), {}),
    "tangents against each other": (CLAMP, End(position=(0.3, 0, 0.1), d3=(0, 0, -1)), {}),
    "normals against each other": (CLAMP, End(position=(0, 0, 0.9), d1=(-1, 0, 0)), {}),
    "sliding": (CLAMP, End("sliding", (0, 0.4, 0), directors=SIDE, along=(1, 1, 1)), {}),
    "sliding start": (
        End("sliding", (1, 0.4, 0), directors=SIDE, along=(1, 1, 1)),
        End("sliding", (0, 0, 0), directors=BACK, along=(0, 0, 1)),
        {},
    ),
    "held": (CLAMP, End("held", distance=0.35), {}),
    "held far": (HINGE, End("held", distance=0.99), {}),
    "held near": (CLAMP, End("held", distance=0.01), {}),
    "flip": (CLAMP, End("flip", (0, 0.2, 0), axis="d2", along=(1, 0, 0)), {}),
    "flips": (
        End("flip", (0, 0, 0), axis="d1", along=(1, 0, 0)),
        End("flip", (0, 0, 0.3), axis="d2", along=(1, 2, 2)),
        {},
    ),
    "flip, opposite": (CLAMP, End("flip", (0, 0, 0), axis="d3", along=(0, 0, -1)), {}),
    "components": (CLAMP, End(position=LabVector(y=0.1), d1=LabVector(x=0), d3=LabVector(x=0)), {}),
    "one director": (CLAMP, End(position=(0.5, 0.1, 0.4), d2=(0.6, 0, 0.8)), {}),
    "also": (CLAMP, End(), {"also": ("norm(r(end) - r(start)) = 0.4", "dot(d3(end), ex) = 1")}),
    "also an angle": (
        HINGE,
        End(position=LabVector(x=0, y=0), d2=(0, 1, 0)),
        {"also": ("dot(d3(start), ez) = cos(1)",)},
    ),
    "also opposite": (CLAMP, End(position=(0, 0, 0.2)), {"also": ("dot(d3(end), ez) = -1",)}),
}


@pytest.mark.parametrize("ends", ENDS)
def test_ends_are_placed_where_all_conditions_on_them_hold(ends: str) -> None:
    start, end, more = ENDS[ends]
    this = scene(start, end, law=Variational(delta=0.1), **more)
    posed = Posed.of(this)
    (r0, first), (r1, last) = place_ends(Ribbon.of(posed), posed)
    for frame in (first, last):
        np.testing.assert_allclose(frame.T @ frame, np.eye(3), atol=1e-12)
        assert np.linalg.det(frame) > 0
    assert worst(this, np.stack([r0, r1]), np.stack([first, last])) < 1e-9
    if "start" not in ends:
        assert np.linalg.norm(r1 - r0) <= 1 + 1e-9  # the ribbon reaches from one to the other


def test_what_is_prescribed_is_taken_as_it_is() -> None:
    this = scene(TILTED, End("clamped", (1, 2, 3.5), directors=SIDE))
    posed = Posed.of(this)
    (r0, first), (r1, last) = place_ends(Ribbon.of(posed), posed)
    np.testing.assert_allclose(r0, [1, 2, 3], atol=1e-14)
    np.testing.assert_allclose(r1, [1, 2, 3.5], atol=1e-14)
    np.testing.assert_allclose(first, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-14)
    np.testing.assert_allclose(last, Rotation.from_rotvec([0, 1.2, 0]).as_matrix(), atol=1e-14)


@pytest.mark.parametrize("free", ["start", "end"])
def test_a_free_end_is_that_of_a_straight_ribbon(free: str) -> None:
    ends = (TILTED, End("free")) if free == "end" else (End("free"), TILTED)
    this = scene(*ends, interval=(0.0, 2.0))
    posed = Posed.of(this)
    (r0, first), (r1, last) = place_ends(Ribbon.of(posed), posed)
    turned = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    np.testing.assert_allclose([first, last], [turned, turned], atol=1e-12)
    np.testing.assert_allclose(r1 - r0, [0, 0, 2], atol=1e-12)


def test_first_shapes_fit_the_ends_they_are_for() -> None:
    start, end, _ = ENDS["clamped"]
    this = scene(start, end)
    shapes = list(shapes_for(Posed.of(this)))
    assert len(shapes) >= 3
    ends = np.array([0.0, 1.0])
    for shape in shapes:
        assert worst(this, shape.positions(ends), shape.frames(ends)) < 1e-12


# Loads to start from.


def test_loads_at_the_start_are_integrated() -> None:
    # The exact helix: constant strains (0, 4, 2) under the loads of SCIENCE.
    this = scene(End(position=(0, 0, 0), directors="identity"))
    posed = Posed.of(this)
    loads = LoadGuess((0, 12.5, 6.25), (0, 3.75, 5))
    fields = IntegratedLoads(Ribbon.of(posed), posed, loads)
    found = fields.fields(np.linspace(0, 1, 41))
    exact = Helical(np.zeros(3), np.eye(3), np.array([0.0, 4.0, 2.0]), 1.0)
    f = np.linspace(0, 1, 41)
    np.testing.assert_allclose(found.r, exact.positions(f), atol=1e-5)
    np.testing.assert_allclose(found.frames, exact.frames(f), atol=1e-4)
    np.testing.assert_allclose(found.n, np.tile([0, 12.5, 6.25], (41, 1)), atol=1e-12)


def test_loads_that_follow_the_end_are_integrated_from_there() -> None:
    force, moment = AnyVector(d1=0, d2=12.5, d3=6.25), AnyVector(d1=0, d2=3.75, d3=5)
    this = scene(TILTED, End("free", force=force, moment=moment))
    guess = follower_loads(Posed.of(this))
    assert isinstance(guess, FollowerLoads)
    f = np.linspace(0, 1, 41)
    found = guess.fields(f)
    frame = Rotation.from_rotvec([0, 0, np.pi / 2]).as_matrix()
    exact = Helical(np.array([1.0, 2, 3]), frame, np.array([0.0, 4.0, 2.0]), 1.0)
    np.testing.assert_allclose(found.r, exact.positions(f), atol=1e-5)
    np.testing.assert_allclose(found.frames, exact.frames(f), atol=1e-4)
    np.testing.assert_allclose(found.m, found.frames @ [0, 3.75, 5], atol=1e-3)


def test_only_loads_that_follow_the_end_of_a_clamped_ribbon_are_known_beforehand() -> None:
    follower = AnyVector(d1=0, d2=1, d3=0)
    assert follower_loads(Posed.of(scene(CLAMP, End("free")))) is None  # nothing to integrate
    assert follower_loads(Posed.of(scene(CLAMP, End("free", force=(0, 0, 1))))) is None  # dead
    both = End("free", force=(0, 0, 1), moment=(0, 1, 0))
    assert follower_loads(Posed.of(scene(CLAMP, both))) is None
    # Without a force the moment is the same all along the ribbon.
    alone = follower_loads(Posed.of(scene(CLAMP, End("free", moment=(0, 1, 0)))))
    assert alone is not None
    np.testing.assert_allclose(alone.fields(np.linspace(0, 1, 5)).m, [[0, 1, 0]] * 5, atol=1e-12)
    assert follower_loads(Posed.of(scene(CLAMP, End("free", moment=follower)))) is not None
    assert follower_loads(Posed.of(scene(End("free", moment=follower), CLAMP))) is None


# Bands unfolded from their fundamental piece.


@pytest.fixture(scope="module", params=[2, -3, 5])
def piece(request: pytest.FixtureRequest) -> Solution:
    k = request.param
    boundary = Boundary(loop=Loop(k, "fundamental"))
    mesh = Collocation(degree=6, intervals=12)
    interval = (0.0, 1 / (2 * abs(k)))
    found = solve(
        Scene("b", Variational(delta=0.1), boundary, interval=interval, transcription=mesh)
    )
    assert found.verified
    return found


def test_an_unfolded_band_is_continuous_and_closes(piece: Solution) -> None:
    loop = piece.scene.boundary.loop
    assert loop is not None
    k = abs(loop.half_twists)
    band = Unfolded(piece, loop.half_twists, 2 * k, PLACE, FRAME)
    joints = np.arange(1, 2 * k) / (2 * k)
    h = 1e-12
    before, after = band.fields(joints - h), band.fields(joints + h)
    for name in ("r", "frames", "n", "m"):
        size = 1 + np.abs(getattr(before, name)).max()
        np.testing.assert_allclose(
            getattr(after, name), getattr(before, name), atol=1e-9 * size, err_msg=name
        )
    ends = band.fields(np.array([0.0, 1.0]))
    np.testing.assert_allclose(ends.r, [PLACE, PLACE], atol=1e-11)
    np.testing.assert_allclose(ends.frames[0], FRAME, atol=1e-12)
    sign = (-1.0) ** k
    np.testing.assert_allclose(ends.frames[1], FRAME * [sign, sign, 1], atol=1e-11)


def test_an_unfolded_band_is_in_equilibrium(piece: Solution) -> None:
    loop = piece.scene.boundary.loop
    assert loop is not None
    k = abs(loop.half_twists)
    band = Unfolded(piece, loop.half_twists, 2 * k, PLACE, FRAME)
    fields = band.fields(np.linspace(0, 1, 24 * k + 1))
    force = np.abs(fields.n).max()
    np.testing.assert_allclose(fields.n, np.tile(fields.n[0], (24 * k + 1, 1)), atol=1e-9 * force)
    # m' = d3 x n, so m - n x r is constant.
    constant = fields.m - np.cross(fields.n, fields.r - PLACE)
    np.testing.assert_allclose(constant, np.tile(constant[0], (24 * k + 1, 1)), atol=1e-9 * force)
    # The tangent is d3, by differences of order 2.
    fine = band.fields(np.linspace(0, 1, 480 * k + 1))
    rate = (fine.r[2:] - fine.r[:-2]) * 240 * k
    np.testing.assert_allclose(rate, fine.frames[1:-1, :, 2], atol=5e-4)
    R = fine.frames
    np.testing.assert_allclose(R.swapaxes(1, 2) @ R, np.tile(np.eye(3), (len(R), 1, 1)), atol=1e-6)


def test_a_part_of_an_unfolded_band_is_its_beginning(piece: Solution) -> None:
    loop = piece.scene.boundary.loop
    assert loop is not None
    k = abs(loop.half_twists)
    half = Unfolded(piece, loop.half_twists, k, PLACE, FRAME).fields(f9)
    whole = Unfolded(piece, loop.half_twists, 2 * k, PLACE, FRAME).fields(f9 / 2)
    np.testing.assert_allclose(half.r, whole.r, atol=1e-12)
    np.testing.assert_allclose(half.m, whole.m, atol=1e-9)


@pytest.mark.parametrize("length", [0.4, 1.0, 3.0])
def test_phases_of_a_guess_are_as_long_as_their_shares_of_the_ribbon(length: float) -> None:
    text = f"""
name: shares
law: {{type: sadowsky}}
interval: [-0.1, {length - 0.1}]
boundary:
  start: {{position: [0, 0, 0], directors: identity}}
  end: {{position: [{0.1 * length}, 0, {0.8 * length}], directors: identity}}
"""
    posed = Posed.of(loads_scene(text))
    structure, ends = Structure.of(posed).in_phases((1, -1, 1)), np.array([0.2, 0.7])
    attempt = structure.attempt(posed, switches=ends)
    shape = Helical(*posed.start, np.array([0.0, 1.0, 0.5]), length)
    _, _, constants = attempt.nlp.layout.unpack(attempt.unknowns(ShapeGuess(shape)))
    names = structure.problem.constant_names
    lengths = [constants[names.index(f"length of phase {i}")] for i in (1, 2)]
    np.testing.assert_allclose(lengths, [0.2 * length, 0.5 * length])
