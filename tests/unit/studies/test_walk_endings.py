"""How the walk ends a branch: at conditions, at special points, closed, idle; each branch once.

Curves with closed forms, as in `test_walk`.
"""

from collections.abc import Callable

import numpy as np
import pytest
from dense_curves import Dense, Plain, Straight
from walks import Run, run, stage

from ribbonopt.studies.continuation.walk.metric import Metric
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, FOLD, POINT
from ribbonopt.studies.continuation.walk.walk import Ending

Array = np.ndarray
CIRCLE = Dense(lambda z: np.array([z @ z - 1]), lambda z: 2 * z[None, :], Metric(np.ones(2)))
# x = 0, and a circle that crosses it at l = -1 and l = 1
RING = Dense(
    lambda z: np.array([z[0] * (z @ z - 1)]),
    lambda z: np.array([[z @ z - 1 + 2 * z[0] ** 2, 2 * z[0] * z[1]]]),
    Metric(np.ones(2)),
)
# [x, y, l]: a pitchfork x^2 = l, and one on its half of x > 0, y^2 = x - 1
TWICE = Dense(
    lambda z: np.array([z[0] * (z[2] - z[0] ** 2), z[1] * (z[0] - 1 - z[1] ** 2)]),
    lambda z: np.array(
        [[z[2] - 3 * z[0] ** 2, 0, z[0]], [z[1], z[0] - 1 - 3 * z[1] ** 2, 0]], dtype=float
    ),
    Metric(np.ones(3)),
)

# conditions that are met exactly


@pytest.mark.parametrize("largest", [0.05, 0.2, 0.7])
@pytest.mark.parametrize(
    ("beyond", "where"),
    [
        (lambda z: z[1] - 0.55, (np.sqrt(1 - 0.55**2), 0.55)),
        (lambda z: 0.3 - z[0], (0.3, np.sqrt(1 - 0.09))),
        (lambda z: -0.2 - z[0], (-0.2, np.sqrt(1 - 0.04))),  # beyond the fold
        (lambda z: 1e6 * (0.5 - z[0]) ** 3, (0.5, np.sqrt(0.75))),  # flat there
        (lambda z: 1.0 if z[0] < 0.4 else -1.0, (0.4, np.sqrt(1 - 0.16))),  # jumps there
    ],
    ids=["position", "unknown", "after a fold", "flat", "jump"],
)
def test_the_last_point_is_where_a_condition_begins(
    beyond: Callable[[Array], float], where: tuple[float, float], largest: float
) -> None:
    found = run([stage(CIRCLE, Straight(0, (2,), largest), [1, 0], records=Plain(beyond=beyond))])
    *before, last = found.of()
    flat = beyond(np.array([0.49, 0])) > 0.1
    np.testing.assert_allclose(last, where, rtol=0, atol=2e-3 if flat else 1e-9)
    assert beyond(last) > 0
    assert all(beyond(z) <= 0 for z in before)
    assert found.endings[0, 0] == Ending(True, "stopped, as asked: z is far")


def test_the_first_of_two_conditions_is_met() -> None:
    both = Plain(beyond=lambda z: max(z[1] - 0.5, 0.9 - z[0]))
    found = run([stage(CIRCLE, Straight(0, (2,), 0.7), [1, 0], records=both)])
    np.testing.assert_allclose(found.of()[-1], [0.9, np.sqrt(0.19)], rtol=0, atol=1e-9)


# special points that end a branch


@pytest.mark.parametrize("count", [1, 2])
def test_special_points_end_a_branch(count: int) -> None:
    wide = Straight(-2, (2,), 0.2)
    asked = Plain(special=(FOLD, count))
    found = run([stage(CIRCLE, wide, [1, 0], records=asked)])
    assert found.points[-1].kind == FOLD
    assert [z[1] for z in found.of(FOLD)] == pytest.approx([1, -1][:count], abs=1e-12)
    assert found.endings[0, 0] == Ending(True, "stopped, as asked: fold")


def test_branch_points_end_a_branch_and_others_are_followed_from_there() -> None:
    asked = Plain(special=(BRANCH_POINT, 1))
    found = run([stage(RING, Straight(-2, (2,), 0.3), [0, -2], records=asked, switch=1)])
    assert next(point for point in found.points if point.kind == BRANCH_POINT).branch == 0
    assert max(z[1] for z in found.of()) <= -1
    assert found.endings[0, 1].reached


# closed curves


@pytest.mark.parametrize("largest", [0.03, 0.1, 0.2, 0.5])
@pytest.mark.parametrize("angle", [0.0, 0.4, -2.0, 1.5])
def test_a_closed_curve_ends_where_it_began(angle: float, largest: float) -> None:
    begin = [np.cos(angle), np.sin(angle)]
    found = run([stage(CIRCLE, Straight(-2, (2,), largest, most=300), begin)])
    z = np.array(found.of())
    np.testing.assert_allclose(z[-1], begin, rtol=0, atol=1e-8)
    assert len(found.of(FOLD)) == 2
    turned = np.unwrap(np.arctan2(z[:, 1], z[:, 0]))
    assert abs(turned[-1] - turned[0]) == pytest.approx(2 * np.pi, abs=1e-7)
    assert found.endings[0, 0] == Ending(False, "closed: it has come back to where it began")


def test_a_curve_that_only_comes_near_its_begin_goes_on() -> None:
    # a spiral r = 1 + a t in the plane of x and l, with a third coordinate t
    a = 2e-4

    def f(z: Array) -> Array:
        return np.array(
            [
                z[0] - (1 + a * z[1]) * np.cos(z[1]),
                z[2] - (1 + a * z[1]) * np.sin(z[1]),
            ]
        )

    def jacobian(z: Array) -> Array:
        r, t = 1 + a * z[1], z[1]
        return np.array(
            [
                [1, -a * np.cos(t) + r * np.sin(t), 0],
                [0, -a * np.sin(t) - r * np.cos(t), 1],
            ]
        )

    # t counts little, so that each turn passes near the one before
    spiral = Dense(f, jacobian, Metric(np.array([1.0, 1e3, 1.0])))
    found = run([stage(spiral, Straight(-2, (2,), 0.2, most=100), [1, 0, 0])])
    assert found.endings[0, 0].reason.startswith("there are 100 points, as many as allowed")
    assert max(z[1] for z in found.of()) > 4 * np.pi


class Halting:
    """A range whose steps are short but for a few: as at a wall that nothing tells of."""

    start, goals, span, first, smallest = 0.0, (0.9,), 0.9, 0.1, 1e-9
    special, most, rounds, name = True, 1000, False, "l"

    def __init__(self, long: int) -> None:
        self.long = long

    @property
    def largest(self) -> float:
        self.long -= 1
        return 0.1 if self.long >= 0 else 1e-7

    def value(self, position: float) -> float:
        return position


@pytest.mark.parametrize("long", [3, 6])
def test_points_that_lead_nowhere_are_the_last(long: int) -> None:
    found = run([stage(CIRCLE, Halting(long), [1, 0])])
    assert found.endings[0, 0].reason.startswith("no progress: the last 100 points are less than")
    assert 100 < len(found.of()) <= 101 + long


# two ways


def test_both_ways_from_the_middle() -> None:
    line = Dense(
        lambda z: np.array([z[0] - z[1] ** 2]),
        lambda z: np.array([[1.0, -2 * z[1]]]),
        Metric(np.ones(2)),
    )
    found = run([stage(line, Straight(-1, (2,), 0.2), [0.25, 0.5], both=True)])
    down, up = (np.array(found.of(branch=branch)) for branch in (0, 1))
    assert down[0].tolist() == [0.25, 0.5]
    assert (down[-1, 1], up[-1, 1]) == (-1, 2)
    assert (np.diff(down[:, 1]) < 0).all()
    assert (np.diff(up[:, 1]) > 0).all()
    assert up[0, 1] > 0.5  # the begin is there once
    assert {point.origin for point in found.points if point.branch == 0} == {None}
    assert {point.origin for point in found.points if point.branch == 1} == {0}
    reached = [found.endings[0, way].reason for way in (0, 1)]
    assert reached == ["reached l = -1", "reached l = 2"]


def test_a_way_that_turns_back_goes_on_to_the_other_end() -> None:
    found = run([stage(CIRCLE, Straight(-0.5, (2,), 0.2), [0.8, 0.6], both=True)])
    assert found.endings[0, 0] == Ending(True, "reached l = -0.5")
    assert found.endings[0, 1].reason.startswith("the branch turned back and left the range")
    z = np.array(found.of(branch=1))
    assert z[-1, 0] < 0
    assert z[-1, 1] < -0.5


def test_a_closed_curve_is_followed_one_way() -> None:
    found = run([stage(CIRCLE, Straight(-2, (2,), 0.2), [0.8, 0.6], both=True)])
    assert {point.branch for point in found.points} == {0}
    assert found.endings[0, 1].reason.startswith("is branch 0 already")


# branches of branches, each once


@pytest.fixture(scope="module", params=[0.05, 0.15, 0.3, 0.32, 0.48, 0.9])
def ring(request: pytest.FixtureRequest) -> Run:
    range_ = Straight(-2, (2,), request.param, first=request.param)
    return run([stage(RING, range_, [0, -2], switch=2)])


def test_a_branch_that_connects_two_branch_points_is_followed_once(ring: Run) -> None:
    np.testing.assert_allclose(ring.of(BRANCH_POINT), [[0, -1], [0, 1]], atol=1e-9)
    for branch, sign in ((1, 1), (2, -1)):
        z = np.array(ring.of(branch=branch))
        np.testing.assert_allclose((z**2).sum(axis=1), 1, rtol=0, atol=1e-12)
        assert (sign * z[:, 0] > 0).all()
        assert ring.of(BRANCH_POINT, branch) == ring.of(FOLD, branch) == []
        assert ring.endings[0, branch].reason.startswith("has come to the branch point at l = 1")
    assert sorted(ring.endings[0, branch].reason for branch in (3, 4)) == [
        "is branch 1 already",
        "is branch 2 already",
    ]
    assert sorted(ring.endings) == [(0, branch) for branch in range(5)]


def test_branches_know_where_they_left(ring: Run) -> None:
    first = next(point for point in ring.points if point.kind == BRANCH_POINT)
    assert {point.origin for point in ring.points if point.branch in (1, 2)} == {first.number}
    assert {point.origin for point in ring.points if point.branch == 0} == {None}


@pytest.mark.parametrize("radius", [0.2, 0.04, 0.01])
def test_small_branches_are_begun_near_to_where_they_leave(radius: float) -> None:
    small = Dense(
        lambda z: np.array([z[0] * (z @ z - radius**2)]),
        lambda z: np.array([[z @ z - radius**2 + 2 * z[0] ** 2, 2 * z[0] * z[1]]]),
        Metric(np.ones(2)),
    )
    range_ = Straight(-1, (1,), 0.6 * radius, first=0.6 * radius, smallest=1e-6 * radius, most=999)
    found = run([stage(small, range_, [0, -1], switch=1)])
    np.testing.assert_allclose(found.of(BRANCH_POINT), [[0, -radius], [0, radius]], atol=1e-9)
    for branch, sign in ((1, 1), (2, -1)):
        z = np.array(found.of(branch=branch))
        np.testing.assert_allclose(np.linalg.norm(z, axis=1), radius, rtol=1e-9)
        assert (sign * z[:, 0] > 0).all()
    assert sorted(found.endings[0, branch].reason for branch in (3, 4)) == [
        "is branch 1 already",
        "is branch 2 already",
    ]


@pytest.mark.parametrize(("depth", "branches"), [(0, 1), (1, 3), (2, 5), (3, 5)])
def test_branches_of_branches_are_followed_as_deep_as_asked(depth: int, branches: int) -> None:
    found = run([stage(TWICE, Straight(-1, (3,), 0.2), [0, 0, -1], switch=depth)])
    assert len(found.endings) == branches
    assert all(ending.reached for ending in found.endings.values())
    for z in found.of(branch=3) + found.of(branch=4):
        assert z[1] ** 2 == pytest.approx(z[0] - 1, abs=1e-12)
        assert z[0] ** 2 == pytest.approx(z[2], abs=1e-12)
    if depth > 1:
        second = np.array([point.row["z"] for point in found.points if point.kind == BRANCH_POINT])
        np.testing.assert_allclose(second, [[0, 0, 0], [1, 0, 1]], atol=1e-8)
        ends = sorted(found.of(branch=branch)[-1][1] for branch in (3, 4))
        np.testing.assert_allclose(ends, [-np.sqrt(np.sqrt(3) - 1), np.sqrt(np.sqrt(3) - 1)])


# going on


@pytest.mark.parametrize("case", ["ring", "ways", "landed", "fold", "closed"])
def test_going_on_after_any_point_is_the_same(case: str) -> None:
    exact = Plain(beyond=lambda z: -0.2 - z[0])
    stages = {
        "ring": stage(RING, Straight(-2, (2,), 0.3), [0, -2], switch=2),
        "ways": stage(RING, Straight(-2, (2,), 0.3), [0, 0.3], switch=2, both=True),
        "landed": stage(CIRCLE, Straight(0, (2,), 0.2), [1, 0], records=exact),
        "fold": stage(CIRCLE, Straight(0, (2,), 0.2), [1, 0], records=Plain(special=(FOLD, 1))),
        "closed": stage(CIRCLE, Straight(-2, (2,), 0.4), [0.8, 0.6], both=True),
    }
    whole = run([stages[case]])
    for count in range(1, len(whole.points)):
        known = whole.points[:count]
        while known[-1].kind != POINT:  # as branch files do
            known.pop()
        ended = {k: e for k, e in whole.endings.items() if k < key_of(known[-1])}
        again = run([stages[case]], known, ended)
        assert again.endings == whole.endings, count
        assert len(again.points) == len(whole.points), count
        for point, other in zip(again.points, whole.points, strict=True):
            assert point.unknowns.tobytes() == other.unknowns.tobytes()
            assert (point.number, point.kind, point.origin) == (
                other.number,
                other.kind,
                other.origin,
            )


def key_of(point: object) -> tuple[int, int]:
    return point.stage, point.branch  # type: ignore[attr-defined]
