"""Scenes out: YAML text that loads back to an equal scene, and the JSON schema."""

import dataclasses
import json
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ribbonopt import scene as room
from ribbonopt.errors import SceneError
from ribbonopt.scene import Scene, dump_scene, json_schema, loads_scene

SCENE = """\
name: half
law:
  type: regularized
  epsilon: 1e-2
interval: [0, 0.5]
boundary:
  start: {position: [0, 0, 0], directors: identity}
  end:
    position: {y: 0, z: 1 - turn}
    d1: {x: 0}
  also:
    - dot(n, d1(start)) = 0
parameters: {turn: .5}
guess: {force: [0, 40, 40], moment: [0, 2, -9]}
"""


def test_dump_is_readable_and_omits_defaults() -> None:
    text = dump_scene(
        loads_scene(
            SCENE + "transcription: {type: collocation, degree: 6}\nsolver: {type: newton}\n"
        )
    )
    assert "law: {type: regularized}" in text
    assert "position: [0, 0, 0]" in text
    assert "solver: {type: newton}" in text
    assert "turn: 0.5" in text
    assert "transcription" not in text
    assert "null" not in text


def test_dump_refuses_what_would_not_load_back() -> None:
    scene = loads_scene(SCENE)
    with pytest.raises(SceneError, match=r"law\.epsilon"):
        dump_scene(dataclasses.replace(scene, law=room.Regularized(epsilon=-1)))


floats = st.floats(allow_nan=False, allow_infinity=False)
values = st.one_of(floats, st.sampled_from(["turn", "1 - turn", "2*pi", "1e-3", "1"]))
triples = st.tuples(values, values, values)
partial = st.floats(-0.5, 0.5) | st.none()
lab = st.builds(room.LabVector, *[values | st.none()] * 3)
director = st.none() | st.builds(room.LabVector, partial, partial)
loads = st.none() | triples | st.builds(room.AnyVector, *[values | st.none()] * 6)
positive = st.floats(0, exclude_min=True, allow_nan=False, allow_infinity=False)
laws = st.one_of(
    st.builds(room.Kirchhoff, B2=positive, B3=positive),
    st.builds(room.Sadowsky),
    st.builds(room.SingleSheet, chi=st.sampled_from([1, -1])),
    st.builds(room.Regularized, epsilon=positive),
    st.builds(room.Homotopy, rho=st.floats(0, 1), epsilon=positive),
    st.builds(room.Variational, delta=st.floats(0, 1, exclude_min=True)),
)
ends = st.builds(
    room.End,
    position=st.none() | triples | lab,
    directors=st.sampled_from([None, "identity", room.Directors((1.0, 0.0, 0.0), None, (0, 1, 0))]),
    force=loads,
    moment=loads,
) | st.builds(room.End, d1=director, d2=director, d3=director)
numbers = st.tuples(floats, floats, floats)
scenes = st.builds(
    Scene,
    name=st.text() | st.sampled_from(["1e-2", "yes", "null", "1:30", "a: b", "0x1", "# x", "\x85"]),
    law=laws,
    boundary=st.builds(
        room.Boundary,
        start=ends,
        end=ends,
        also=st.sampled_from([(), ("n = [0, 0, 0]",), ("n = ex", "u2(end) = 1e-2*turn")]),
    ),
    guess=st.builds(room.LoadGuess, force=numbers, moment=numbers)
    | st.builds(room.SolutionGuess, solution=st.text()),
    states=st.sampled_from(["reduced", "full"]),
    interval=st.tuples(floats, floats).filter(lambda pair: pair[0] < pair[1]),
    parameters=st.dictionaries(st.just("other"), floats).map(lambda some: {"turn": 0.5, **some}),
    transcription=st.builds(
        room.Collocation,
        scheme=st.sampled_from(["gauss", "radau"]),
        degree=st.integers(1, 10),
        intervals=st.integers(1, 10**6),
    ),
    solver=st.builds(room.Newton, tolerance=positive) | st.builds(room.Ipopt, tolerance=positive),
)


@given(scenes)
def test_dump_loads_back_to_an_equal_scene(scene: Scene) -> None:
    assert loads_scene(dump_scene(scene)) == scene


def objects(schema: Any) -> Iterator[dict[str, Any]]:
    for part in schema.values() if isinstance(schema, dict) else schema:
        if isinstance(part, dict | list):
            yield from objects(part)
    if isinstance(schema, dict) and schema.get("type") == "object":
        yield schema


def test_json_schema_describes_the_shorthands() -> None:
    schema = json_schema()
    json.dumps(schema)
    assert schema["$schema"].startswith("https://json-schema.org/")
    assert set(schema["properties"]) == {member.name for member in dataclasses.fields(Scene)}
    assert set(schema["required"]) == {"name", "law", "boundary", "guess"}
    laws = schema["properties"]["law"]["oneOf"]
    assert {law["properties"]["type"]["const"] for law in laws} == {
        "kirchhoff",
        "sadowsky",
        "single_sheet",
        "regularized",
        "homotopy",
        "variational",
    }
    assert all(law["required"] == ["type"] for law in laws)
    end = schema["properties"]["boundary"]["properties"]["end"]["properties"]
    kinds = [branch.get("type") or branch.get("const") for branch in end["position"]["oneOf"]]
    assert kinds == ["array", "object", "null"]
    assert (
        end["position"]["oneOf"][0]["prefixItems"]
        == [{"oneOf": [{"type": "number"}, {"type": "string"}]}] * 3
    )
    assert "identity" in [branch.get("const") for branch in end["directors"]["oneOf"]]
    collocation = schema["properties"]["transcription"]["oneOf"][0]
    degree = collocation["properties"]["degree"]
    assert (degree["minimum"], degree["maximum"], degree["type"]) == (1, 10, "integer")
    named = [part for part in objects(schema) if "properties" in part]
    assert all(part["additionalProperties"] is False for part in named)
    assert all(part["description"] for part in named)
    assert laws[1]["description"] == room.Sadowsky.__doc__
