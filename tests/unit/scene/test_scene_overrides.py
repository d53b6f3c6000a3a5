"""Overrides such as `law.epsilon=1e-3`: what they replace and how they are cited."""

from typing import Any

import pytest
from half_scene import SCENE, changed, refusal
from hypothesis import given
from hypothesis import strategies as st

from ribbonopt import scene as room
from ribbonopt.errors import SceneError
from ribbonopt.scene import Scene, loads_scene


@pytest.mark.parametrize(
    ("override", "get", "value"),
    [
        ("law.epsilon=1e-3", lambda s: s.law.epsilon, 1e-3),
        ("boundary.start.position.2=0.5", lambda s: s.boundary.start.position, (0.0, 0.0, 0.5)),
        ("law={type: sadowsky}", lambda s: s.law, room.Sadowsky()),
        ("law = {type: sadowsky}", lambda s: s.law, room.Sadowsky()),
        ("solver.type=newton", lambda s: s.solver, room.Newton()),
        (
            "transcription={type: collocation, degree: 3}",
            lambda s: s.transcription,
            room.Collocation(degree=3),
        ),
        ("boundary.end.d3.x=1 - turn", lambda s: s.boundary.end.d3, room.LabVector(x="1 - turn")),
        ("boundary.also=[]", lambda s: s.boundary.also, ()),
        ("boundary.also.0=u2(end) = 1", lambda s: s.boundary.also, ("u2(end) = 1",)),
        ("boundary.end.d1=", lambda s: s.boundary.end.d1, None),
    ],
)
def test_overrides(override: str, get: Any, value: Any) -> None:
    assert get(loads_scene(SCENE, overrides=[override])) == value


def test_overrides_apply_in_turn_and_begin_empty_mappings() -> None:
    text = "name: a\nlaw: {type: sadowsky}\nboundary:\nguess: {solution: b}\n"
    overrides = ["boundary.end.position.x=1", "boundary.end.position.x=2"]
    scene = loads_scene(text, overrides=overrides)
    assert scene.boundary.end.position == room.LabVector(x=2.0)


def test_override_of_an_alias_leaves_its_anchor() -> None:
    text = changed("position: [0, 0, 0]", "position: &p [0, 0, 0]").replace(
        "d1: {x: 0}", "force: *p"
    )
    scene = loads_scene(text, overrides=["boundary.end.force.0=7"])
    assert scene.boundary.start.position == (0.0, 0.0, 0.0)
    assert scene.boundary.end.force == (7.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("law.epsilon=-1", "s.yaml, --set law.epsilon=-1: found -1, expected a number >= 0"),
        (
            "law={type: sadowsky, epsilon: 1}",
            "s.yaml, --set law={type: sadowsky, epsilon: 1}, law.",
        ),
        ("law.epsilonn=1", "s.yaml, --set law.epsilonn=1: unknown key; did you mean 'epsilon'?"),
        ("lw.epsilon=1", "s.yaml, --set lw.epsilon=1, lw: unknown key; did you mean 'law'?"),
        ("law.type=sadowsky", "s.yaml, line 4, law.epsilon: unknown key"),
        ("law={}", "s.yaml, --set law={}, law.type: missing"),
        ("law.epsilon=!!x 1", "s.yaml: 2 problems\n  --set law.epsilon=!!x 1: tag !!x is refused"),
        ("law.epsilon", "--set law.epsilon: expected path=value"),
        ("=1", "--set =1: expected path=value"),
        ("law..epsilon=1", "--set law..epsilon=1: expected path=value"),
        ("law.epsilon=[1", "--set law.epsilon=[1: the value is not YAML"),
        ("law.epsilon.x=1", "--set law.epsilon.x=1: law.epsilon is 0.01, which has no key 'x'"),
        (
            "interval.2=1",
            "--set interval.2=1: interval is a list of 2 items; found '2', expected a",
        ),
        ("interval.-1=1", "--set interval.-1=1: interval is a list of 2 items; found '-1'"),
        ("interval.x=1", "--set interval.x=1: interval is a list of 2 items; found 'x'"),
    ],
)
def test_refused_overrides(override: str, message: str) -> None:
    assert refusal(SCENE, override).startswith(message)


@given(
    st.text(max_size=30)
    | st.tuples(st.sampled_from(["law", "boundary.end", "interval.1"]), st.text(max_size=10)).map(
        "=".join
    )
)
def test_any_override_gives_a_scene_or_a_scene_error(override: str) -> None:
    try:
        assert isinstance(loads_scene(SCENE, overrides=[override]), Scene)
    except SceneError:
        pass
