"""Bands unfolded from a piece: phases are where m2 of the unfolded band has their signs."""

from collections.abc import Callable

import numpy as np
import pytest

from ribbonopt.solution.solution import Solution
from ribbonopt.starts.unfold import Unfolded

Solved = Callable[..., Solution]


@pytest.mark.parametrize("count", [1, 2, 3, 5, 6])
def test_phases_have_the_signs_of_the_unfolded_moment(solved: Solved, count: int) -> None:
    piece = solved(
        "band_three",
        "law={type: regularized, epsilon: 0.1}",
        "boundary.loop={half_twists: 3, piece: fundamental}",
        "interval=[0, 0.16666666666666666]",
    )
    band = Unfolded(piece, 3, count, np.zeros(3), np.eye(3))
    arcs = band.arcs
    assert arcs is not None
    ends = np.concatenate([[0.0], arcs.switches, [1.0]])
    assert (np.diff(ends) > 0).all() and len(arcs.kinds) == len(ends) - 1
    for kind, a, b in zip(arcs.kinds, ends[:-1], ends[1:], strict=True):
        fields = band.fields(a + (b - a) * np.linspace(0.1, 0.9, 9))
        m2 = np.einsum("ki,ki->k", fields.m, fields.frames[:, :, 1])
        np.testing.assert_array_equal(np.sign(m2), kind)
