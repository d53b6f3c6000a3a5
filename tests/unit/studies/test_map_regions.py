"""Regions that lines cut out of the unit square, against areas and neighbours known by hand."""

import numpy as np
import pytest

from ribbonopt.studies.maps.agreement import disagreement
from ribbonopt.studies.maps.inner import distances, innermost
from ribbonopt.studies.maps.lines import PARTS, smooth
from ribbonopt.studies.maps.regions import Region, regions_of

T = np.linspace(0, 1, 30)
ROUND = np.linspace(0, 2 * np.pi, 41)


def slope(begin: float = 0.0, end: float = 1.0) -> np.ndarray:
    """A line from (.5, 0) to (.6, 1), or a part of it."""
    y = begin + (end - begin) * T
    return np.stack([0.5 + 0.1 * y, y], axis=1)


def closed(points: np.ndarray) -> np.ndarray:
    points[-1] = points[0]
    return points


def circle(radius: float, x: float = 0.5) -> np.ndarray:
    return closed(np.stack([x + radius * np.cos(ROUND), 0.5 + radius * np.sin(ROUND)], axis=1))


def areas(regions: list[Region]) -> list[float]:
    return [region.face.area for region in regions]


def test_nothing_is_one_region() -> None:
    (only,) = regions_of([])
    assert only.face.area == 1
    assert np.allclose(only.point, 0.5, atol=1e-3)
    assert only.beside == {}


@pytest.mark.parametrize("ends", [(0.0, 1.0), (0.003, 0.997), (-0.2, 1.3)])
def test_a_line_across_makes_two_regions(ends: tuple[float, float]) -> None:
    regions = regions_of([smooth(slope(*ends))])
    assert np.allclose(areas(regions), [0.55, 0.45], atol=1e-3)
    assert [*regions[0].beside] == [1]
    assert regions[0].beside[1][0] == pytest.approx(np.hypot(1, 0.1), rel=1e-3)


def test_a_line_that_ends_inside_divides_nothing() -> None:
    assert areas(regions_of([smooth(slope(0, 0.5))])) == pytest.approx([1])


def test_a_closed_line_has_an_inside() -> None:
    outer, inner = regions_of([smooth(circle(0.3))])
    assert inner.face.area == pytest.approx(np.pi * 0.09, rel=1e-4)
    assert outer.face.area + inner.face.area == pytest.approx(1, rel=1e-12)
    assert len(outer.face.holes) == 1
    assert [*outer.beside] == [1]
    assert outer.beside[1][0] == pytest.approx(2 * np.pi * 0.3, rel=1e-3)
    assert not outer.face.contains(inner.point[None])[0]


def test_rings_in_each_other() -> None:
    outer, ring, inner = regions_of([smooth(circle(0.3)), smooth(circle(0.09))])
    assert (sorted(outer.beside), sorted(ring.beside), sorted(inner.beside)) == ([1], [0, 2], [1])
    assert inner.face.area == pytest.approx(np.pi * 0.0081, rel=1e-4)


def test_lines_that_cross() -> None:
    regions = regions_of([smooth(circle(0.3)), smooth(np.stack([0.5 + 0 * T, T], axis=1))])
    assert len(regions) == 4
    assert sum(areas(regions)) == pytest.approx(1, rel=1e-12)
    assert all(len(region.beside) == 2 for region in regions)


def test_cusps_are_corners() -> None:
    astroid = closed(np.stack([0.5 + 0.3 * np.cos(ROUND) ** 3, 0.5 + 0.3 * np.sin(ROUND) ** 3], 1))
    outer, inner = regions_of([smooth(astroid, corners=[10, 20, 30])])
    assert inner.face.area == pytest.approx(3 / 8 * np.pi * 0.09, rel=2e-3)
    assert len(outer.face.holes) == 1


def test_a_line_that_crosses_itself() -> None:
    """Between its two cusps a swallowtail encloses a small region of its own."""
    c = np.sqrt(1 / 6)
    t = np.unique([*np.linspace(-1, -c, 30), *np.linspace(-c, c, 30), *np.linspace(c, 1, 30)])
    points = np.stack([0.5 + 0.3 * (4 * t**3 - 2 * t), 0.6 - 0.3 * (3 * t**4 - t**2) * 4], axis=1)
    cusps = [int(np.abs(t - sign * np.sqrt(1 / 6)).argmin()) for sign in (-1, 1)]
    regions = regions_of([smooth(points, cusps)])
    (small,) = [r for r in regions if r.face.contains(np.array([[0.5, 0.52]]))[0]]
    t0 = np.sqrt(0.5)  # x = 0 again
    s = np.linspace(-t0, t0, 20_001)
    x, y = 0.3 * (4 * s**3 - 2 * s), -1.2 * (3 * s**4 - s**2)
    exact = abs(float((x[:-1] * y[1:] - x[1:] * y[:-1]).sum())) / 2
    assert small.face.area == pytest.approx(exact, rel=0.02)


def test_lines_that_lie_close_do_not_cross_between_their_points() -> None:
    """As a fold and a branch point of the mirror arch do, points of which are at other places."""
    a = np.linspace(0.02, 1, 40)
    one = smooth(np.stack([a, a**2], axis=1))
    other = smooth(np.stack([1.006 * a[::3], a[::3] ** 2], axis=1))
    wide = [r for r in regions_of([one, other]) if r.face.area > 1e-5]
    assert len(wide) == 3
    sliver = wide[-1]
    assert sliver.face.area == pytest.approx(0.006 * 2 / 3, rel=0.1)
    assert 0 < sliver.clear < 0.003


def test_a_narrow_region_is_there_and_says_so() -> None:
    thin = [smooth(np.stack([x + 0 * T, T], axis=1)) for x in (0.5, 0.501)]
    regions = regions_of(thin)
    assert [region.narrow for region in regions] == [False, False, True]
    assert regions[-1].face.area == pytest.approx(0.001, rel=1e-9)


def test_an_end_within_reach_of_a_line_ends_there() -> None:
    across = smooth(np.stack([T, 0.5 + 0 * T], axis=1))
    short = smooth(np.stack([0.3 + 0 * T, 0.4975 * T], axis=1))
    assert areas(regions_of([across, short])) == pytest.approx([0.5, 0.35, 0.15], abs=1e-3)


def test_the_same_line_twice_is_as_once() -> None:
    line = smooth(slope())
    assert areas(regions_of([line, line.copy()])) == pytest.approx([0.55, 0.45], abs=1e-6)


def test_innermost_points_are_inside_and_far_from_the_border() -> None:
    for region in regions_of([smooth(circle(0.3)), smooth(slope())]):
        assert region.face.contains(region.point[None])[0]
        assert region.clear == pytest.approx(distances(region.point[None], region.face.sides)[0])
        again, clear = innermost(region.face, region.point[None])
        assert region.face.contains(again[None])[0]
        assert 0 < clear <= region.clear + 1e-9
        assert np.hypot(*(again - region.point)) > clear


def test_smooth_curves_hold_their_points() -> None:
    a = np.linspace(0.1, 0.9, 12)
    points = np.stack([a, np.sin(3 * a) / 2 + 0.5], axis=1)
    curve = smooth(points)
    assert (curve[::PARTS] == points).all()
    assert np.abs(curve[:, 1] - np.sin(3 * curve[:, 0]) / 2 - 0.5).max() < 3e-4


@pytest.mark.parametrize(
    ("kind", "negative", "here", "there", "fits"),
    [
        ("fold", 0, [0, 0, 1], [0], True),
        ("fold", 0, [0, 1], [0], False),  # no stable one has gone
        ("fold", 1, [0, 0, 1, 2], [0, 0], True),
        ("fold", 1, [0, 1, 2], [0, 0], False),  # a stable one has come
        ("branch point", 0, [0, 0, 1], [0], True),
        ("branch point", 1, [0, 1, 1, 2], [1], False),
        ("fold", None, [0], [0, 0, 0], True),  # not known: nothing is said
        ("fold", 0, [None], [0], True),
    ],
)
def test_counts_across_a_locus(
    kind: str, negative: int | None, here: list[int], there: list[int], fits: bool
) -> None:
    rows = [{"shapes": [{"negative": n} for n in found]} for found in (here, there)]
    assert (disagreement(kind, negative, *rows) == "") is fits
    assert (disagreement(kind, negative, *rows[::-1]) == "") is fits
