"""Rows of laws: special points in columns, differences with the bars of both."""

import pytest

from ribbonopt.errors import SceneError
from ribbonopt.studies.laws.branches import bar_of
from ribbonopt.studies.laws.choice import names_of
from ribbonopt.studies.laws.row_gaps import gaps_of, with_special
from ribbonopt.studies.laws.table import barred


def branch(law: str, value: float, error: float | None) -> dict[str, object]:
    point = {"kind": "fold", "parameter": "loads.force.x", "loads.force.x": value, "error": error}
    return with_special({"number": 1, "law": law, "verified": True, "specials": [point]})


def test_special_points_stand_in_columns_with_absolute_bars() -> None:
    row = branch("own", -2.0, 1e-3)
    assert "specials" not in row
    assert (row["special1"], row["special1_kind"]) == (-2.0, "fold")
    assert row["special1_error"] == pytest.approx(2e-3)


@pytest.mark.parametrize(("error", "bar"), [(1e-3, 2e-3 + 2.5e-3), (None, None)])
def test_special_points_are_compared_with_the_bars_of_both(
    error: float | None, bar: float | None
) -> None:
    gaps = gaps_of(branch("sano", -2.5, error), branch("own", -2.0, 1e-3), 1.0)
    assert gaps["special1_gap"] == pytest.approx(-0.5)
    assert gaps["special1_gap_error"] == (None if bar is None else pytest.approx(bar))


def loads(law: str, energy: float, n: float, m: float, error: float) -> dict[str, object]:
    vectors = {"n0x": n, "n0y": 0.0, "n0z": 0.0, "m0x": 0.0, "m0y": m, "m0z": 0.0}
    known = {"verified": True, "energy": energy, "error": error}
    return {"number": 1, "law": law, **known, **vectors}


def test_loads_are_measured_by_the_larger_and_a_force_that_vanishes_by_the_moment() -> None:
    """SI: the unit of length is 0.5, by which a force is a moment."""
    gaps = gaps_of(loads("sano", 3.0, 4.0, 8.0, 1e-3), loads("own", 2.0, 0.0, 4.0, 0.0), 0.5)
    assert gaps["energy_gap"] == pytest.approx(0.5)
    assert gaps["energy_gap_error"] == pytest.approx(3e-3 / 2)
    assert gaps["n0_gap"] == pytest.approx(0.5 * 4.0 / 4.0)
    assert gaps["m0_gap"] == pytest.approx(1.0)
    assert gaps["m0_gap_error"] == pytest.approx(3**0.5 * 8e-3 / 4)


def test_the_own_law_and_what_failed_are_not_compared() -> None:
    own = loads("own", 2.0, 0.0, 4.0, 0.0)
    assert gaps_of(own, own, 1.0) == {}
    assert gaps_of({**loads("sano", 3.0, 4.0, 8.0, 1e-3), "verified": False}, own, 1.0) == {}


def test_bars_of_places_on_a_logarithmic_scale_are_no_decades() -> None:
    decades = 1e-6
    bar = bar_of(300.0, decades, log=True)
    assert bar == pytest.approx(300 * (10**decades - 1), rel=1e-5)
    assert bar_of(-300.0, 1e-6, log=False) == 1e-6
    assert bar_of(300.0, None, log=True) is None


def test_names_of_laws() -> None:
    assert names_of(["all"]) == ("kirchhoff", "sadowsky", "wunderlich", "extensible", "sano")
    assert names_of(["sano", "all", "rod"])[:2] == ("sano", "kirchhoff")
    assert len(names_of(["sano", "all", "rod"])) == 6
    with pytest.raises(SceneError, match="found none"):
        names_of([])


@pytest.mark.parametrize(
    ("value", "bar", "text"),
    [
        (28.72475155692, 9e-12, "28.7247515569 +- 9e-12"),
        (0.0004196580113, 2e-13, "4.19658011e-04 +- 2e-13"),
        (0.5, None, "0.5 +- ?"),
        (None, None, "-"),
    ],
)
def test_numbers_are_written_with_their_bars(
    value: float | None, bar: float | None, text: str
) -> None:
    assert barred(value, bar) == text
