"""Frontiers against every point asked in turn; what is no gain, and what nobody can know."""

from itertools import pairwise

import numpy as np
import pytest

from ribbonopt.studies.comparison.frontier import frontier
from ribbonopt.studies.comparison.rows import PairRow, with_frontiers

Points = list[tuple[float, float]]


def some(seed: int, coarse: bool) -> Points:
    rng = np.random.default_rng(seed)
    points = 10 ** rng.uniform(-3, 0, (rng.integers(0, 40), 2))
    # On a grid there are equals.
    return [tuple(p) for p in (np.round(4 * points) if coarse else points).tolist()]


@pytest.mark.parametrize("coarse", [False, True])
@pytest.mark.parametrize("seed", range(20))
def test_all_that_no_other_beats(seed: int, coarse: bool) -> None:
    points = some(seed, coarse)
    kept = {
        (e, t)
        for e, t in points
        if not any(a <= e and b <= t and (a, b) != (e, t) for a, b in points)
    }
    found = frontier(points, slack=1.0)
    assert {points[i] for i in found} == kept
    assert len(found) == len(kept)  # of equals one


@pytest.mark.parametrize("seed", range(20))
def test_with_slack_every_point_has_one_as_quick_that_is_nearly_as_good(seed: int) -> None:
    points, slack = some(seed, False), 1.5
    found = [points[i] for i in frontier(points, slack)]
    for error, time in points:
        assert any(t <= time and e <= error * slack for e, t in found)
    for (e, t), (finer, slower) in pairwise(found):
        assert finer * slack < e
        assert t <= slower


def row(pair: str, error: float | None, solve: float, verified: bool = True) -> PairRow:
    formulation, states, transcription = pair.split()
    return PairRow(
        *(formulation, states, transcription, 4, 10, 1),
        solve=solve,
        error_n0=error,
        error_m0=error,
        verified=verified,
    )


def test_rows_say_which_frontier_they_are_on() -> None:
    rows = (
        row("inverted reduced gauss", 1e-5, 1.0),
        row("inverted reduced gauss", 1e-4, 2.0),
        row("inverted full gauss", 1e-5, 3.0),
        row("energy reduced gauss", 1e-5, 4.0),
        row("energy reduced gauss", 1e-9, 5.0),
        row("energy reduced gauss", 1e-12, 0.1, verified=False),
        row("energy reduced gauss", None, 0.1),
    )
    marks = [each.frontier for each in with_frontiers(rows)]
    assert marks == ["overall", "", "pair", "formulation", "overall", "", ""]


def test_the_truth_itself_wins_nothing() -> None:
    """Its error is none, and means nothing below what is known of it."""
    rows = (row("inverted reduced gauss", 1e-13, 1.0), row("energy reduced gauss", 0.0, 9.0))
    assert [each.frontier for each in with_frontiers(rows)] == ["overall", "overall"]
    found = with_frontiers(rows, floor=1e-12)
    assert [each.frontier for each in found] == ["overall", "formulation"]
