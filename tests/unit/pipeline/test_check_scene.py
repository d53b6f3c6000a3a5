"""What `ribbonopt check` says of scenes with supports and loads at single places."""

import pytest

from ribbonopt.errors import ConvergenceError, SceneError
from ribbonopt.pipeline.check import check_scene
from ribbonopt.scene import loads_scene

CLAMPED = """name: t
law: {type: sadowsky}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end:
    support: clamped
    position: [0.68, 0.15, 0.31]
    directors: {rotation_vector: [0, 2.4, 0.6]}
"""


@pytest.mark.parametrize(
    "rest, stations",
    [
        ("loads: {points: [{at: 0.5, force: {x: 1}}]}", 1),
        ("supports: [{at: 0.3, position: {x: 0.2}}, {at: 0.6, position: {x: 0.4}}]", 2),
        (
            "transcription: {type: shooting}\nsupports: [{at: 0.5, position: {x: 0.3}}]\n"
            "loads: {points: [{at: 0.5, force: {x: 1}}]}",
            1,
        ),
    ],
)
def test_scenes_in_pieces_are_counted(rest: str, stations: int) -> None:
    plain = loads_scene(CLAMPED + rest.partition("supports")[0].partition("loads")[0])
    told = check_scene(loads_scene(CLAMPED + rest))
    assert len(told["conditions"]) == sum(told["unknowns"].values())
    assert told["size"] >= check_scene(plain)["size"] + 3 * stations


@pytest.mark.parametrize(
    "supports, said",
    [
        ("[{at: 0.1, position: {x: 0.2}}]", "boundary.start.position and supports.0.position"),
        ("[{at: 0.8, position: {x: 0.2}}]", "supports.0.position and boundary.end.position"),
        (
            "[{at: 0.5, position: {x: 0.25}}, {at: 0.3, position: {x: 0}}]",
            "supports.1.position and supports.0.position are 0.25 apart, the ribbon is 0.2 long",
        ),
    ],
)
def test_supports_that_no_ribbon_reaches(supports: str, said: str) -> None:
    with pytest.raises(ConvergenceError, match=f"unreachable: {said}"):
        check_scene(loads_scene(f"{CLAMPED}supports: {supports}"))


def test_an_end_is_no_place_between_the_ends() -> None:
    with pytest.raises(SceneError, match="found 0, is the start of the ribbon: write it under"):
        loads_scene(CLAMPED + "loads: {points: [{at: 0, force: {x: 1}}]}")


def test_more_places_than_can_be_solved() -> None:
    many = ", ".join(f"{{at: {i / 102}, force: {{x: 1}}}}" for i in range(1, 102))
    with pytest.raises(SceneError, match="found 101 items, expected at most 100"):
        loads_scene(f"{CLAMPED}loads: {{points: [{many}]}}")


def test_an_empty_vector_is_told_as_it_was_written() -> None:
    with pytest.raises(SceneError, match=r"found \{at: 0.5, force: \{\}\}, expected a force or"):
        loads_scene(CLAMPED + "loads: {points: [{at: 0.5, force: {}}]}")
