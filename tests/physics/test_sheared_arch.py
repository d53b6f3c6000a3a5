"""The sheared arch: where it loses its axis of symmetry, and where its branches come together.

Truth: shooting of order eight of symmetric halves, the determinant of the block that breaks the
symmetry. First threshold: the symmetric arch buckles sideways. Second: the state of height zero,
which is its own image by inversion, loses its symmetry; the asymmetric branches come to it.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pytest

from ribbonopt.scene import ContinuationStage, Kirchhoff, Law, Sadowsky, Scene, Variational
from ribbonopt.scene import loads_scene as parsed
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.walk.points import BRANCH_POINT, KINK, POINT, Point
from ribbonopt.studies.continuation.walk.special import FROM_THE_SIDE

ARCH = """name: arch
law: {type: sadowsky}
parameters: {shear: 0}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, shear, 0.6875], directors: identity}
guess: {force: [0, 0, -46.97375812], moment: [0, 7.49816358, 0]}
tolerance: 1e-8
record: {middle: "dot(r, ex) at 0.5"}
"""


class Truth(NamedTuple):
    """Thresholds of a law, to how many units, and the kind of the first."""

    law: Law
    first: float
    second: float
    digits: float
    kind: str = BRANCH_POINT


TRUTHS = {
    "rod": Truth(Kirchhoff(B2=1, B3=4 / 3), 0.29221607553, 0.43968347932, 2e-11),
    "variational .1": Truth(Variational(delta=0.1), 0.257415597, 0.39030295, 1e-8),
    "variational .01": Truth(Variational(delta=0.01), 0.251239158, 0.38306546, 1e-8),
    "sadowsky": Truth(Sadowsky(), 0.25060501787, 0.38286571873, 1e-9, KINK),
}
WIDE = {"variational .01"}
each_law = pytest.mark.parametrize(
    "name", [pytest.param(law, marks=[pytest.mark.sweep] * (law in WIDE)) for law in TRUTHS]
)
GOALS = (0.28, 0.3, 0.31, 0.32, 0.3333, 0.35, 0.4, 0.5)
STEPS = (None, 0.01, 0.02, 0.03, 0.05)


def arch(law: Law, to: float, largest: float | None, **stage: object) -> Scene:
    given = ContinuationStage("parameters.shear", from_=0.0, to=to, largest=largest)
    return replace(parsed(ARCH), law=law, continuation=replace(given, **stage))


def followed(scene: Scene) -> tuple[list[Point[Solution]], Continuation]:
    """Return all points; what is not resolved, or may be another equilibrium, is a failure."""
    continuation = Continuation(scene)
    points = list(continuation)
    for point in points:
        assert "not resolved" not in point.note, point.note
        assert "where the branch was going" not in point.note, point.note
    return points, continuation


def special(points: list[Point[Solution]], branch: int = 0) -> list[tuple[str, float]]:
    return [(p.kind, p.position) for p in points if p.branch == branch and p.kind != POINT]


def assert_first_threshold(name: str, to: float, largest: float | None) -> None:
    truth = TRUTHS[name]
    points, continuation = followed(arch(truth.law, to, largest))
    assert continuation.ending.reached
    ((kind, position),) = special(points)
    assert kind == truth.kind
    assert position == pytest.approx(truth.first, abs=truth.digits)
    for point in points:
        if point.kind == POINT:
            assert point.sign == (1 if point.position > position else -1) * points[-1].sign


@each_law
@pytest.mark.parametrize(("to", "largest"), [(0.3, 0.02), (0.3333, None), (0.35, 0.05)])
def test_the_first_threshold(name: str, to: float, largest: float | None) -> None:
    assert_first_threshold(name, to, largest)


@pytest.mark.parametrize("largest", STEPS)
@pytest.mark.parametrize("to", GOALS)
@pytest.mark.parametrize(
    "name",
    [pytest.param(law, marks=pytest.mark.sweep) for law in TRUTHS],
)
def test_the_first_threshold_by_any_steps(name: str, to: float, largest: float | None) -> None:
    if to < TRUTHS[name].first:
        # Before it: nothing special, not even just before.
        points, _ = followed(arch(TRUTHS[name].law, to, largest))
        assert special(points) == []
    else:
        assert_first_threshold(name, to, largest)


@each_law
@pytest.mark.parametrize("short", [1e-2, 1e-4, 1e-6])
def test_goals_short_of_the_first_threshold_and_beyond(name: str, short: float) -> None:
    truth = TRUTHS[name]
    points, _ = followed(arch(truth.law, truth.first - short, 0.03))
    assert special(points) == []
    points, _ = followed(arch(truth.law, truth.first + short, 0.03))
    ((kind, position),) = special(points)
    assert (kind, position) == (truth.kind, pytest.approx(truth.first, abs=truth.digits))


@pytest.mark.parametrize(
    "largest",
    [
        pytest.param(None, marks=pytest.mark.slow),
        *(pytest.param(step, marks=pytest.mark.sweep) for step in (0.02, 0.05)),
    ],
)
def test_asymmetric_rods_pass_the_state_of_height_zero(largest: float | None) -> None:
    # Ribbons do not: there m2 = m3 = 0 in the middle, where homogeneous laws are not smooth.
    truth = TRUTHS["rod"]
    points, continuation = followed(arch(truth.law, 0.5, largest, switch=True))
    assert {point.branch for point in points} == {0, 1}
    crossings = [p for p in points if p.branch == 1 and p.kind == BRANCH_POINT]
    assert {p.note for p in crossings} == {FROM_THE_SIDE}
    places = [truth.second, truth.first, truth.second]  # up, over, and down on the other side
    np.testing.assert_allclose([p.position for p in crossings], places, atol=truth.digits)
    assert "come back to where it began" in continuation.endings[0, 1].reason
    for crossing in crossings[::2]:
        assert abs(crossing.row["middle"]) < 1e-6
    between = [p for p in points if p.branch == 1 and p.kind == POINT]
    assert {p.row["negative"] for p in between} == {0}
    assert all(truth.first <= p.position <= truth.second + 1e-9 for p in between)


@pytest.mark.sweep
@each_law
def test_asymmetric_arches_come_to_the_state_of_height_zero(name: str) -> None:
    truth = TRUTHS[name]
    scene = arch(truth.law, 0.5, 0.02, switch=True, stop=("middle < 3e-4",))
    points, continuation = followed(scene)
    sides = [[p for p in points if p.branch == k and p.kind == POINT] for k in (1, 2)]
    for k, side in enumerate(sides, start=1):
        assert "stopped" in continuation.endings[0, k].reason
        middle, shear = (np.array(v) for v in zip(*(side_row(p) for p in side[-4:]), strict=True))
        # Even in the height for a rod, not so for homogeneous laws.
        height, power = (middle**2, 2) if name == "rod" else (middle, 3)
        found = np.polyval(np.polyfit(height, shear, power), 0.0)
        assert found == pytest.approx(truth.second, abs=2e-6)
    one, other = (side[-1].row for side in sides)
    assert one["parameters.shear"] == pytest.approx(other["parameters.shear"], abs=1e-8)
    assert one["energy"] == pytest.approx(other["energy"], rel=1e-8)


def side_row(point: Point[Solution]) -> tuple[float, float]:
    return point.row["middle"], point.position


@pytest.mark.sweep
def test_steps_of_any_length_stay_on_the_symmetric_arch() -> None:
    # One of .03 once landed on the branch that crosses at .5048: nothing told, another energy.
    runs = [followed(arch(Variational(delta=0.01), 0.6, largest)) for largest in (0.01, 0.03)]
    ends = [points[-1].row for points, _ in runs]
    assert ends[0]["energy"] == pytest.approx(ends[1]["energy"], rel=1e-8)
    assert [end["negative"] for end in ends] == [0, 0]
    one, other = (special(points) for points, _ in runs)
    assert [kind for kind, _ in one] == [kind for kind, _ in other] == [BRANCH_POINT] * 2
    np.testing.assert_allclose([at for _, at in one], [at for _, at in other], atol=1e-8)
