"""Contradictions between the values of a scene, all found without mechanics."""

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ribbonopt.errors import SceneError
from ribbonopt.scene import (
    AnyVector,
    Boundary,
    Directors,
    End,
    LabVector,
    LoadGuess,
    Sadowsky,
    Scene,
    validate_scene,
)

FREE = End()
GUESS = LoadGuess(force=(0.0, 0.0, 0.0), moment=(0.0, 0.0, 1.0))


def scene(start: End = FREE, *, also: Any = (), **values: Any) -> Scene:
    """Return a scene whose start is the matter of a test."""
    return Scene("test", Sadowsky(), Boundary(start=start, also=also), GUESS, **values)


def refusal(start: End = FREE, **values: Any) -> str:
    with pytest.raises(SceneError) as caught:
        validate_scene(scene(start, **values))
    return str(caught.value)


@pytest.mark.parametrize("interval", [(1, 0), (0, 0), (-1, -2)])
def test_interval_must_advance(interval: tuple[float, float]) -> None:
    assert "must go from a smaller to a larger arclength" in refusal(interval=interval)


@pytest.mark.parametrize(
    ("start", "message"),
    [
        (End(directors="identity", d1=(1, 0, 0)), "boundary.start.d1: given twice"),
        (End(directors="identity", d2=LabVector(x=0)), "boundary.start.d2: given twice"),
        (End(directors=Directors(d1=(1, 0, 0))), "needs two or three of d1, d2, d3"),
        (End(directors=Directors()), "needs two or three of d1, d2, d3"),
        (End(d1=(1, 1, 0)), "boundary.start.d1: has length 1.41421, expected 1"),
        (End(d1=LabVector(0, 0, 0)), "boundary.start.d1: has length 0, expected 1"),
        (End(d1=LabVector(x=1.1)), "components of length 1.1, more than"),
        (End(d3=LabVector(x=0.8, y=-0.8)), "components of length 1.13137, more than"),
        (End(d1=(1, 0, 0), d3=(1, 0, 0)), "boundary.start.d3: is not orthogonal to d1"),
        (
            End(directors=Directors(d1=(1, 0, 0), d2=(0.6, 0.8, 0))),
            "boundary.start.directors.d2: is not orthogonal to d1: their product is 0.6",
        ),
        (
            End(directors=Directors(d1=(1, 0, 0), d2=(0, 1, 0), d3=(0, 0, -1))),
            "boundary.start.directors.d3: makes a left-handed frame",
        ),
        (End(d1=(1, 0, 0), d2=(0, 1, 0), d3=(0, 0, -1)), "boundary.start.d3: makes a left-handed"),
        (End(d1=("cos(turn)", 0, 0)), "boundary.start.d1: has length 0.877583"),
        (End(d1=(1 + 2e-6, 0, 0)), "has length"),
    ],
)
def test_contradictory_directors(start: End, message: str) -> None:
    assert message in refusal(start, parameters={"turn": 0.5})


@pytest.mark.parametrize(
    "start",
    [
        End(directors="identity"),
        End(directors=Directors(d1=(0, 1, 0), d3=(1, 0, 0))),
        End(d1=(1, 0, 0), d3=LabVector(x=0)),
        End(d1=LabVector(x=1), d2=LabVector(y=-1)),
        End(d1=("cos(turn)", "sin(turn)", 0), d2=("-sin(turn)", "cos(turn)", 0), d3=(0, 0, 1)),
        End(d1=(1 + 5e-7, 0, 0)),
        End(force=AnyVector(x=0, d1=0), moment=AnyVector(d1=100)),
    ],
)
def test_directors_that_agree(start: End) -> None:
    validate_scene(scene(start, parameters={"turn": 0.5}))


unit = st.floats(-1, 1)


@given(unit, unit, unit, unit)
def test_every_rotation_is_a_frame_and_its_mirror_is_not(
    a: float, b: float, c: float, d: float
) -> None:
    size = math.sqrt(a * a + b * b + c * c + d * d)
    if size < 1e-3:
        return
    w, x, y, z = a / size, b / size, c / size, d / size
    d1 = (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y))
    d2 = (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x))
    d3 = (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))
    validate_scene(scene(End(directors=Directors(d1, d2, d3))))
    mirror = (-d3[0], -d3[1], -d3[2])
    assert "left-handed" in refusal(End(directors=Directors(d1, d2, mirror)))


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("pi", "a word of the formulas"),
        ("deg", "a word of the formulas"),
        ("dot", "a word of the formulas"),
        ("n", "a word of the formulas"),
        ("start", "a word of the formulas"),
        ("two words", "is no name"),
        ("1st", "is no name"),
        ("lambda", "is no name"),
        ("été", "is no name"),
        ("", "is no name"),
    ],
)
def test_names_of_parameters(name: str, message: str) -> None:
    assert message in refusal(parameters={name: 1.0})


def test_formulas_are_checked_where_they_stand() -> None:
    message = refusal(
        End(position=(0, "1 - trun", 0), force=AnyVector(d1="1/0"), d1=LabVector(x="foo(")),
        also=("dot(n, d1(start)) = 0", "u2 = 1", "n(end) = m", "dot(n,d1(start))=0"),
        parameters={"turn": 1.0},
        interval=(1, 0),
    )
    assert message.startswith("scene: 7 problems\n")
    for part in (
        "interval: found [1, 0], must go",
        "boundary.start.position.1: formula '1 - trun', column 5: unknown name 'trun'; did you",
        "boundary.start.force.d1: formula '1/0': has no finite real value",
        "boundary.start.d1.x: formula 'foo(', column",
        "boundary.also.1: formula 'u2 = 1', column 1: 'u2' needs an end",
        "boundary.also.2: formula 'n(end) = m', column 10: 'm' needs an end",
        "boundary.also.3: found 'dot(n,d1(start))=0', says the same as boundary.also.0",
    ):
        assert part in message


def test_text_that_is_no_formula_is_left_alone() -> None:
    assert validate_scene(scene(End(directors="identity"))).boundary.start.directors == "identity"
