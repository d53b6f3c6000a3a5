"""How a continuation has ended is told at any time: before, on the way, and at the end."""

from pathlib import Path

import pytest

from ribbonopt.scene import load_scene
from ribbonopt.studies.continuation.continuation import Continuation

STAGES = (
    "continuation=[{parameter: parameters.load, from: 0.1, to: 0.2}, "
    "{parameter: parameters.load, to: [0.25, 0.15]}]"
)


@pytest.fixture
def continuation(configs: Path) -> Continuation:
    return Continuation(load_scene(configs / "cantilever.yaml", [STAGES]))


def test_before_it_begins_nothing_has_ended(continuation: Continuation) -> None:
    ending = continuation.ending
    assert not ending.reached
    assert ending.reason == "not followed to the end yet: no stage has ended"


def test_it_has_ended_when_the_last_way_has(continuation: Continuation) -> None:
    told: list[tuple[bool, str]] = []
    for _ in continuation:
        ending = continuation.ending
        if (ending.reached, ending.reason) not in told:
            told.append((ending.reached, ending.reason))
    assert [reached for reached, _ in told] == [False] * len(told)
    assert told[0][1].endswith("no stage has ended")
    assert told[-1][1].endswith("1 of 2 stages have ended")
    assert continuation.ending.reached
    assert continuation.ending == continuation.endings[1, 1]


@pytest.mark.parametrize(
    ("stage", "reached"),
    [
        ("{parameter: parameters.load, from: 0.1, to: 0.3, largest: 0.01, points: 3}", False),
        ('{parameter: parameters.load, from: 0.1, to: 1, stop: ["energy > 1e-4"]}', True),
    ],
)
def test_one_that_ends_before_its_goal_is_told(configs: Path, stage: str, reached: bool) -> None:
    continuation = Continuation(load_scene(configs / "cantilever.yaml", [f"continuation={stage}"]))
    list(continuation)
    assert continuation.ending.reached == reached
    assert continuation.ending == continuation.endings[0, 0]
