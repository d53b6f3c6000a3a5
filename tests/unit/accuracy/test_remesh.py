"""Meshes that share the error evenly, on errors known in closed form."""

import numpy as np
import pytest

from ribbonopt.accuracy.remesh import (
    FARTHEST,
    NARROWEST,
    SIZES,
    UNSEEN,
    WIDEST,
    analyticity,
    graded,
    redistributed,
    size_for,
    wanted_widths,
)

Array = np.ndarray
ORDER = 16


def ellipse(distance: Array, widths: Array) -> Array:
    """Size of the ellipse of elements whose singularity is at a distance beyond one end."""
    x = 1 + 2 * distance / widths
    return np.asarray(x + np.sqrt(x**2 - 1))


def layer(widths: Array, at: float, depth: float) -> tuple[Array, Array]:
    """Sizes rho of a singularity beside s = at, as deep in the complex plane; local errors."""
    nodes = np.append(0.0, np.cumsum(widths))
    beside = np.maximum(np.maximum(nodes[:-1] - at, at - nodes[1:]), 0.0)
    rho = ellipse(np.hypot(beside, depth), widths)
    return rho, rho ** -(ORDER + 1.0)


def improved(widths: Array, rho: Array, local: Array, target: float) -> Array:
    positions, share = graded(widths, wanted_widths(widths, local, rho, ORDER, target))
    return redistributed(positions, share, int(np.ceil(share[-1])))


@pytest.mark.parametrize("depth", [1e-1, 1e-2, 1e-3])
@pytest.mark.parametrize("at", [0.0, 1.0])
def test_a_layer_at_an_end_is_resolved_in_one_step(at: float, depth: float) -> None:
    widths = np.full(12, 1 / 12)
    after = improved(widths, *layer(widths, at, depth), 1e-12)
    assert layer(after, at, depth)[1].max() < 1e-10
    # Elements grow with the distance: few are needed, however thin the layer is.
    assert len(after) < 8 + 6 * np.log2(1 / depth)


@pytest.mark.parametrize("at", [0.0, 0.37, 0.5, 1.0])
def test_a_layer_anywhere_is_resolved_in_a_few_steps(at: float) -> None:
    widths = np.full(12, 1 / 12)
    for _ in range(4):
        widths = improved(widths, *layer(widths, at, 1e-3), 1e-12)
    assert layer(widths, at, 1e-3)[1].max() < 1e-10
    assert len(widths) < 80


def test_a_layer_not_seen_is_looked_for() -> None:
    widths = np.full(10, 0.1)
    local = np.full(10, 1e-16)
    local[-1] = 1e-6
    seen = wanted_widths(widths, local, np.full(10, 30.0), ORDER, 1e-9)
    unseen = wanted_widths(widths, local, np.where(local > 1e-9, UNSEEN, 30.0), ORDER, 1e-9)
    assert unseen[-1] < 0.02 * seen[-1]
    np.testing.assert_array_equal(unseen[:-1], seen[:-1])


@pytest.mark.parametrize("order", [2, 6, 16])
def test_far_from_singularities_widths_follow_the_order(order: int) -> None:
    far = np.full(3, FARTHEST)
    local = np.array([1e-9, 1e-6, 1e-12])
    wanted = wanted_widths(np.full(3, 0.1), local, far, order, 1e-9)
    expected = np.clip((1e-9 / local) ** (1 / (order + 1)), NARROWEST, WIDEST)
    np.testing.assert_allclose(wanted, 0.1 * expected, rtol=1e-3)


@pytest.mark.parametrize("parity", [0, 1])
def test_analyticity_is_read_from_the_decay(parity: int) -> None:
    rho = np.array([1.5, 3.0, 20.0])
    coefficients = 7 * rho[:, None] ** -np.arange(8.0)
    np.testing.assert_allclose(analyticity(coefficients), rho)
    coefficients[:, parity::2] = 0.0
    np.testing.assert_allclose(analyticity(coefficients), rho)


def test_without_coefficients_singularities_are_far() -> None:
    np.testing.assert_array_equal(analyticity(np.ones((4, 3))), FARTHEST)
    np.testing.assert_array_equal(analyticity(np.ones((4, 0))), FARTHEST)
    assert (analyticity(np.zeros((2, 6))) >= 1).all()


def test_what_is_even_stays_so() -> None:
    widths = np.full(7, 1 / 7)
    positions, share = graded(widths, widths)
    assert share[-1] == pytest.approx(7)
    np.testing.assert_allclose(redistributed(positions, share, 7), widths)
    np.testing.assert_allclose(redistributed(positions, share, 14), 1 / 14)


def test_widths_grow_no_faster_than_the_distance() -> None:
    widths = np.full(10, 0.1)
    wanted = widths.copy()
    wanted[-1] = 1e-4
    positions, share = graded(widths, wanted)
    after = redistributed(positions, share, int(np.ceil(share[-1])))
    assert (after[:-1] / after[1:]).max() < 3
    assert after.min() < 2e-4


@pytest.mark.parametrize("local", [np.zeros(5), np.array([0, 0, 1e300, 0, 0]), np.full(5, 1e-30)])
@pytest.mark.parametrize("rho", [UNSEEN, 3.0, FARTHEST])
def test_any_errors_give_a_mesh(local: Array, rho: float) -> None:
    widths = np.full(5, 0.2)
    wanted = wanted_widths(widths, local, np.full(5, rho), 12, 1e-12)
    after = redistributed(*graded(widths, wanted), 9)
    assert (after > 0).all()
    assert after.sum() == pytest.approx(1, abs=1e-14)


def test_sizes_are_few_even_and_cover_what_is_wanted() -> None:
    assert all(size % 2 == 0 for size in SIZES)
    assert list(SIZES) == sorted(set(SIZES))
    for count in range(1, SIZES[-1] + 1):
        size = size_for(count)
        assert size in SIZES
        assert size >= count
        assert not any(count <= other < size for other in SIZES)
    # A step is at most about 1/3, above the smallest.
    ratios = np.array(SIZES[1:]) / np.array(SIZES[:-1])
    assert ratios.max() <= 1.5
    assert size_for(10 * SIZES[-1]) == SIZES[-1]
