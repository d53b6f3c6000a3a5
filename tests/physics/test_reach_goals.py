"""Goals of a continuation out of reach of the length: refused, with the value that is reached."""

import math
import re
from dataclasses import replace

import pytest

from ribbonopt.errors import ConvergenceError, ModelError
from ribbonopt.pipeline.prepared import solve
from ribbonopt.problem.wellposed.reach import refuse_far_goals
from ribbonopt.scene import Scene, loads_scene

HEAD = """\
name: taut
law: {type: variational, delta: 0.05}
parameters: {d: 0.5, w: 0}
"""
CLAMPED = (
    HEAD
    + """\
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, %s, %s], directors: identity}
continuation: %s
"""
)
STRING = (
    HEAD
    + """\
boundary:
  start: {support: pinned, position: [0, 0, 0]}
  end: {support: held, distance: d}
continuation: %s
"""
)


def scene(stage: str, across: str = "0", along: str = "d") -> Scene:
    return loads_scene(CLAMPED % (across, along, stage))


def refusal(of: Scene) -> ModelError:
    with pytest.raises(ModelError) as caught:
        refuse_far_goals(of)
    return caught.value


def limit_of(error: ModelError) -> float:
    found = re.search(r"it can go up to \S+ = (\S+),", str(error))
    assert found
    return float(found[1])


@pytest.mark.parametrize(
    ("stage", "across", "along", "key", "limit"),
    [
        ("{parameter: parameters.d, to: 1.5}", "0", "d", "to", 1),
        ("{parameter: parameters.d, to: -1.5}", "0", "d", "to", -1),
        ("{parameter: parameters.d, from: 0.5, to: [1.2, 0.1]}", "0", "d", "to.0", 1),
        ("{parameter: parameters.d, from: 0.5, to: [0.1, 1.2]}", "0", "d", "to.1", 1),
        ("{parameter: parameters.d, values: [0.5, 0.9, 1.1, 1.2]}", "0", "d", "values.2", 1),
        ("{parameter: parameters.d, to: 100, scale: log}", "0", "d", "to", 1),
        ("{parameter: parameters.w, to: 1}", "w", "0.95", "to", math.sqrt(1 - 0.95**2)),
        ("{parameter: interval.end, from: 1, to: 0.3}", "0", "0.5", "to", 0.5),
        # out of reach on the way alone: d (6 - 4 d) is 2.25 at most, for d = 0.75
        ("{parameter: parameters.d, from: 0, to: 1.5}", "0", "d*(6-4*d)", "to", (3 - 5**0.5) / 4),
        # for a short while alone: 1 + 1e-6 at d = 0.7123
        (
            "{parameter: parameters.d, from: 0, to: 1}",
            "0",
            "1 + 1e-6 - (d - 0.7123)**2",
            "to",
            0.7123 - 1e-3,
        ),
    ],
)
def test_goals_beyond_the_length_are_refused(
    stage: str, across: str, along: str, key: str, limit: float
) -> None:
    error = refusal(scene(stage, across, along))
    assert error.key == f"continuation.{key}"
    assert str(error).startswith(f"continuation.{key}: found ")
    assert limit_of(error) == pytest.approx(limit, rel=1e-8)
    # what it proposes is not refused
    found = re.search(r"such as (\S+)$", str(error))
    assert found
    data = scene(stage, across, along)
    assert data.continuation is not None
    assert not isinstance(data.continuation, tuple)
    refuse_far_goals(
        replace(data, continuation=replace(data.continuation, to=float(found[1]), values=None))
    )


def test_ends_of_a_string_are_as_far_apart_as_it_is_long() -> None:
    error = refusal(loads_scene(STRING % "{parameter: parameters.d, to: 1.2}"))
    assert limit_of(error) == pytest.approx(1, rel=1e-12)


def test_straight_is_in_reach_unless_it_is_held_across() -> None:
    refuse_far_goals(scene("{parameter: parameters.d, to: 1}"))
    error = refusal(scene("{parameter: parameters.d, to: 1}", "d*0.6", "d*0.8"))
    assert "would have to be straight, but is held across that line" in str(error)
    refuse_far_goals(scene("{parameter: parameters.d, to: 0.999999}", "d*0.6", "d*0.8"))


def test_stages_begin_where_the_ones_before_have_led() -> None:
    stages = "[{parameter: parameters.w, to: 0.9}, {parameter: parameters.d, to: %s}]"
    error = refusal(scene(stages % 0.45, "w", "d"))
    assert error.key == "continuation.0.to"
    error = refusal(scene(stages.replace("0.9", "0.8") % 0.7, "w", "d"))
    assert error.key == "continuation.1.to"
    assert limit_of(error) == pytest.approx(0.6, rel=1e-9)
    refuse_far_goals(scene(stages.replace("0.9", "0.8") % 0.59, "w", "d"))


def test_no_ribbon_is_straight_across_its_clamps() -> None:
    text = (CLAMPED % ("0.6", "0.8", "")).replace("continuation: \n", "")
    with pytest.raises(ConvergenceError, match="would have to be straight, but its directors"):
        solve(loads_scene(text))
    along = text.replace("identity", "{turns: [{x: -0.6435011087932844}]}")
    # straight, so that it is another matter what its loads are
    with pytest.raises(ConvergenceError, match="straight and without stress"):
        solve(loads_scene(along))
