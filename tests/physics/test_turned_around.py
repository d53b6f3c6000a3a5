"""A clamp turned all around and back, and the same ribbon mirrored or turned in space.

Truth: an equilibrium is the same from either side, and for any observer.
"""

from dataclasses import replace

import numpy as np
import pytest

from ribbonopt.mechanics.rotations import matrix_of
from ribbonopt.plain import Row
from ribbonopt.scene import (
    Boundary,
    ContinuationStage,
    End,
    Kirchhoff,
    Law,
    Sadowsky,
    Scene,
    Variational,
)
from ribbonopt.scene.frames import Turn, Turns
from ribbonopt.solution.solution import Solution
from ribbonopt.studies.continuation.continuation import Continuation
from ribbonopt.studies.continuation.walk.points import POINT, Point

LAWS: dict[str, Law] = {
    "rod 1": Kirchhoff(B2=1, B3=1),
    "rod 1.5": Kirchhoff(B2=1, B3=1.5),
    "variational": Variational(delta=0.1),
    "sadowsky": Sadowsky(),
}
each_law = pytest.mark.parametrize("name", LAWS)
PLACES = (20.0, 100.0, 200.0, 290.0, 345.0, 360.0)


def turned(law: Law, *, start: Turns, place: tuple[float, ...], turns: tuple[Turn, ...]) -> Scene:
    return Scene(
        name="turned",
        law=law,
        parameters={"a": 0.0},
        boundary=Boundary(
            End("clamped", position=(0, 0, 0), directors=start),
            End("clamped", position=place, directors=Turns(turns)),
        ),
        tolerance=1e-8,
        record={"torque": "dot(m, d3) at 1"},
    )


def followed(scene: Scene, *, folds: bool = False) -> tuple[list[Point[Solution]], Continuation]:
    """Return all points of a continuation that reaches its goals, or folds, and doubts nothing."""
    continuation = Continuation(scene)
    points = list(continuation)
    for ending in continuation.endings.values():
        assert ending.reached or (folds and "turned back" in ending.reason), ending
    for point in points:
        assert "not resolved" not in point.note, point.note
        assert "where the branch was going" not in point.note, point.note
    return points, continuation


def special(points: list[Point[Solution]], stage: int = 0) -> list[tuple[str, float]]:
    return [(p.kind, p.position) for p in points if p.stage == stage and p.kind != POINT]


def assert_alike(one: list[tuple[str, float]], other: list[tuple[str, float]]) -> None:
    assert [kind for kind, _ in one] == [kind for kind, _ in other]
    np.testing.assert_allclose([at for _, at in one], [at for _, at in other], rtol=0, atol=1e-6)


def assert_the_same_both_ways(name: str, largest: float) -> None:
    around = Turns((Turn(z=0.0),))
    scene = turned(LAWS[name], start=around, place=(0, 0, 0.7), turns=(Turn(z="a*deg"),))
    there = ContinuationStage("parameters.a", values=(0.0, *PLACES), largest=largest)
    back = replace(there, values=(*PLACES[::-1], 0.0))
    points, _ = followed(replace(scene, continuation=(there, back)))
    assert_alike(special(points, 0), special(points, 1)[::-1])
    assert special(points, 0)
    rows = [
        {p.position: p.row for p in points if p.stage == stage and p.kind == POINT}
        for stage in (0, 1)
    ]
    for place in (0.0, *PLACES[:-1]):
        one, other = (way[place] for way in rows)
        assert one["energy"] == pytest.approx(other["energy"], rel=1e-8)
        assert one["torque"] == pytest.approx(other["torque"], rel=1e-7, abs=1e-7)
        assert one["negative"] == other["negative"]


@pytest.mark.parametrize("name", ["rod 1", "rod 1.5"])
def test_a_rod_is_turned_all_around_and_back(name: str) -> None:
    assert_the_same_both_ways(name, 10.0)


@pytest.mark.parametrize(
    "largest",
    [
        pytest.param(7.0, marks=pytest.mark.slow),
        *(pytest.param(angle, marks=pytest.mark.sweep) for angle in (3.0, 5.0, 10.0, 20.0)),
    ],
)
@each_law
def test_a_ribbon_is_turned_all_around_and_back(name: str, largest: float) -> None:
    assert_the_same_both_ways(name, largest)


# One scene, mirrored and turned in space: a clamp whose end is aside and turned about an axis.

ASIDE, TILT, TO = (0.15, 0.1, 0.6), (0.3, -0.2), 150.0


def aside(law: Law, mirrored: bool = False, frame: tuple[Turn, ...] = ()) -> Scene:
    """The scene; or its mirror image by the plane of d1 and d3; or all of it turned by a frame."""
    sign = -1 if mirrored else 1
    x, y, z = ASIDE
    place = np.array([x, sign * y, z])
    rotation = np.eye(3)
    for turn in frame:  # each about an axis of the laboratory
        axis = np.array([turn.x or 0.0, turn.y or 0.0, turn.z or 0.0], dtype=float)
        angle = float(np.linalg.norm(axis))
        rotation = matrix_of(np.array([np.cos(angle / 2), *(np.sin(angle / 2) * axis / angle)]))
        place = rotation @ place
    turns = (Turn(x=sign * TILT[0]), Turn(y=TILT[1]), Turn(z=f"{sign}*a*deg"), *frame)
    scene = turned(law, start=Turns(frame or (Turn(z=0.0),)), place=tuple(place), turns=turns)
    return replace(scene, continuation=ContinuationStage("parameters.a", to=TO, largest=10.0))


@pytest.fixture(scope="module")
def plain() -> dict[str, list[Point[Solution]]]:
    return {}


def reference(plain: dict[str, list[Point[Solution]]], name: str) -> list[Point[Solution]]:
    if name not in plain:
        plain[name] = followed(aside(LAWS[name]), folds=True)[0]
    return plain[name]


some_laws = pytest.mark.parametrize(
    "name", ["rod 1.5", *(pytest.param(law, marks=pytest.mark.slow) for law in list(LAWS)[2:])]
)


@some_laws
def test_mirror_images_give_mirrored_branches(
    plain: dict[str, list[Point[Solution]]], name: str
) -> None:
    one = reference(plain, name)
    other = followed(aside(LAWS[name], mirrored=True), folds=True)[0]
    assert_alike(special(one), special(other))
    for a, b in compared(one, other):
        assert a["energy"] == pytest.approx(b["energy"], rel=1e-7)
        assert a["torque"] == pytest.approx(-b["torque"], rel=1e-6)
        assert a["negative"] == b["negative"]


def compared(one: list[Point[Solution]], other: list[Point[Solution]]) -> list[tuple[Row, Row]]:
    """Return the rows of points that two branches have in common: special ones, and the goal."""
    both = [
        [p.row for p in points if p.kind != POINT or p.position == TO] for points in (one, other)
    ]
    assert both[0]
    return list(zip(*both, strict=True))


FRAMES = {
    "quarter": (Turn(x=np.pi / 2),),
    "half": (Turn(y=np.pi),),
    "more than half": (Turn(z=4.0),),
    "three": (Turn(x=2.0), Turn(y=-2.5), Turn(z=3.5)),
}


@some_laws
@pytest.mark.parametrize("frame", FRAMES)
def test_scenes_turned_in_space_give_the_same(
    plain: dict[str, list[Point[Solution]]], name: str, frame: str
) -> None:
    one = reference(plain, name)
    other = followed(aside(LAWS[name], frame=FRAMES[frame]), folds=True)[0]
    assert_alike(special(one), special(other))
    for a, b in compared(one, other):
        for key in ("energy", "torque"):
            assert a[key] == pytest.approx(b[key], rel=1e-6)
        assert a["negative"] == b["negative"]
