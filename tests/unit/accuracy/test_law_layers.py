"""Layers of a law: where its strains are singular near the ribbon, and what elements see."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ribbonopt.accuracy.layers import Layers, clear_of, layers, overlooked, seen
from ribbonopt.solution.solution import Solution

Array = np.ndarray
Solved = Callable[..., Solution]
DEGREE, ORDER = 6, 12


def one(place: complex, size: float = 1.0) -> Layers:
    return Layers(np.array([place]), np.array([size]))


def test_an_element_over_a_layer_is_overlooked_until_it_is_as_narrow() -> None:
    found = one(0.5 + 1e-3j)
    missed = [found.overlooked(np.linspace(0, 1, n + 1), DEGREE, ORDER).max() for n in (3, 31, 901)]
    assert missed[0] > missed[1] > 0
    assert missed[2] == 0


def test_only_elements_near_a_layer_overlook_it() -> None:
    missed = one(0.5 + 1e-3j).overlooked(np.linspace(0, 1, 12), DEGREE, ORDER)
    np.testing.assert_array_equal(np.flatnonzero(missed), [5])


@pytest.mark.parametrize("depth", [1e-3, 1e-5, 1e-7])
def test_stepping_over_a_layer_costs_what_a_step_costs_however_thin(depth: float) -> None:
    """Strains that change at once by one: the error of Gauss quadrature is about its weight."""
    nodes, places = np.linspace(0, 1, 11), np.linspace(0.501, 0.599, 29)
    t, weights = np.polynomial.legendre.leggauss(DEGREE)
    t, weights = 0.5 + 0.1 * (1 + t) / 2, 0.1 * weights / 2
    true = [abs(weights @ (t > at) - (0.6 - at)) for at in places]
    told = [one(at + 1j * depth).overlooked(nodes, DEGREE, ORDER)[5] for at in places]
    assert max(true) / 5 < min(told) and max(told) < 5 * max(true)


@pytest.mark.parametrize("size", [1e-2, 3e-2])
def test_layers_beyond_either_end_are_seen_alike(size: float) -> None:
    """A ribbon read from its other end is the same, and so is what lies beyond its ends."""
    stages = (np.arange(40) + 0.5) / 40
    seen = []
    for beyond in (-size / 4, 1 + size / 4):
        values = stages - beyond
        rows = np.stack([values, np.full(40, 1e-4), np.ones(40), np.zeros(40)], axis=1)[:, None]
        phases = np.zeros(40, int)
        trajectory: Any = SimpleNamespace(
            dense=SimpleNamespace(
                blocks=SimpleNamespace(layout=SimpleNamespace(stages=4)),
            ),
            nodes_within=(np.linspace(0, 1, 11),),
            singular_at_stages=lambda _, rows=rows: rows,
            ends=np.array([0.0, 1.0]),
            stages=(None, stages, None, phases),
        )
        found = layers(trajectory, 0)
        assert len(found)
        np.testing.assert_allclose(found.places.real, beyond, atol=1e-12)
        np.testing.assert_allclose(np.abs(found.places.imag), 1e-4, atol=1e-12)
        seen.append(len(found))
    assert seen[0] == seen[1]


def test_what_does_not_change_strains_is_not_missed() -> None:
    assert one(0.5 + 1e-3j, 0.0).overlooked(np.array([0.0, 1.0]), DEGREE, ORDER).max() == 0


@pytest.mark.parametrize("place", [0.4 + 1e-3j, 1.0 + 1e-5 + 0j, -2e-4 + 1e-4j])
def test_widths_that_are_allowed_see_the_layer(place: complex) -> None:
    """The ellipse through a singularity above the middle of an element has this size."""
    found = one(place)
    middle = np.clip(place.real, 0, 1)
    (width,) = found.widths(np.array([middle]), DEGREE, ORDER, 1e-6)
    distance = abs(middle - place)
    rho = 2 * distance / width + np.sqrt((2 * distance / width) ** 2 + 1)
    assert rho >= seen(DEGREE) * (1 - 1e-9)
    assert (rho > seen(DEGREE) * 1.01) == ((place.imag / 1e-6) ** (1 / 13) > seen(DEGREE) * 1.01)


CLAMP = "{support: clamped, position: [0.3, 0.06, 0.9], directors: {turns: [{y: -0.6}, {z: 0.5}]}}"


@pytest.mark.parametrize("law", ["{type: variational, delta: 0.01}"])
def test_a_sign_change_has_its_layer_where_the_moments_say(solved: Solved, law: str) -> None:
    """Q = 0 at m2 = +-i delta m3: beside the change by delta |m3 / m2'|."""
    found = solved("clamped_twist", f"law={law}", f"boundary.end={CLAMP}", "tolerance=1e-4")
    s = np.linspace(0, 1, 20001)
    m2, m3 = (found.sample(s, name) for name in ("m2", "m3"))
    changes = np.flatnonzero(np.sign(m2[1:]) != np.sign(m2[:-1]))
    assert len(changes)
    near = layers(found.trajectory, 0).places
    for i in changes:
        width = 0.01 * abs(m3[i] / np.gradient(m2, s)[i])
        gap = np.abs(near - (s[i] + 1j * width))
        gap = np.minimum(gap, np.abs(near - (s[i] - 1j * width)))
        assert gap.min() < 0.1 * width + 1e-4


def test_a_smooth_ribbon_has_none(solved: Solved) -> None:
    found = solved("moebius_half")
    near = tuple(layers(found.trajectory, i) for i in range(len(found.problem.phases)))
    assert overlooked(found.trajectory, near).max() == 0
    assert clear_of(found.trajectory, near, 1e-3)(np.linspace(0, 1, 5)).all()


def test_thin_layers_are_set_apart_where_they_show(solved: Solved) -> None:
    found = solved("moebius_half")
    clear = clear_of(found.trajectory, (one(0.5 + 1e-8j),), 1e-4)
    apart = ~clear(np.array([0.49, 0.5 - 1e-5, 0.5, 0.5 + 2e-6, 0.51]))
    assert apart.tolist() == [False, False, True, True, False]


def test_a_law_without_a_layer_is_singular_nowhere(solved: Solved) -> None:
    found = solved("moebius_kirchhoff")
    assert len(layers(found.trajectory, 0)) == 0


def test_a_jump_is_the_business_of_its_own_element() -> None:
    jump = Layers(np.array([0.42 + 0j]), np.array([2.0]), jumps=np.array([True]))
    missed = jump.overlooked(np.linspace(0, 1, 11), degree=6, order=12)
    assert np.flatnonzero(missed).tolist() == [4]
    # A tenth of the jump, times the width over which it is: what moving it by that would cost.
    assert 0 < missed[4] <= 0.1 * 2.0 * 0.1
    widths = jump.widths(np.array([0.0, 0.32, 0.42]), degree=6, order=12, target=1e-4)
    np.testing.assert_allclose(widths, [0.42, 0.1, 1e-4 / (0.1 * 2.0)])
