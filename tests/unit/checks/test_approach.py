"""Where a polygon comes nearest to itself, against bounded least squares pair by pair."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from ribbonopt.checks.approach import nearest_approach

Array = np.ndarray
COUNT = 11


def polygon(seed: int, closed: bool) -> Array:
    """Return points at random; every third polygon lies in a plane, where segments may cross."""
    r = np.random.default_rng(seed).normal(size=(COUNT + (not closed), 3))
    return r * [1, 1, seed % 3 > 0]


def least(r: Array, apart: int, closed: bool) -> tuple[float, int, int]:
    """Return the least distance of two segments, and which they are."""
    ends = np.roll(r, -1, axis=0) if closed else r[1:]
    found = []
    for i in range(COUNT):
        for j in range(i + apart, min(COUNT, i + COUNT - apart + 1) if closed else COUNT):
            sides = np.stack([ends[i] - r[i], r[j] - ends[j]], axis=1)
            fit = lsq_linear(sides, r[j] - r[i], bounds=(0, 1), tol=1e-14)
            found.append((float(np.linalg.norm(fit.fun)), i, j))
    return min(found)


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("seed", range(9))
def test_no_two_places_are_nearer(seed: int, closed: bool) -> None:
    r = polygon(seed, closed)
    distance, i, j = least(r, 2, closed)
    found = nearest_approach(r, 10.0, 2 / COUNT, closed)
    assert found is not None
    assert found.distance == pytest.approx(distance, abs=1e-7)
    # The places are those of that distance.
    places = np.array([found.first, found.second]) * COUNT
    corners = np.vstack([r, r[:1]])
    on = [corners[int(p)] + (p - int(p)) * (corners[int(p) + 1] - corners[int(p)]) for p in places]
    assert np.linalg.norm(on[1] - on[0]) == pytest.approx(found.distance, abs=1e-12)
    if distance > 1e-6:  # several may cross
        assert i <= places[0] <= i + 1 and j <= places[1] <= j + 1


def test_what_is_as_far_as_allowed_is_no_approach() -> None:
    r = polygon(1, closed=True)
    distance, *_ = least(r, 2, closed=True)
    assert nearest_approach(r, 0.999 * distance, 2 / COUNT, closed=True) is None
    assert nearest_approach(r, 1.001 * distance, 2 / COUNT, closed=True) is not None
