"""Half twists of closed bands: writhe of known curves, linking numbers counted independently."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ribbonopt.checks.polygons import crosses_itself, half_twists, writhe
from ribbonopt.checks.topology import (
    ClosedBand,
    closure,
    count_half_twists,
    loop_problems,
)
from ribbonopt.output.summary import summarize
from ribbonopt.pipeline.prepared import prepare
from ribbonopt.scene import Loop, load_scene
from ribbonopt.solution.solution import Solution
from ribbonopt.solvers import Status

Solved = Callable[..., Solution]
Array = np.ndarray
HALVES = ["moebius_half", "moebius_half_full", "moebius_kirchhoff", "moebius_variational"]
#: the reflection y -> -y of the half Moebius ribbon: its conditions are their own image
MIRRORED = "guess={force: [0, -40, 40], moment: [0, 2, 9]}"
THIRD = "interval=[0, 0.16666666666666667]"


def angles(count: int) -> Array:
    return np.linspace(0, 2 * np.pi, count, endpoint=False)


def torus_curve(p: int, q: int, count: int = 800) -> tuple[Array, Array]:
    """Curve that winds p times about z and -q times about the core, and the torus's normals."""
    t = angles(count)
    around = np.stack([np.cos(p * t), np.sin(p * t), 0 * t], axis=1)
    normal = np.cos(q * t)[:, None] * around + np.sin(q * t)[:, None] * [0, 0, 1]
    return 2 * around + 0.8 * normal, normal


def derivative(values: Array) -> Array:
    """Derivative of a periodic function, by its Fourier series."""
    waves = np.fft.fftfreq(len(values), 1 / len(values))[:, None]
    return np.fft.ifft(1j * waves * np.fft.fft(values, axis=0), axis=0).real


def twist_of(r: Array, across: Array) -> float:
    """Turns of the direction `across`, made normal to the curve, about its tangent."""
    tangent = derivative(r)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    d = across - np.sum(across * tangent, axis=1, keepdims=True) * tangent
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    return float(np.sum(np.cross(d, derivative(d)) * tangent)) / len(r)


def linking(first: Array, second: Array) -> float:
    """Gauss's linking integral of two closed polygons, by midpoints."""
    sides = [np.roll(c, -1, axis=0) - c for c in (first, second)]
    middles = [c + side / 2 for c, side in zip((first, second), sides, strict=True)]
    gap = middles[0][:, None] - middles[1][None]
    triple = np.einsum("ijk,ijk->ij", gap, np.cross(sides[0][:, None], sides[1][None]))
    return float(np.sum(triple / np.linalg.norm(gap, axis=2) ** 3)) / (4 * np.pi)


@pytest.mark.parametrize("count", [5, 100, 400])
def test_plane_curves_have_no_writhe(count: int) -> None:
    t = angles(count)
    ellipse = np.stack([2 * np.cos(t), np.sin(t), 0 * t], axis=1)
    tilted = ellipse @ np.linalg.qr([[1.0, 2, 3], [0, 1, 4], [5, 6, 0]])[0]
    assert writhe(ellipse) == pytest.approx(0, abs=1e-12)
    assert writhe(tilted) == pytest.approx(0, abs=1e-4)


@pytest.mark.parametrize(("p", "q"), [(1, 2), (1, 5), (2, 3), (3, 2), (2, -3), (1, -4)])
def test_writhe_and_twist_add_to_the_linking_number(p: int, q: int) -> None:
    # Pushed along the normals of its torus, a (p, q) curve links itself p q times.
    r, normal = torus_curve(p, q)
    assert twist_of(r, normal) + writhe(r) == pytest.approx(-p * q, abs=2e-3)
    assert linking(r, r + 0.3 * normal) == pytest.approx(-p * q, abs=2e-3)
    assert half_twists(twist_of(r, normal), writhe(r))[0] == -2 * p * q


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_mirror_turns_the_sign(axis: int) -> None:
    r, _ = torus_curve(2, 3, 200)
    assert abs(writhe(r)) > 3
    assert writhe(r * np.where(np.arange(3) == axis, -1, 1)) == pytest.approx(-writhe(r))


def test_writhe_is_that_of_the_curve_to_second_order() -> None:
    exact = -6 - twist_of(*torus_curve(2, 3))
    errors = [abs(writhe(torus_curve(2, 3, count)[0]) - exact) for count in (100, 200, 400)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2, abs=0.1)


@pytest.mark.parametrize("k", [-3, -1, 0, 1, 2, 5])
def test_twisted_circles(k: int) -> None:
    t = angles(100)
    circle = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    found, off = half_twists(k / 2, writhe(circle))
    assert found == k
    assert off < 1e-9
    assert half_twists(k / 2 + 0.1, writhe(circle))[1] == pytest.approx(0.2)


def test_what_is_no_number_has_no_half_twists() -> None:
    assert half_twists(0.5, writhe(np.full((9, 3), np.nan))) == (0, float("inf"))


@pytest.mark.parametrize("name", [*HALVES, "moebius_regularized", "moebius_whole"])
def test_moebius_ribbons_have_one(solved: Solved, name: str) -> None:
    assert summarize(solved(name))["half_twists"] == 1


def test_its_image_in_a_mirror_has_minus_one(solved: Solved) -> None:
    image = solved("moebius_half", MIRRORED)
    np.testing.assert_allclose(image.n0, solved("moebius_half").n0 * [1, -1, 1], atol=1e-8)
    assert count_half_twists(image) == -1


@pytest.mark.parametrize("name", ["cantilever", "elastica_clamped", "helix", "helix_clamped"])
def test_open_ribbons_have_none(solved: Solved, name: str) -> None:
    assert closure(solved(name)) is None
    assert summarize(solved(name))["half_twists"] is None


LOOPS = [
    ("moebius_whole", "boundary.loop={half_twists: -3, piece: half}", "interval=[0, 0.5]"),
    ("moebius_whole", "boundary.loop.half_twists=4"),
    ("band_three", THIRD),
    ("band_three", "boundary.loop.half_twists=-3", THIRD),
    ("band_three", "boundary.loop.half_twists=5", "interval=[0, 0.1]"),
]
BANDS = [("moebius_half",), ("moebius_half", MIRRORED), ("moebius_regularized",), *LOOPS]
FIGURE_OF_EIGHT = ("moebius_whole", "boundary.loop.half_twists=2", "law={type: sadowsky}")


@pytest.mark.slow
@pytest.mark.parametrize("loop", BANDS, ids=" ".join)
def test_the_edges_link_the_centre_line_as_often(solved: Solved, loop: tuple[str, ...]) -> None:
    band = closure(solved(*loop))
    assert band is not None
    count, off = band.half_twists()
    assert off < 0.05
    r, d2 = band.line(1200), across(band, 1200)
    # One-sided bands have one edge: twice around, it links the centre line as both edges of others.
    back = np.sign(d2[0] @ d2[-1])
    assert back == (-1) ** count
    for side in (0.02, -0.02):
        edge = np.concatenate([r + side * d2, r + back * side * d2])
        assert linking(r, edge) == pytest.approx(count, abs=0.02)


def across(band: ClosedBand, count: int) -> Array:
    """Director d2 along a closed band, at the points of its line."""
    rows = 2 * -(-count // (2 * band.pieces))
    d2 = band.solution.sample(np.linspace(*band.solution.scene.interval, rows + 1), "d2")
    images = [d2[:-1]]
    if band.flip is not None:
        images.append(continued(images[-1], band.flip.rotate(d2[:0:-1])))
    images = [np.concatenate(images)]
    for _ in range(band.copies - 1):
        images.append(continued(images[-1], images[-1] @ band.turn.T))
    return np.concatenate(images)


def continued(before: Array, image: Array) -> Array:
    """Image of a director under a symmetry that may reverse it, the sign that continues it."""
    return image * np.sign(before[-1] @ image[0])


def test_a_figure_of_eight_has_the_half_twists_that_are_asked(solved: Solved) -> None:
    eight = solved(*FIGURE_OF_EIGHT)
    band = closure(eight)
    assert band is not None
    assert crosses_itself(band.line(200))
    assert count_half_twists(eight) == 2
    assert asked_of(eight, Loop(2)) == asked_of(eight, Loop(-2)) == []
    assert "has 2 half twists, asked were 4" in asked_of(eight, Loop(4))[0]


def test_most_curves_do_not_cross_themselves(solved: Solved) -> None:
    assert not crosses_itself(torus_curve(2, 3, 200)[0])
    assert not crosses_itself(torus_curve(1, 0, 200)[0])
    t = angles(99)
    assert crosses_itself(np.stack([np.sin(t), np.sin(2 * t), 0 * t], axis=1))
    assert crosses_itself(np.stack([np.sin(t), np.sin(2 * t), 1e-7 * np.cos(t)], axis=1))
    assert not crosses_itself(np.stack([np.sin(t), np.sin(2 * t), 1e-3 * np.cos(t)], axis=1))


@pytest.mark.parametrize("loop", LOOPS, ids=" ".join)
def test_loops_have_the_half_twists_that_are_asked(solved: Solved, loop: tuple[str, ...]) -> None:
    found = solved(*loop)
    assert found.scene.boundary.loop is not None
    assert count_half_twists(found) == found.scene.boundary.loop.half_twists


def test_another_number_of_half_twists_is_no_answer(solved: Solved, configs: Path) -> None:
    three = solved("moebius_whole", "boundary.loop.half_twists=3")
    found = prepare(load_scene(configs / "moebius_whole.yaml")).solve(guess=three, fallback=False)
    assert found.status is Status.WRONG_SOLUTION
    assert "the loop has 3 half twists, asked were 1: start from guess" in found.message
    assert "{moebius: {half_twists: 1}}" in found.message
    assert summarize(found)["half_twists"] == 3


def asked_of(solution: Solution, loop: Loop) -> list[str]:
    scene = solution.scene
    boundary = replace(scene.boundary, loop=loop)
    posed = replace(solution.posed, given=replace(scene, boundary=boundary))
    return loop_problems(replace(solution, posed=posed), loop, 1e-9)


@pytest.mark.parametrize("piece", ["whole", "half", "fundamental"])
def test_what_does_not_close_is_no_loop(solved: Solved, piece: str) -> None:
    (problem,) = asked_of(solved("helix_clamped"), Loop(3, piece))
    assert "the loop does not close: it returns (" in problem


def test_a_loop_of_the_other_parity_does_not_close(solved: Solved) -> None:
    assert "directors off by" in asked_of(solved("moebius_whole"), Loop(2))[0]
    assert asked_of(solved("moebius_whole"), Loop(1)) == []


def test_a_sixth_of_a_band_is_no_tenth_of_another(solved: Solved) -> None:
    assert "does not close" in asked_of(solved("band_three", THIRD), Loop(5, "fundamental"))[0]
