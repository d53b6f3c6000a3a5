"""Strips of which a half is solved, as half a turn maps their clamps to each other.

Truth: the whole strip, solved without its symmetry, and re-integrated independently; the published
threshold at which the symmetric arch is no longer stable.
"""

from dataclasses import replace

import numpy as np
import pytest
from independent.confirm import confirm
from scipy.spatial.transform import Rotation

from ribbonopt.checks.stability import second_variation
from ribbonopt.errors import ModelError
from ribbonopt.pipeline.check import check_scene
from ribbonopt.pipeline.prepared import prepare, solve
from ribbonopt.problem import Posed
from ribbonopt.scene import (
    Boundary,
    Directors,
    End,
    LoadGuess,
    Sadowsky,
    Scene,
    Variational,
    loads_scene,
)
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.views.subject import subject_of

ARCH = """
name: arch
law: {type: kirchhoff, B2: 1, B3: 1.3333333333333333}
parameters: {shear: 0.16, turn: 0}
symmetric: d1
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 1.25*shear, 0.6875], directors: {turns: [{z: turn}]}}
guess: {force: [0, 15.8, -38.6], moment: [-9.4, 5.2, 6.7]}
tolerance: 1e-9
"""


def arch(*changes: str) -> Scene:
    return loads_scene(ARCH, overrides=list(changes))


def solved(scene: Scene) -> Solution:
    found = solve(scene)
    assert found.verified, found.message
    return found


def test_half_and_its_image_are_the_whole_arch() -> None:
    half, whole = solved(arch()), solved(arch("symmetric=false"))
    assert half.scene.interval == (0.0, 0.5) and whole.scene.interval == (0.0, 1.0)
    assert 2 * half.energy == pytest.approx(whole.energy, rel=1e-9)
    np.testing.assert_allclose(half.n0, whole.n0, atol=1e-6)
    np.testing.assert_allclose(half.m0, whole.m0, atol=1e-6)
    assert confirm(half) < 1e-9
    subject = subject_of(half, complete=True)
    assert subject.count == 2 and subject.mirrored
    for piece in subject.pieces:
        inside = piece.s[1:-1]
        for name in ("r", "d1", "d2", "d3"):
            expected = whole.sample(inside, name)
            np.testing.assert_allclose(getattr(piece, name)[1:-1], expected, atol=1e-7)
        np.testing.assert_allclose(piece.u2[1:-1], whole.sample(inside, "u2"), atol=1e-6)
        np.testing.assert_allclose(piece.u3[1:-1], whole.sample(inside, "u3"), atol=1e-6)


def test_stability_of_a_half_is_told_as_that_of_symmetric_disturbances() -> None:
    # Beyond Y / l = .2922, shear .2338, the whole arch leans to a side; its half knows of none.
    found = [
        second_variation(solved(arch("parameters.shear=0.25", f"symmetric={symmetric}")))
        for symmetric in ("d1", "false")
    ]
    half, whole = found
    assert not isinstance(half, str) and not isinstance(whole, str)
    assert (half.negative, whole.negative) == (0, 1)
    assert half.verdict == "stable among disturbances with its symmetry"
    assert whole.verdict == "unstable, 1 direction"


def test_the_width_along_the_axis_bends_a_strip_to_an_s() -> None:
    s_shape = ("parameters.shear=0", "guess=auto")
    half = solved(arch("symmetric=d2", *s_shape))
    force, moment = half.n0.tolist(), half.m0.tolist()
    guess = f"guess={{force: {force}, moment: {moment}}}"
    whole = solved(arch("symmetric=false", "parameters.shear=0", guess))
    assert 2 * half.energy == pytest.approx(whole.energy, rel=1e-9)
    assert abs(float(whole.sample(0.5, "r")[0])) < 1e-9  # level with the clamps
    arched = solved(arch("symmetric=d1", *s_shape))
    assert arched.energy < half.energy
    with pytest.raises(ModelError, match="two axes"):
        prepare(arch("symmetric=true", *s_shape))


def test_a_branch_of_symmetric_arches_passes_the_threshold() -> None:
    along = "continuation={parameter: parameters.shear, from: 0.16, to: 0.3, largest: 0.2}"
    points = list(Continuation(arch(along)))
    assert {point.kind for point in points} == {"point"} and points[-1].position == 0.3
    whole = solved(arch("symmetric=false", "parameters.shear=0.3"))
    assert 2 * points[-1].row["energy"] == pytest.approx(whole.energy, rel=1e-8)


def between_clamps(seed: int, director: str) -> Scene:
    """Return a strip between clamps at random places that half a turn maps to each other."""
    rng = np.random.default_rng(seed)
    axis, across, chord = np.linalg.qr(rng.normal(size=(3, 3)))[0].T
    turn = 2 * np.outer(axis, axis) - np.eye(3)
    width = axis if director == "d2" else np.cross(chord, axis)
    middle = np.stack([np.cross(width, chord), width, chord], axis=1)
    first = Rotation.from_rotvec(0.5 * rng.normal(size=3)).as_matrix() @ middle
    last = turn @ first * ([1, -1, -1] if director == "d1" else [-1, 1, -1])
    start = rng.normal(size=3)
    ends = (start, start + 0.7 * chord + 0.1 * across)
    clamps = [
        End("clamped", tuple(r), Directors(d1=tuple(F[:, 0]), d2=tuple(F[:, 1])))
        for r, F in zip(ends, (first, last), strict=True)
    ]
    law = Sadowsky() if director == "d2" else Variational(delta=0.1)
    return Scene("strip", law, Boundary(*clamps), tolerance=1e-8, symmetric=director)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("seed", "director"),
    [
        (2, "d1"),
        pytest.param(1, "d2", marks=pytest.mark.slow),
        pytest.param(3, "d2", marks=pytest.mark.slow),
        pytest.param(4, "d1", marks=pytest.mark.slow),
    ],
)
def test_from_half_a_strip_the_whole_is_found_at_once(seed: int, director: str) -> None:
    scene = between_clamps(seed, director)
    half = solved(scene)
    assert confirm(half) < 1e-8
    n, m = (tuple(v.tolist()) for v in (half.n0, half.m0))
    whole = solved(replace(scene, symmetric=False, guess=LoadGuess(n, m)))  # type: ignore[arg-type]
    assert whole.scene.interval == (0.0, 1.0)
    assert 2 * half.energy == pytest.approx(whole.energy, rel=1e-8)
    size = np.abs(whole.n0).max()
    np.testing.assert_allclose(half.n0, whole.n0, atol=1e-7 * size)


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        (("parameters.turn=0.2", "parameters.shear=0.16"), "half a turn"),
        (("boundary.end.position=[0.1, 0.2, 0.7]",), "does not map the ends"),
        (("loads.force={z: -1}",), "between the ends"),
        (("width=1 - 0.2*s",), "vary along"),
        (("natural.curvature=1", "symmetric=d2", "parameters.shear=0"), "natural strains"),
        (("boundary.end={support: pinned, position: [0, 0, 0.7]}",), "no clamp"),
        (("guess={solution: nowhere}",), "guess"),
        (("continuation={parameter: parameters.turn, from: 0, to: 0.3}",), "continuation"),
    ],
)
def test_what_breaks_it_is_said(changes: tuple[str, ...], why: str) -> None:
    with pytest.raises(ModelError, match=why) as caught:
        Posed.of(arch(*changes))
    assert caught.value.key == "symmetric"


def test_check_says_that_it_could_be() -> None:
    assert any("symmetric: d1" in hint for hint in check_scene(arch("symmetric=false"))["hints"])
    assert not check_scene(arch())["hints"]
    assert not check_scene(arch("symmetric=false", "loads.force={z: -1}"))["hints"]
