"""An equilibrium moved as a rigid body, or seen in a mirror, is one: wherever the start is."""

import itertools
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from references import ELASTICA, agrees
from scipy.spatial.transform import Rotation

from ribbonopt.pipeline.prepared import solve
from ribbonopt.scene import (
    Boundary,
    Collocation,
    End,
    Guess,
    Law,
    LoadGuess,
    Quaternion,
    Sadowsky,
    Scene,
    StrainGuess,
    Turn,
    Turns,
    Variational,
)
from ribbonopt.solution.solution import Solution

Array = np.ndarray
WAYS = ("quaternion", "turns", "directors of the lab")
SEEDS = (1, 2)
IDENTITY = np.eye(3)
S = np.linspace(0, 1, 9)


@dataclass(frozen=True)
class Placed:
    """Both ends of a ribbon, as numbers."""

    positions: Array
    frames: Array

    def moved(self, rotation: Array, shift: Array) -> "Placed":
        return Placed(self.positions @ rotation.T + shift, rotation @ self.frames)

    def mirrored(self, mirror: Array) -> "Placed":
        # A mirror makes a right hand left: d2 is turned round, which the law does not see.
        return Placed(self.positions @ mirror.T, (mirror @ self.frames) * [1, -1, 1])


def triple(values: Array) -> tuple[float, float, float]:
    x, y, z = (float(v) for v in values)
    return (x, y, z)


def clamp(position: Array, frame: Array, way: str) -> End:
    place, rotation = triple(position), Rotation.from_matrix(frame)
    if way == "quaternion":
        x, y, z, w = rotation.as_quat().tolist()
        return End("clamped", place, directors=Quaternion((w, x, y, z)))
    if way == "turns":
        a, b, c = rotation.as_euler("ZYX").tolist()
        return End("clamped", place, directors=Turns((Turn(d3=a), Turn(d2=b), Turn(d1=c))))
    return End("clamped", place, d1=triple(frame[:, 0]), d3=triple(frame[:, 2]))


def solved(ends: Placed, law: Law, guess: Guess, way: str = "quaternion") -> Solution:
    start, end = (clamp(*pair, way) for pair in zip(ends.positions, ends.frames, strict=True))
    mesh = Collocation(degree=6, intervals=20)
    found = solve(Scene("somewhere", law, Boundary(start, end), guess, transcription=mesh))
    assert found.verified, found.message
    return found


def motion(seed: int) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    return Rotation.random(random_state=seed).as_matrix(), rng.uniform(-3, 3, 3)


def assert_moved(
    found: Solution, original: Solution, Q: Array, shift: Array, tolerance: float
) -> None:
    """All fields of one solution are those of the other, moved."""
    r = original.sample(S, "r") @ Q.T + shift
    np.testing.assert_allclose(found.sample(S, "r"), r, atol=tolerance)
    for name in ("d1", "d2", "d3"):
        expected = original.sample(S, name) @ Q.T
        np.testing.assert_allclose(found.sample(S, name), expected, atol=10 * tolerance)
    for name in ("n", "m"):
        expected = original.sample(S, name) @ Q.T
        atol = 10 * tolerance * np.linalg.norm(original.n0)
        np.testing.assert_allclose(found.sample(S, name), expected, atol=atol)
    assert found.energy == pytest.approx(original.energy, rel=1e-10)


ELASTIC = Placed(np.array([[0, 0, 0], [0, 0, 0.75]]), np.tile(IDENTITY, (2, 1, 1)))
FORCE, MOMENT = (0.0, 0.0, -45.0), (0.0, 6.5, 0.0)


@cache
def elastica(guess: str) -> Solution:
    return solved(ELASTIC, Sadowsky(), "auto" if guess == "auto" else LoadGuess(FORCE, MOMENT))


def test_the_elastica_is_that_of_the_tables() -> None:
    for guess in ("auto", "loads"):
        found = elastica(guess)
        assert agrees(found.energy, ELASTICA[0.25].energy)
        assert agrees(-float(found.n0[2]), ELASTICA[0.25].force)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("way", WAYS)
def test_the_elastica_is_the_same_elsewhere(way: str, seed: int) -> None:
    Q, shift = motion(seed)
    guess = LoadGuess(triple(Q @ FORCE), triple(Q @ MOMENT))
    found = solved(ELASTIC.moved(Q, shift), Sadowsky(), guess, way)
    assert_moved(found, elastica("loads"), Q, shift, 1e-11)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_elastica_is_found_without_a_guess_elsewhere(seed: int) -> None:
    Q, shift = motion(seed)
    found = solved(ELASTIC.moved(Q, shift), Sadowsky(), "auto", WAYS[seed % 3])
    # It may buckle to either side, and be turned by half a turn about its chord.
    original = elastica("auto")
    flip = np.sign((found.m0 @ Q) @ original.m0)
    assert found.energy == pytest.approx(original.energy, rel=1e-10)
    np.testing.assert_allclose(found.n0, Q @ original.n0, atol=1e-8)
    np.testing.assert_allclose(found.m0, flip * (Q @ original.m0), atol=1e-8)
    r = original.sample(S, "r") * [flip, 1, 1]
    np.testing.assert_allclose(found.sample(S, "r"), r @ Q.T + shift, atol=1e-9)


TURNS = Rotation.from_rotvec([[0.3, -0.2, 0.5], [0.9, 0.8, -0.4]]).as_matrix()
GENERIC = Placed(np.array([[0.1, 0.2, -0.3], [0.4, 0.3, 0.3]]), TURNS)
SMOOTH = Variational(delta=0.1)


@cache
def generic() -> Solution:
    return solved(GENERIC, SMOOTH, "auto")


def guess_from(original: Solution, Q: Array, off: float = 0.98) -> LoadGuess:
    return LoadGuess(triple(off * Q @ original.n0), triple(off * Q @ original.m0))


def test_the_generic_ribbon_has_no_symmetry() -> None:
    loads = np.abs([*generic().n0, *generic().m0])
    assert loads.min() > 0.1
    assert min(abs(a - b) for a, b in itertools.combinations(loads, 2)) > 0.01


@pytest.mark.parametrize("seed", SEEDS)
def test_a_generic_ribbon_is_the_same_elsewhere(seed: int) -> None:
    Q, shift = motion(seed)
    ends = GENERIC.moved(Q, shift)
    found = solved(ends, SMOOTH, guess_from(generic(), Q), WAYS[seed % 3])
    assert_moved(found, generic(), Q, shift, 1e-10)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_generic_ribbon_is_found_without_a_guess_elsewhere(seed: int) -> None:
    Q, shift = motion(seed)
    found = solved(GENERIC.moved(Q, shift), SMOOTH, "auto", WAYS[seed % 3])
    assert_moved(found, generic(), Q, shift, 1e-10)


@pytest.mark.parametrize(("axis", "guess"), [(0, "loads"), (1, "auto"), (2, "loads")])
def test_the_image_in_a_mirror_is_an_equilibrium(axis: int, guess: str) -> None:
    mirror = np.diag([-1.0 if i == axis else 1.0 for i in range(3)])
    original = generic()
    # Forces are mirrored as arrows are, moments as turns: the other way round.
    loads = LoadGuess(triple(mirror @ original.n0), triple(-mirror @ original.m0 * 0.98))
    found = solved(GENERIC.mirrored(mirror), SMOOTH, "auto" if guess == "auto" else loads)
    assert found.energy == pytest.approx(original.energy, rel=1e-10)
    np.testing.assert_allclose(found.n0, mirror @ original.n0, atol=1e-8)
    np.testing.assert_allclose(found.m0, -mirror @ original.m0, atol=1e-8)
    expected = original.sample(S, "r") @ mirror.T
    np.testing.assert_allclose(found.sample(S, "r"), expected, atol=1e-9)
    u, image = original.sample(S, "u"), found.sample(S, "u")
    np.testing.assert_allclose(image, u * [1, 1, -1], atol=1e-8)


@pytest.mark.parametrize("states", ["reduced", "full"])
def test_moments_act_at_the_start_wherever_it_is(states: str) -> None:
    # Far away the moment about the origin of the lab would be of the order of n times the distance.
    Q, shift = motion(5)[0], np.array([100.0, -50.0, 20.0])
    moved = ELASTIC.moved(Q, shift)
    start, end = (clamp(*p, "quaternion") for p in zip(moved.positions, moved.frames, strict=True))
    mesh = Collocation(degree=6, intervals=20)
    scene = Scene("far", Sadowsky(), Boundary(start, end), states=states, transcription=mesh)
    found = solve(replace(scene, guess=guess_from(elastica("loads"), Q)))
    assert found.verified, found.message
    np.testing.assert_allclose(found.m0, Q @ elastica("loads").m0, atol=1e-9)
    np.testing.assert_allclose(found.n0, Q @ elastica("loads").n0, atol=1e-9)


def test_strains_as_a_guess_are_of_the_start_that_is_given() -> None:
    Q, shift = motion(7)
    ends = ELASTIC.moved(Q, shift)
    found = solved(ends, SMOOTH, StrainGuess((1.5, 0.0)))
    assert found.steps[0]["step"] == "guess: constant strains"
    straight = solved(ELASTIC, SMOOTH, StrainGuess((1.5, 0.0)))
    assert_moved(found, straight, Q, shift, 1e-10)
