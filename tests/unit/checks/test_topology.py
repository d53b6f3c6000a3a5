"""What the count of half twists costs, and when it is none."""

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ribbonopt.checks import topology
from ribbonopt.checks.flip import find_flip
from ribbonopt.checks.topology import ClosedBand, closure, count_half_twists
from ribbonopt.mechanics.loads.catalogue import loads_of
from ribbonopt.scene import Loads
from ribbonopt.solution.solution import Solution

Array = np.ndarray
Solved = Callable[..., Solution]


def pairs_for(band: Solution, monkeypatch: pytest.MonkeyPatch) -> int:
    """Count the pairs of points that the half twists of a band are found from."""
    looked_at: list[int] = []
    writhe = topology.writhe

    def counted(r: Array) -> float:
        looked_at.append(len(r) ** 2)
        return writhe(r)

    with monkeypatch.context() as patch:
        patch.setattr(topology, "writhe", counted)
        assert count_half_twists(band) is not None
    return sum(looked_at)


def test_a_simple_band_is_counted_from_few_points(
    solved: Solved, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every solve of a loop pays for it: what all pairs of 100 points tell takes no more."""
    assert pairs_for(solved("moebius_half"), monkeypatch) <= 100**2 + 50**2


def test_points_are_added_until_the_writhe_is_stable(
    solved: Solved, monkeypatch: pytest.MonkeyPatch
) -> None:
    simple = pairs_for(solved("moebius_half"), monkeypatch)
    monkeypatch.setattr(topology, "STABLE", 1e-5)
    assert 10 * simple < pairs_for(solved("moebius_half"), monkeypatch) < 100 * simple


def test_what_is_far_from_a_whole_number_is_no_count(
    solved: Solved, monkeypatch: pytest.MonkeyPatch
) -> None:
    band, twist = solved("moebius_half"), ClosedBand.twist
    for off, count in ((0.02, 1), (0.2, None)):
        more = property(lambda self, off=off: twist.__get__(self) + off / 2)
        with monkeypatch.context() as patch:
            patch.setattr(ClosedBand, "twist", more)
            assert count_half_twists(band) == count


@pytest.mark.parametrize("load", ["n", "m"])
def test_a_half_that_is_loaded_along_its_axis_is_none(solved: Solved, load: str) -> None:
    """A flip reverses what is along its axis: neither force nor moment would go on."""
    half = solved("moebius_half")
    flip = find_flip(half)
    assert flip is not None

    values = half.at_nodes[load]
    more = values + 1e-3 * np.abs(values).max() * flip.axis
    loaded: Any = SimpleNamespace(scene=half.scene, at_nodes=dict(half.at_nodes))
    assert find_flip(loaded) is not None
    loaded.at_nodes[load] = more
    assert find_flip(loaded) is None


def test_a_half_under_a_load_between_its_ends_is_none(solved: Solved) -> None:
    half = solved("moebius_half")
    assert closure(half) is not None
    heavy = loads_of(replace(half.scene, loads=Loads(force=(0, 0, -1))))
    assert closure(replace(half, posed=replace(half.posed, loads=heavy))) is None


def test_a_doubtful_count_follows_the_line_exactly(
    solved: Solved, monkeypatch: pytest.MonkeyPatch
) -> None:
    band = closure(solved("moebius_half"))
    assert band is not None
    looked_at: list[bool] = []
    line = ClosedBand.line

    def counted(band: ClosedBand, count: int, *, quick: bool = False) -> Array:
        looked_at.append(quick)
        return line(band, count, quick=quick)

    monkeypatch.setattr(ClosedBand, "line", counted)
    for asked, clear, expected in (
        (1, topology.CLEAR, [True]),
        (None, topology.CLEAR, [True]),
        (3, topology.CLEAR, [True, False]),
        (1, 1e-9, [True, False]),
    ):
        monkeypatch.setattr(topology, "CLEAR", clear)
        looked_at.clear()
        assert band.half_twists(asked)[0] == 1
        assert looked_at == expected


def test_the_quick_line_is_near_the_exact_one(solved: Solved) -> None:
    for name in ("moebius_half", "band_three", "ribbon_si"):
        found = solved(name)
        band = ClosedBand(found, np.zeros(3), 0.0)
        exact, quick = band.line(60), band.line(60, quick=True)
        length = found.units.length
        np.testing.assert_allclose(exact[0], found.at_nodes["r"][0], atol=1e-14 * length)
        np.testing.assert_allclose(quick, exact, rtol=0, atol=1e-4 * length)
        assert np.abs(quick - exact).max() > 0
