"""The walk on curves with closed forms: a circle, a pitchfork, the locus of a fold through a cusp.

Nothing here knows of ribbons: the protocol is implemented in `dense_curves`.
"""

from dataclasses import replace

import numpy as np
import pytest
from dense_curves import Dense, Plain, Straight, Unit
from walks import Run, run, stage

from ribbonopt.studies.continuation.walk.metric import Metric
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, FOLD, POINT
from ribbonopt.studies.continuation.walk.walk import Ending

Array = np.ndarray
UNIT = Metric(np.ones(2))

CIRCLE = Dense(
    lambda z: np.array([z @ z - 1]),
    lambda z: 2 * z[None, :],
    UNIT,
)
PITCHFORK = Dense(
    lambda z: np.array([z[1] * z[0] - z[0] ** 3]),
    lambda z: np.array([[z[1] - 3 * z[0] ** 2, z[0]]]),
    UNIT,
)
# [x, l1, l2]: l1 + l2 x - x^3 and its derivative by x, which vanishes at folds
CUSP = Dense(
    lambda z: np.array([z[1] + z[2] * z[0] - z[0] ** 3, z[2] - 3 * z[0] ** 2]),
    lambda z: np.array([[z[2] - 3 * z[0] ** 2, 1, z[0]], [-6 * z[0], 0, 1]]),
    Metric(np.array([1.0, 1.0, 3.0])),
)
# the same with the parameters exchanged, [x, l2, l1]
ACROSS = Dense(
    lambda z: CUSP.f(z[[0, 2, 1]]),
    lambda z: CUSP.jacobian(z[[0, 2, 1]])[:, [0, 2, 1]],
    Metric(np.array([1.0, 3.0, 1.0])),
)


# a circle


@pytest.fixture(scope="module")
def circle() -> Run:
    """Up from (1, 0), over the fold at l = 1, down over that at -1: the goal is out of reach."""
    return run([stage(CIRCLE, Straight(0, (2,), 0.2), [1, 0])])


def test_points_are_on_the_circle(circle: Run) -> None:
    z = np.array(circle.of())
    np.testing.assert_allclose((z**2).sum(axis=1), 1, rtol=0, atol=1e-13)
    assert len(z) < 25


def test_fold_is_where_the_circle_turns(circle: Run) -> None:
    (fold,) = circle.of(FOLD)
    np.testing.assert_allclose(fold, [0, 1], rtol=0, atol=1e-10)
    assert circle.of(BRANCH_POINT) == []
    assert circle.endings == {
        (0, 0): Ending(False, "the branch turned back and left the range (folds at l = 1)")
    }


def test_both_folds_of_the_circle_once_around() -> None:
    # wide enough for the whole circle, begun in its middle
    found = run([stage(CIRCLE, Straight(-2, (2,), 0.2), [1, 0])])
    folds = np.array(found.of(FOLD))
    np.testing.assert_allclose(folds, [[0, 1], [0, -1]], atol=1e-10)
    assert found.endings[0, 0] == Ending(False, "closed: it has come back to where it began")


def test_tangents_have_unit_length_and_steps_are_short(circle: Run) -> None:
    for point in circle.points:
        assert point.tangent @ point.tangent == pytest.approx(1, abs=1e-14)
        assert point.tangent @ point.unknowns == pytest.approx(0, abs=1e-10)
    z = np.array(circle.of())
    # natural steps are at most 0.2 of the position, others at most 0.5 long
    assert np.linalg.norm(np.diff(z, axis=0), axis=1).max() < 0.5


@pytest.mark.parametrize("special", [True, False])
def test_special_points_are_found_if_asked(special: bool) -> None:
    found = run([stage(CIRCLE, Straight(0, (2,), 0.2, special=special), [1, 0])])
    assert len(found.of(FOLD)) == special


# a pitchfork


@pytest.fixture(scope="module")
def pitchfork() -> Run:
    """The zero solution, and the branches that cross it at l = 0."""
    return run([stage(PITCHFORK, Straight(-1, (1,), 0.3), [0, -1], switch=1)])


def test_branch_point_is_where_the_branches_cross(pitchfork: Run) -> None:
    (found,) = pitchfork.of(BRANCH_POINT)
    np.testing.assert_allclose(found, 0, atol=1e-10)
    assert [z[0] for z in pitchfork.of()] == [0] * len(pitchfork.of())
    assert pitchfork.of()[-1][1] == 1


@pytest.mark.parametrize(("branch", "sign"), [(1, 1), (2, -1)])
def test_switching_leads_onto_both_halves(pitchfork: Run, branch: int, sign: int) -> None:
    z = np.array(pitchfork.of(branch=branch))
    assert len(z) > 4
    np.testing.assert_allclose(z[:, 0], sign * np.sqrt(z[:, 1]), rtol=1e-12)
    assert z[-1, 1] == 1
    assert pitchfork.endings[0, branch] == Ending(True, "reached l = 1")


def test_numbers_count_all_points(pitchfork: Run) -> None:
    assert [point.number for point in pitchfork.points] == list(range(len(pitchfork.points)))


# the locus of a fold: two parameters


def assert_on_the_cusp(x: Array, l1: Array, l2: Array) -> None:
    np.testing.assert_allclose(27 * l1**2, 4 * l2**3, rtol=0, atol=1e-11)
    np.testing.assert_allclose(l1, -2 * x**3, rtol=0, atol=1e-12)


def test_locus_of_folds_goes_through_the_cusp() -> None:
    found = run([stage(CUSP, Straight(3, (-1,), 0.3), [-1, 2, 3])])
    z = np.array(found.of())
    assert_on_the_cusp(*z.T)
    assert z[0, 0] < 0 < z[-1, 0]  # from one arm to the other
    assert z[-1, 2] > 3
    (cusp,) = found.of(FOLD)  # where l2 turns
    np.testing.assert_allclose(cusp, 0, atol=1e-9)
    assert found.of(BRANCH_POINT) == []
    assert not found.endings[0, 0].reached


def test_locus_of_folds_meets_values_of_the_other_parameter() -> None:
    goals = (1.0, -0.5, -2.0)
    found = run([stage(ACROSS, Straight(2, goals, 0.4), [-1, 3, 2])])
    z = np.array(found.of())
    assert_on_the_cusp(z[:, 0], z[:, 2], z[:, 1])
    assert (np.diff(z[:, 0]) > 0).all()
    assert {1.0, -0.5, -2.0} <= set(z[:, 2])
    np.testing.assert_allclose(z[-1], [1, 3, -2], atol=1e-12)
    assert found.endings[0, 0] == Ending(True, "reached l = -2")


# layouts


def test_layouts_change_on_the_way_and_nothing_else(circle: Run) -> None:
    changing = replace(CIRCLE, unit_for=lambda z: Unit(1.0 if z[0] > 0.5 else 4.0))
    found = run([stage(changing, Straight(0, (2,), 0.2), [1, 0])])
    assert {point.solution for point in found.points} == {Unit(1.0), Unit(4.0)}
    for kind in (POINT, FOLD):
        np.testing.assert_allclose(found.of(kind), circle.of(kind), rtol=0, atol=1e-9)
    assert found.endings == circle.endings


def test_another_layout_helps_where_none_is_found() -> None:
    helped = replace(
        CIRCLE,
        admissible=lambda z: z[1] < 0.5,
        other=lambda there: np.array([np.sqrt(1 - there**2), there]),
    )
    found = run([stage(helped, Straight(0, (0.9,), 0.2), [1, 0])])
    z = np.array(found.of())
    assert z[-1, 1] == 0.9
    np.testing.assert_allclose((z**2).sum(axis=1), 1, rtol=0, atol=1e-13)


# endings


def test_the_step_gets_too_small_where_nothing_is_admissible() -> None:
    barred = replace(CIRCLE, admissible=lambda z: z[1] < 0.5)
    found = run([stage(barred, Straight(0, (0.9,), 0.2), [1, 0])])
    assert found.of()[-1][1] == pytest.approx(0.5, abs=1e-5)
    ending = found.endings[0, 0]
    assert not ending.reached
    assert ending.reason.startswith("the step fell below 1e-06 beyond l = 0.")
    assert ending.reason.endswith(": not admissible")


def test_conditions_stop_a_stage_and_the_next_begins_there() -> None:
    far = Plain(lambda z: bool(z[1] > 0.55))
    stages = [
        stage(CIRCLE, Straight(0, (0.9,), 0.2), [1, 0], records=far),
        stage(CIRCLE, Straight(0.7, (0.7,), 0.2), []),  # where it is already
        stage(CIRCLE, Straight(0.7, (-0.5,), 0.2), []),
    ]
    found = run(stages)
    assert found.endings[0, 0] == Ending(True, "stopped, as asked: z is far")
    assert found.endings[1, 0] == Ending(True, "its goal is where it begins")
    assert found.endings[2, 0] == Ending(True, "reached l = -0.5")
    np.testing.assert_array_equal(found.of(stage=2)[0], found.of()[-1])
    assert found.of(stage=1) == []


def test_no_stage_follows_one_that_failed() -> None:
    stages = [
        stage(CIRCLE, Straight(0, (2,), 0.2), [1, 0]),
        stage(CIRCLE, Straight(0, (0.5,), 0.2), []),
    ]
    assert sorted(run(stages).endings) == [(0, 0)]


@pytest.mark.parametrize("count", [1, 2, 7, 9])
@pytest.mark.parametrize("curve", ["circle", "pitchfork"])
def test_going_on_is_as_if_there_had_been_no_break(
    curve: str, count: int, request: pytest.FixtureRequest
) -> None:
    whole: Run = request.getfixturevalue(curve)
    begin = {
        "circle": stage(CIRCLE, Straight(0, (2,), 0.2), [1, 0]),
        "pitchfork": stage(PITCHFORK, Straight(-1, (1,), 0.3), [0, -1], switch=1),
    }
    known = whole.points[:count]
    while known[-1].kind != POINT:  # as branch files do
        known.pop()
    again = run([begin[curve]], known)
    assert again.endings == whole.endings
    assert len(again.points) == len(whole.points)
    for point, other in zip(again.points, whole.points, strict=True):
        assert point.unknowns.tobytes() == other.unknowns.tobytes()
        assert point.tangent.tobytes() == other.tangent.tobytes()
        assert (point.number, point.kind, point.step) == (other.number, other.kind, other.step)


# what is told


def test_a_point_of_another_curve_is_told() -> None:
    # x = 0 and x = 1, of which the first ends at l = 1.
    lines = Dense(
        lambda z: np.array([z[0] * (z[0] - 1)]),
        lambda z: np.array([[2 * z[0] - 1, 0.0]]),
        UNIT,
        admissible=lambda z: bool(z[0] > 0.5 or z[1] <= 1),
        other=lambda position: np.array([1.0, position]),
    )
    found = run([stage(lines, Straight(0, (2,), 0.3), [0, 0])])
    told = [(point.row["z"].tolist(), point.note) for point in found.points]
    first = next(i for i, (z, _) in enumerate(told) if z[0] == 1)
    assert "another equilibrium" in told[first][1]
    assert not any(note for i, (_, note) in enumerate(told) if i != first)
