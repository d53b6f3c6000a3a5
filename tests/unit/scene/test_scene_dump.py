"""Scenes out: YAML text that loads back to an equal scene, and the JSON schema."""

import dataclasses
import json
from collections.abc import Iterator
from typing import Any

import pytest
from half_scene import SCENE
from hypothesis import assume, given
from hypothesis import strategies as st

from ribbonopt import scene as room
from ribbonopt.errors import SceneError
from ribbonopt.scene import Scene, dump_scene, json_schema, limits, loads_scene
from ribbonopt.text import name_fault


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


def within(least: float, most: float, **more: bool) -> Any:
    """Return the strategy of numbers that are zero or large enough that squares are not."""
    drawn = st.floats(least, most, **more)
    return drawn.filter(lambda value: value == 0 or abs(value) >= limits.SMALLEST)


floats = within(-1e4, 1e4)  # in any units below within `ribbonopt.scene.limits`
of_any_size = within(-limits.LARGEST, limits.LARGEST)
values = st.one_of(floats, st.sampled_from(["turn", "1 - turn", "2*pi", "1e-3", "1"]))
triples = st.tuples(values, values, values)
partial = within(-0.5, 0.5) | st.none()
lab = st.builds(room.LabVector, *[values | st.none()] * 3)
director = st.none() | st.builds(room.LabVector, partial, partial)
loads = st.none() | triples | st.builds(room.AnyVector, *[values | st.none()] * 6)
positive = st.floats(limits.SMALLEST, 1.0)
laws = st.one_of(
    st.builds(room.Kirchhoff, B2=st.floats(1e-2, 1e2), B3=st.floats(1e-8, 1e8)),
    st.builds(room.Sadowsky),
    st.builds(room.SingleSheet, chi=st.sampled_from([1, -1])),
    st.builds(room.Regularized, epsilon=positive),
    st.builds(room.Homotopy, rho=within(0, 1), epsilon=positive),
    st.builds(room.Variational, delta=within(0, 1, exclude_min=True)),
)
ends = st.builds(
    room.End,
    position=st.none() | triples | lab,
    directors=st.sampled_from([None, "identity", room.Directors((1.0, 0.0, 0.0), None, (0, 1, 0))]),
    force=loads,
    moment=loads,
) | st.builds(room.End, d1=director, d2=director, d3=director)
numbers = st.tuples(floats, floats, floats)
turns = st.sampled_from(["x", "y", "z", "d1", "d2", "d3"]).flatmap(
    lambda axis: st.builds(room.Turn, **{axis: values})
)
rotations = st.one_of(
    st.just("identity"),
    st.sampled_from([room.Quaternion((0.6, 0.0, -0.8, 0.0)), room.Quaternion(("turn", 0.5) * 2)]),
    st.builds(room.RotationVector, triples),
    st.lists(turns, min_size=1).map(lambda several: room.Turns(tuple(several))),
)
along = st.sampled_from([(0.0, 0.0, 1.0), ("turn", 0.0, 1e-3)])
held = st.builds(
    room.End,
    st.just("held"),
    distance=positive | st.just("turn"),
    moment=st.none() | triples,
)
supports = st.one_of(
    st.builds(room.End, st.just("clamped"), triples, rotations),
    st.builds(room.End, st.just("pinned"), triples, moment=st.none() | triples),
    st.builds(
        room.End,
        st.just("hinged"),
        triples,
        axis=st.just("d2"),
        along=along,
        moment=st.builds(room.AnyVector, d2=values) | st.none(),
    ),
)
loose = st.one_of(
    st.builds(room.End, st.just("sliding"), triples, rotations, along=along),
    st.builds(room.End, st.just("free"), force=st.none() | triples, moment=st.none() | triples),
    st.builds(room.End, st.just("flip"), triples, axis=st.just("d1"), along=along),
)
few = st.integers(-limits.HALF_TWISTS, limits.HALF_TWISTS)
loops = st.builds(room.Loop, few, st.sampled_from(["whole", "half"])) | st.builds(
    room.Loop, st.integers(-limits.HALF_TWISTS, -2), st.just("fundamental")
)
boundaries = st.one_of(
    st.builds(room.Boundary, supports, supports | loose | held),
    st.builds(room.Boundary, loose, supports | loose),
    st.builds(room.Boundary, loop=loops),
)
# Fewer than two half twists have no piece smaller than a half.
bands = st.builds(room.Band, few.filter(bool), st.sampled_from(["whole", "half"])) | st.builds(
    room.Band, few.filter(lambda count: abs(count) > 1), st.just("fundamental")
)
guesses = st.one_of(
    st.sampled_from(["auto", "circle"]),
    st.builds(room.StrainGuess, st.tuples(floats, floats)),
    st.builds(room.ArcGuess, values),
    st.builds(room.HelixGuess, st.builds(room.Helix, values, within(-1, 1))),
    st.builds(room.MoebiusGuess, bands),
)
ribbons = st.lists(st.floats(0.1, 10), min_size=3, max_size=3, unique=True).flatmap(
    lambda sizes: st.builds(
        room.RibbonSizes,
        *(st.just(size) for size in sorted(sizes, reverse=True)),
        youngs_modulus=st.floats(1e8, limits.LARGEST),
        poisson_ratio=within(-1, 0.5, exclude_min=True),
    )
)
words = ["1e-2", "yes", "null", "1:30", "a: b", "0x1", "# x", "\x85", "~", "'", "!a", "&a", "%a"]
text = st.text() | st.sampled_from(words)
letters = st.text(st.characters(categories=["L", "M", "N", "S", "P"]), min_size=1, max_size=20)
scenes = st.builds(
    Scene,
    name=(text | letters).filter(lambda name: not name_fault(name)),
    law=laws,
    boundary=st.builds(
        room.Boundary,
        start=ends,
        end=ends,
        also=st.sampled_from([(), ("n = [0, 0, 0]",), ("n = ex", "u2(end) = 1e-2*turn")]),
    ),
    guess=st.builds(room.LoadGuess, force=numbers, moment=numbers)
    | st.builds(room.SolutionGuess, solution=text),
    states=st.sampled_from(["reduced", "full"]),
    interval=st.tuples(floats, st.floats(0.1, 10)).map(lambda two: (two[0], sum(two))),
    parameters=st.dictionaries(st.just("other"), of_any_size).map(
        lambda some: {"turn": 0.5, **some}
    ),
    transcription=st.builds(
        room.Collocation,
        scheme=st.sampled_from(["gauss", "radau"]),
        degree=st.integers(1, 10),
        intervals=st.integers(1, limits.INTERVALS),
    ),
    solver=st.builds(room.Newton, tolerance=positive) | st.builds(room.Ipopt, tolerance=positive),
)


@given(scenes)
def test_dump_loads_back_to_an_equal_scene(scene: Scene) -> None:
    assert loads_scene(dump_scene(scene)) == scene


@given(
    boundaries,
    guesses,
    ribbons | st.none(),
    st.integers(1, limits.STARTS),
    st.integers(0, limits.SEED),
)
def test_supports_loops_guesses_and_sizes_load_back(
    boundary: room.Boundary, guess: Any, ribbon: Any, starts: int, seed: int
) -> None:
    assume(not boundary.loop or guess == "auto")
    scene = Scene(
        "one",
        room.Sadowsky(),
        boundary,
        guess,
        starts,
        seed,
        parameters={"turn": 0.5},
        ribbon=ribbon,
    )
    if ribbon:
        scene = dataclasses.replace(scene, interval=(0.0, ribbon.length))
    assert loads_scene(dump_scene(scene)) == scene


def test_dump_of_supports_is_readable() -> None:
    boundary = room.Boundary(
        room.End("clamped", (0, 0, 0), room.Turns((room.Turn(x="90*deg"), room.Turn(d3=1)))),
        room.End("held", distance=0.5),
    )
    text = dump_scene(Scene("one", room.Sadowsky(), boundary, room.MoebiusGuess(room.Band(3))))
    assert "directors:\n" in text
    assert "- {x: 90*deg}" in text
    assert "end: {support: held, distance: 0.5}" in text
    assert "moebius: {half_twists: 3}" in text
    assert "guess" not in dump_scene(
        Scene("one", room.Sadowsky(), room.Boundary(loop=room.Loop(1)), "auto")
    )


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
    assert set(schema["required"]) == {"name", "law", "boundary"}
    *laws, names = schema["properties"]["law"]["oneOf"]
    types = {law["properties"]["type"]["const"] for law in laws}
    assert set(names["enum"]) == types
    assert types == {
        "kirchhoff",
        "rod",
        "sadowsky",
        "single_sheet",
        "regularized",
        "homotopy",
        "variational",
        "wunderlich",
        "extensible",
        "sano",
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
    assert {"clamped", "flip"} < set(end["support"]["oneOf"][0]["enum"])
    assert schema["properties"]["guess"]["default"] == "auto"
    collocation = schema["properties"]["transcription"]["oneOf"][0]
    degree = collocation["properties"]["degree"]
    assert (degree["minimum"], degree["maximum"], degree["type"]) == (1, 10, "integer")
    named = [part for part in objects(schema) if "properties" in part]
    assert all(part["additionalProperties"] is False for part in named)
    assert all(part["description"] for part in named)
    assert laws[2]["description"] == room.Sadowsky.__doc__
