"""Conditions that end a stage: how far a row is beyond each."""

import pytest

from ribbonopt.scene import ContinuationStage
from ribbonopt.studies.continuation.stops import Stops


@pytest.mark.parametrize(
    ("condition", "margin"),
    [
        ("energy > 30", -5.0),
        ("energy < 30", 5.0),
        ("n0x + 1 > energy / 5", -2.0),
        ("n0x + 1 < energy / 5", 2.0),
        ("20 < energy", 5.0),
        ("abs(n0x) > 1.5", 0.5),
    ],
)
def test_a_condition_is_met_where_it_holds(condition: str, margin: float) -> None:
    stops = Stops(ContinuationStage("law.delta", to=0.1, stop=(condition,)))
    row = {"energy": 25.0, "n0x": 2.0, "note": "", "error": None}
    assert stops.margins(row)[condition] == pytest.approx(margin)
    assert stops.met(row) == (condition if margin > 0 else "")


def test_what_a_row_does_not_know_ends_nothing() -> None:
    stops = Stops(ContinuationStage("law.delta", to=0.1, stop=("error > 0", "other < 1")))
    assert stops.margins({"energy": 25.0, "error": None}) == {}
