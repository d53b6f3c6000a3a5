"""The rows of a shape are those of the ribbon: its geometry, its balance, its energy, its width.

Truth: what is conserved along a ribbon without loads, triangles of the surface, exact outputs.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from ribbonopt.errors import ModelError
from ribbonopt.solution.solution import Solution
from ribbonopt.views.shape import Shape, common_half_width, shape_of
from ribbonopt.views.subject import subject_of

Solved = Callable[..., Solution]
WIDE = ("law={type: wunderlich, width: 0.25}",)
#: a clamped arch with u2 = 0 where u3 is small: eta leaps and is steep beside
ARCH = (
    "law={type: variational, delta: 0.1}",
    "parameters={distance: 0.5, turn: -0.875, away: 0.05}",
    "boundary.start={support: clamped, position: [0, 0, 0], directors: identity}",
    "boundary.end={support: clamped, position: [0, away, distance], "
    "directors: {turns: [{z: turn}]}}",
    "transcription={type: collocation, scheme: gauss, degree: 6, intervals: 10}",
    "tolerance=1e-6",
)
MIRRORED = ("parameters.turn=0.875", "parameters.away=-0.05")
CLOSED = ["moebius_half", "moebius_whole", "band_three", "curved_ring"]


def flips(shape: Shape) -> int:
    """Return how many triangles between the edges do not face as the ribbon does."""
    left, right = shape.points(-1), shape.points(1)
    along = np.diff(shape.s) > 1e-6 * np.ptp(shape.s)
    facing = shape.d1[1:] + shape.d1[:-1]
    count = 0
    for a, b, c in ((left[:-1], right[:-1], left[1:]), (right[:-1], right[1:], left[1:])):
        normals = np.cross(b - a, c - a)  # of length zero where an edge stands still
        sides = np.einsum("ki,ki->k", normals, facing)[along]
        count += int((sides < -1e-9 * np.abs(sides).max()).sum())
    return count


@pytest.mark.parametrize("name", ["moebius_half", "band_three", "curved_ring", "moebius_whole"])
def test_loads_balance_on_what_follows_by_symmetry(solved: Solved, name: str) -> None:
    shape = shape_of(solved(name))
    assert shape.mirrored.any() == (name != "moebius_whole")
    size = np.linalg.norm(shape.n, axis=1).max() + np.linalg.norm(shape.m, axis=1).max()
    assert size > 1
    assert np.ptp(shape.n, axis=0).max() < 1e-7 * size
    assert np.ptp(shape.m + np.cross(shape.r, shape.n), axis=0).max() < 1e-7 * size


def test_moments_do_the_work_of_the_energy_on_images(solved: Solved) -> None:
    """For a law of degree two W = m . u / 2: components along the images of the directors."""
    shape = shape_of(solved("moebius_half", "law={type: sadowsky}"))
    m2, m3 = (np.einsum("ki,ki->k", shape.m, d) for d in (shape.d2, shape.d3))
    np.testing.assert_allclose((m2 * shape.u2 + m3 * shape.u3) / 2, shape.energy, rtol=1e-6)


@pytest.mark.parametrize(("name", "pieces"), [("moebius_half", 2), ("helix", 1)])
def test_the_energy_along_is_that_of_all(solved: Solved, name: str, pieces: int) -> None:
    found = solved(name)
    shape = shape_of(found)
    middle = (shape.energy[1:] + shape.energy[:-1]) / 2
    assert middle @ np.diff(shape.s) == pytest.approx(pieces * found.energy, rel=1e-3)


def test_a_law_without_an_energy_has_none(solved: Solved) -> None:
    assert np.isnan(shape_of(solved("band_three")).energy).all()


@pytest.mark.parametrize("name", ["moebius_half", "moebius_whole", "band_three", "tapered_strip"])
def test_rows_are_those_of_the_solution(solved: Solved, name: str) -> None:
    found = solved(name)
    shape = shape_of(found, complete=False)
    exact = found.outputs(shape.s)
    for quantity in ("r", "d1", "d2", "d3", "n", "m", "u2", "u3"):
        size = np.abs(exact[quantity]).max()
        np.testing.assert_allclose(
            getattr(shape, quantity), exact[quantity], atol=1e-9 * size, err_msg=quantity
        )


@pytest.mark.parametrize("name", ["moebius_whole", "arch"])
def test_pieces_meet_where_bending_changes_sign(solved: Solved, name: str) -> None:
    found = solved("clamped_arch", *ARCH) if name == "arch" else solved(name)
    shape = shape_of(found)
    assert len(shape.starts) > 1
    for start in shape.starts[1:]:
        before, after = shape.s[start - 1], shape.s[start]
        assert 0 < after - before < 4e-9
        u2 = found.outputs(np.array([before, after]))["u2"]
        assert u2[0] * u2[1] < 0
        assert shape.eta[start - 1] * shape.eta[start] < 0


def test_steep_generatrices_beside_a_leap_do_not_make_it_narrow(solved: Solved) -> None:
    found = solved("clamped_arch", *ARCH)
    shape = shape_of(found)
    slopes = np.abs(np.diff(shape.eta))[np.diff(shape.s) > 1e-6] / np.diff(shape.s).max()
    assert slopes.max() > 1 / shape.half_width  # as they are they would cross
    assert shape.half_width > 0.04
    assert flips(shape) == 0
    assert flips(shape_of(found, half_width=1.0)) > 0


@pytest.mark.parametrize("name", [*CLOSED, "helix", "tapered_strip", "ribbon_si"])
def test_no_generatrices_cross(solved: Solved, name: str) -> None:
    shape = shape_of(solved(name))
    assert flips(shape) == 0
    assert shape.half_width >= 0.01 * np.ptp(shape.s)


def test_a_wide_ribbon_has_its_real_width_and_does_not_cross(solved: Solved) -> None:
    shape = shape_of(solved("wunderlich_moebius", *WIDE))
    assert shape.own and shape.half_width == 0.125
    across = shape.points(1) - shape.points(-1)
    np.testing.assert_allclose(np.einsum("ki,ki->k", across, shape.d2), 0.25, rtol=1e-9)
    assert flips(shape) == 0


def test_a_ribbon_in_metres_has_its_real_width(solved: Solved) -> None:
    shape = shape_of(solved("ribbon_si"))
    assert shape.own and shape.units.si
    assert np.ptp(shape.s) == pytest.approx(0.3) and shape.half_width == pytest.approx(0.005)
    assert not shape_of(solved("ribbon_si"), half_width=0.001).own
    assert not shape_of(solved("moebius_half")).own


def test_a_mirror_image_has_the_same_width(solved: Solved) -> None:
    one, other = (shape_of(solved("clamped_arch", *ARCH, *more)) for more in ((), MIRRORED))
    assert abs(one.n[0] @ [1, 0, 0]) > 1e-3
    np.testing.assert_allclose(one.r * [1, -1, 1], other.r, atol=1e-4)
    assert one.half_width == pytest.approx(other.half_width, rel=1e-6)


@pytest.mark.parametrize(
    ("name", "closing"), [("moebius_half", -1), ("curved_ring", 1), ("helix", 0)]
)
def test_it_says_how_it_closes(solved: Solved, name: str, closing: int) -> None:
    shape = shape_of(solved(name))
    assert shape.closing == closing
    if closing:
        np.testing.assert_allclose(shape.points(1)[-1], shape.points(closing)[0], atol=1e-6)


def test_a_rod_has_no_generatrices(solved: Solved) -> None:
    shape = shape_of(solved("twisted_ring"))
    assert shape.rod and not shape.own and (shape.eta == 0).all()
    np.testing.assert_array_equal(shape.b, shape.d2)


def test_more_rows_are_more(solved: Solved) -> None:
    few, many = (len(shape_of(solved("helix"), rows=rows).s) for rows in (60, 600))
    assert 60 <= few < 100 and 600 <= many < 650


@pytest.mark.parametrize("half_width", [0.0, -1.0, float("nan"), float("inf")])
def test_half_width_must_be_a_positive_number(solved: Solved, half_width: float) -> None:
    with pytest.raises(ModelError, match="positive"):
        shape_of(solved("helix"), half_width)


def test_a_common_half_width_is_the_least_but_not_of_one_odd_ribbon(solved: Solved) -> None:
    usual = subject_of(solved("helix"), complete=True)
    (piece,) = usual.solved
    thinner, odd = (
        replace(usual, solved=(replace(piece, eta=np.sin(rate * piece.s)),)) for rate in (20, 90)
    )
    assert common_half_width([usual, usual]) == pytest.approx(0.05)
    assert common_half_width([usual, thinner]) == pytest.approx(0.8 / 20, rel=0.01)
    assert common_half_width([usual] * 4 + [odd]) == pytest.approx(0.025)
    assert common_half_width([solved("ribbon_si")]) == pytest.approx(0.005)
    with pytest.raises(ModelError, match="no ribbon"):
        common_half_width([])


def test_a_result_that_failed_has_a_shape(solved: Solved) -> None:
    found = solved("moebius_half")
    w = found.dense.w.copy()
    w[40:90] = np.nan
    trajectory = replace(found.trajectory, dense=replace(found.dense, w=w), found={})  # type: ignore[type-var]
    shape = shape_of(replace(found, trajectory=trajectory))
    assert shape.half_width == pytest.approx(0.05)
    known = np.isfinite(shape.r).all(axis=1)
    assert 0.3 < known.mean() < 1
