"""Places where a function changes its sign, against those known in closed form."""

from collections.abc import Callable

import numpy as np
import pytest

from ribbonopt.views.crossings import crossings

Array = np.ndarray
TOLERANCE = 1e-10


def found(function: Callable[[Array], tuple[Array, ...]], *brackets: tuple[float, float]) -> Array:
    a, b = np.array(brackets).T
    return crossings(function, (a, b), function(a)[0] > 0, TOLERANCE)


def counted(function: Callable[[Array], Array]) -> tuple[Callable[[Array], tuple[Array]], list]:
    calls: list[int] = []

    def told(places: Array) -> tuple[Array]:
        calls.append(len(places))
        return (function(places),)

    return told, calls


def test_smooth_ones_are_found_all_at_once_in_a_few_calls() -> None:
    told, calls = counted(lambda s: np.sin(50 * s))
    roots = np.pi * np.arange(1, 5) / 50
    at = found(told, *((root - 0.007, root + 0.011) for root in roots))
    np.testing.assert_allclose(at, roots, atol=TOLERANCE)
    assert len(calls) <= 4


@pytest.mark.parametrize("place", [0.1234567890123, 0.5, 0.10000000001, 0.89999999])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_jump_is_found_as_well(place: float, sign: int) -> None:
    told, calls = counted(lambda s: sign * np.where(s < place, 2.0 + s, -5.0))
    (at,) = found(told, (0.1, 0.9))
    assert abs(at - place) <= TOLERANCE
    assert len(calls) < 20


def test_what_is_smooth_beside_a_jump_tells_where_it_is() -> None:
    place, calls = 0.3141592653, []

    def told(s: Array) -> tuple[Array, Array]:
        calls.append(len(s))
        smooth = (s - place) * (2 + s)
        return np.sign(smooth) * (1 + s), smooth

    (at,) = found(told, (0.3, 0.4))
    assert abs(at - place) <= TOLERANCE
    assert len(calls) <= 4


@pytest.mark.parametrize("power", [3, 5])
def test_a_flat_one_is_found(power: int) -> None:
    told, _ = counted(lambda s: (s - 0.2) ** power)
    (at,) = found(told, (0.1, 0.9))
    assert abs(at - 0.2) <= TOLERANCE


def test_of_several_in_a_bracket_the_first_that_is_seen_is_taken() -> None:
    told, _ = counted(lambda s: (s - 0.2) * (s - 0.5) * (s - 0.8))
    (at,) = found(told, (0.1, 0.9))
    assert min(abs(at - root) for root in (0.2, 0.5, 0.8)) <= TOLERANCE
