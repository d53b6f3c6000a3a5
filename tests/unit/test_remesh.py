"""Meshes that share the error evenly, on errors known in closed form."""

import numpy as np
import pytest

from ribbonopt.accuracy.remesh import SIZES, elements_for, redistributed, size_for

Array = np.ndarray


def layer_errors(widths: Array, order: int, rate: float = 100.0) -> Array:
    """Local errors h^(order + 1) of elements whose h is measured in layers: one is at 0.3."""
    nodes = np.concatenate([[0.0], np.cumsum(widths)])
    stretched = nodes + 2 * np.arctan(rate * (nodes - 0.3)) / np.pi
    return np.diff(stretched) ** (order + 1)


@pytest.mark.parametrize("order", [2, 6, 12])
@pytest.mark.parametrize("count", [8, 20, 41])
def test_a_layer_is_shared_evenly(order: int, count: int) -> None:
    widths = np.full(20, 1 / 20)
    before = layer_errors(np.full(count, 1 / count), order)
    for _ in range(8):
        widths = redistributed(widths, layer_errors(widths, order), order, count)
    assert widths.shape == (count,)
    assert (widths > 0).all()
    assert widths.sum() == pytest.approx(1, abs=1e-14)
    after = layer_errors(widths, order)
    # The largest local error is most of the error.
    assert after.max() < 0.5 * before.max()
    monitors = after ** (1 / (order + 1))
    assert monitors.max() < 3 * monitors.mean()
    nodes = np.concatenate([[0.0], np.cumsum(widths)])
    assert abs(nodes[widths.argmin()] - 0.3) < 0.05


@pytest.mark.parametrize("order", [2, 6, 16])
def test_even_errors_leave_the_mesh_as_it_is(order: int) -> None:
    widths = np.array([0.1, 0.2, 0.05, 0.25, 0.1, 0.3])
    again = redistributed(widths, np.full(6, 1e-5), order, 6)
    # Elements next to much narrower ones may be narrowed: neighbours alike.
    assert again.sum() == pytest.approx(1, abs=1e-14)
    uniform = redistributed(np.full(7, 1 / 7), np.full(7, 1e-5), order, 7)
    np.testing.assert_allclose(uniform, 1 / 7, rtol=1e-12)
    np.testing.assert_allclose(redistributed(uniform, np.full(7, 1e-5), order, 14), 1 / 14)


@pytest.mark.parametrize("local", [np.zeros(5), np.array([0, 0, 1e300, 0, 0]), np.full(5, 1e-30)])
def test_any_errors_give_a_mesh(local: Array) -> None:
    widths = redistributed(np.full(5, 0.2), local, 12, 9)
    assert (widths > 0).all()
    assert widths.sum() == pytest.approx(1, abs=1e-14)


def test_fractions_need_not_sum_to_one_before() -> None:
    # lengths of phases are in the widths of none: relative widths only
    local = np.array([1e-9, 1e-4, 1e-9, 1e-9])
    one = redistributed(np.full(4, 0.25), local, 6, 6)
    np.testing.assert_allclose(redistributed(np.full(4, 2.5), local, 6, 6), one, rtol=1e-12)


@pytest.mark.parametrize("order", [1, 6, 12])
@pytest.mark.parametrize("reduction", [1e-1, 1e-4, 1e-8])
def test_elements_for_equal_errors_follow_the_order(order: int, reduction: float) -> None:
    # n elements of error C h^(order + 1): the sum goes like n^-order
    count = 10
    wanted = elements_for(np.full(count, 1e-6), order, reduction)
    assert wanted == pytest.approx(count * reduction ** (-1 / order), abs=1.001)
    assert wanted >= count * reduction ** (-1 / order) * (1 - 1e-12)


def test_fewer_elements_where_more_error_is_allowed() -> None:
    assert elements_for(np.full(40, 1e-9), 6, 64.0) == pytest.approx(20, abs=1)


def test_one_bad_element_needs_few_more() -> None:
    # it alone is what there is to divide
    local = np.full(20, 1e-16)
    local[7] = 1e-6
    assert elements_for(local, 6, 1e-3) < elements_for(np.full(20, 1e-6), 6, 1e-3)


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
