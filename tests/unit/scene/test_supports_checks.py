"""Supports, rotations, loops, guesses and sizes that a scene cannot have, and those it can."""

import math
from dataclasses import fields
from pathlib import Path
from typing import Any, get_args

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from ribbonopt.errors import SceneError
from ribbonopt.scene import (
    AnyVector,
    ArcGuess,
    Band,
    Boundary,
    Directors,
    End,
    Helix,
    HelixGuess,
    LabVector,
    Loop,
    MoebiusGuess,
    Quaternion,
    RibbonSizes,
    RotationVector,
    Sadowsky,
    Scene,
    SupportName,
    Turn,
    Turns,
    json_schema,
    validate_scene,
)
from ribbonopt.scene.supports import EXAMPLES, SUPPORTS

PAGE = Path(__file__).parents[3] / "docs" / "scenes.md"
POINT = (0.0, 0.0, 0.0)
FIXED = End(position=POINT)
FREE = End()
#: one value of every key of an end
GIVEN: dict[str, Any] = {
    "position": POINT,
    "directors": "identity",
    "d1": LabVector(x=1),
    "d2": LabVector(x=0),
    "d3": LabVector(x=0),
    "axis": "d2",
    "along": (0.0, 1.0, 0.0),
    "distance": 0.5,
    "force": POINT,
    "moment": POINT,
}
SINGLES = ("d1", "d2", "d3")
NAMES: tuple[SupportName, ...] = get_args(SupportName)
SIZES = RibbonSizes(1.0, 0.1, 1e-3, 2e9, 0.3)
each_support = pytest.mark.parametrize("support", NAMES)


def supported(support: SupportName, **more: Any) -> End:
    """Return an end with a support, all keys that it needs, and more."""
    return End(support, **{key: GIVEN[key] for key in SUPPORTS[support].needs} | more)


def scene(end: End = FREE, start: End = FIXED, *, loop: Any = None, **values: Any) -> Scene:
    return Scene("test", Sadowsky(), Boundary(start, end, loop=loop), **values)


def refused(*ends: End, **values: Any) -> dict[str, str]:
    """Return the messages of a bad scene by path."""
    with pytest.raises(SceneError) as caught:
        validate_scene(scene(*ends, **values))
    first, *more = str(caught.value).removeprefix("scene: ").split("\n  ")
    parts = [line.partition(": ") for line in more or [first]]
    return {path: message for path, _, message in parts}


def refusal(path: str, *ends: End, **values: Any) -> str:
    """Return the only message of a bad scene, which is about a path."""
    messages = refused(*ends, **values)
    assert list(messages) == [path]
    return messages[path]


def test_names_are_those_of_the_declarations() -> None:
    assert tuple(SUPPORTS) == NAMES
    assert set(EXAMPLES) == {key for support in SUPPORTS.values() for key in support.keys}
    assert {f.name for f in fields(End)} == {"support", "edge", *SINGLES, *EXAMPLES}


@each_support
def test_readme_and_editors_tell_of_every_support(support: SupportName) -> None:
    assert f"| `{support}` |" in PAGE.read_text(encoding="utf-8")
    keys = json_schema()["properties"]["boundary"]["properties"]["end"]["properties"]
    assert f"{support}: {SUPPORTS[support].says}" in keys["support"]["description"]


@each_support
def test_a_support_is_content_with_what_it_needs(support: SupportName) -> None:
    validate_scene(scene(supported(support)))


@pytest.mark.parametrize(
    "end",
    [
        supported("pinned", moment=(0, 0, 1)),
        supported("pinned", moment=AnyVector(d1=0, d2=1, d3=0)),
        supported("pinned", position=LabVector(0, 0, "turn")),
        supported("hinged", moment=AnyVector(d2=1)),
        supported("hinged", along=(0, 1e-3, "turn")),
        supported("sliding", force=AnyVector(y=-1)),
        supported("sliding", force=(0, "turn", 1)),
        supported("free", force=(0, 0, 1), moment=AnyVector(x=0, y=0, z=0)),
        supported("free", force=AnyVector(d1=0, d2=0, d3=1)),
        supported("held", distance="turn", moment=(0, 0, 1)),
        End("clamped", POINT, directors=Directors((0, 1, 0), None, (1, 0, 0))),
        End("clamped", POINT, d1=(1, 0, 0), d2=LabVector(0, 1, 0)),
        End("sliding", POINT, d1=(1, 0, 0), d2=(0, 1, 0), d3=(0, 0, 1), along=(0, 0, 1)),
    ],
)
def test_what_a_support_takes(end: End) -> None:
    validate_scene(scene(end, parameters={"turn": 0.5}))


@each_support
def test_a_support_says_what_it_lacks(support: SupportName) -> None:
    for key in SUPPORTS[support].needs:
        end = supported(support, **{key: None})
        message = refusal("boundary.end", end)
        assert message == f'support: {support} needs {key}; add for example "{EXAMPLES[key]}"'
    if needs := SUPPORTS[support].needs:
        message = refusal("boundary.end", End(support))
        assert all(EXAMPLES[key] in message for key in needs)


def test_what_is_lacking_is_listed_with_an_example() -> None:
    assert refusal("boundary.end", End("hinged", POINT)) == (
        'support: hinged needs axis and along; add for example "axis: d2, along: [0, 1, 0]"'
    )


@each_support
@pytest.mark.parametrize("key", GIVEN)
def test_a_support_contradicts_every_other_key(support: SupportName, key: str) -> None:
    knows = SUPPORTS[support].keys
    if key in knows or (key in SINGLES and "directors" in knows):
        return
    messages = refused(supported(support, **{key: GIVEN[key]}))
    message = messages[f"boundary.end.{key}"]
    assert f"contradicts support: {support}, which takes only" in message
    assert 'write for example "support: ' in message


def test_a_load_that_a_support_does_not_take_is_a_reaction() -> None:
    message = refusal("boundary.end.force", supported("clamped", force=POINT))
    assert "(this load is a reaction there, or zero)" in message


@pytest.mark.parametrize(
    ("end", "path", "words"),
    [
        (supported("pinned", position=LabVector(x=0, z="turn")), "position", '[0, 0, turn]"'),
        (supported("clamped", position=LabVector()), "position", "found {}, support: clamped need"),
        (
            supported("free", force=AnyVector(x=0, y=1)),
            "force",
            "found {x: 0, y: 1}, support: free",
        ),
        (supported("free", moment=AnyVector(x=0, y=1, z=0, d1=0)), "moment", '"moment: [0, 0, 0]"'),
        (supported("pinned", moment=AnyVector(d1=0)), "moment", "{d1: 0, d2: 0, d3: 0}"),
        (supported("held", moment=AnyVector()), "moment", "needs all its components"),
        (supported("hinged", moment=POINT), "moment", 'for example "moment: {d2: 0}"'),
        (
            supported("hinged", moment=AnyVector(d1=0)),
            "moment",
            "about the hinge, d2, and no other",
        ),
        (supported("hinged", moment=AnyVector(d2=0, x=0)), "moment", "found {x: 0, d2: 0}"),
        (supported("sliding", force=AnyVector(d2=0)), "force", 'for example "force: {y: 0}"'),
        (supported("sliding", force=AnyVector(d1=0, y=0)), "force", "in lab components"),
        (supported("sliding", force=AnyVector(x=0, z=0)), "force", "x and z is across it"),
        (supported("sliding", force=AnyVector(z=1)), "force", "z is across it"),
        (supported("hinged", along=POINT), "along", 'write for example "along: [0, 1, 0]"'),
        (
            supported("flip", along=(0, "0*turn", 0)),
            "along",
            "found [0, 0*turn, 0], expected a dir",
        ),
        (supported("held", distance=0), "distance", "found 0, expected a number > 0"),
        (supported("held", distance="0.5 - 2*turn"), "distance", "found -0.5, expected"),
        (supported("held", distance="1/0"), "distance", "no finite real value"),
        (supported("hinged", along=(0, "trun", 0)), "along.1", "did you mean 'turn'"),
        (End("clamped", POINT, d1=(1, 0, 0), d2=(0, 1, 0), d3=LabVector(x=0)), "d3", "remove it"),
    ],
)
def test_values_that_do_not_suit_a_support(end: End, path: str, words: str) -> None:
    assert words in refusal(f"boundary.end.{path}", end, parameters={"turn": 0.5})


def test_single_directors_are_no_frame() -> None:
    end = End("clamped", POINT, d1=(1, 0, 0), d2=LabVector(x=0))
    message = refusal("boundary.end", end)
    assert 'write for example "directors: identity" in place of d1 and d2' in message


@pytest.mark.parametrize("key", ["axis", "along", "distance"])
def test_keys_of_supports_are_nothing_without_one(key: str) -> None:
    message = refusal(f"boundary.end.{key}", End(**{key: GIVEN[key]}))
    users = [support for support in SUPPORTS if key in SUPPORTS[support].keys]
    assert message.startswith("is used only with support: ")
    assert all(user in message for user in users)
    assert f'write for example "support: {users[0]}"' in message


def test_held_is_of_the_end() -> None:
    message = refusal("boundary.start.support", FREE, End("held", distance=0.5))
    assert '"end: {support: held, distance: 0.5}"' in message
    message = refusal("boundary.start.distance", FREE, End(distance=0.5))
    assert '"end: {support: held, distance: 0.5}"' in message


@pytest.mark.parametrize("start", ["clamped", "pinned", "hinged"])
def test_a_string_goes_to_a_fixed_start(start: SupportName) -> None:
    validate_scene(scene(supported("held"), supported(start)))


@pytest.mark.parametrize(
    ("start", "path", "words"),
    [
        (FREE, "", 'add for example "position: [0, 0, 0]"'),
        (End(position=LabVector(y=1)), ".position", 'for example "position: [0, 1, 0]"'),
        (supported("sliding"), ".support", "found 'sliding', support: held at the end is a"),
        (supported("free"), ".support", 'write for example "support: pinned"'),
        (supported("flip"), ".support", "which flip is not"),
    ],
)
def test_a_string_goes_to_no_moving_start(start: End, path: str, words: str) -> None:
    assert words in refusal(f"boundary.start{path}", supported("held"), start)


@pytest.mark.parametrize(
    ("rotation", "path", "words"),
    [
        (Quaternion((1, 1, 0, 0)), ".quaternion", "has length 1.41421, expected 1 (it is no rot"),
        (Quaternion((1, 1, 0, 0)), ".quaternion", '"quaternion: [0.707106781, 0.707106781, 0, 0]"'),
        (Quaternion((0, 0, 0, 0)), ".quaternion", '"quaternion: [1, 0, 0, 0]"'),
        (Quaternion((1 + 2e-6, 0, 0, 0)), ".quaternion", "expected 1"),
        (Quaternion((1, "turn", 0, 0)), ".quaternion", "has length 1.11803"),
        (Quaternion((1, "trun", 0, 0)), ".quaternion.1", "did you mean 'turn'"),
        (RotationVector((0, 0, "1/0")), ".rotation_vector.2", "no finite real value"),
        (Turns(()), ".turns", 'write for example "turns: [{x: 90*deg}]"'),
        (Turns((Turn(),)), ".turns.0", "found {}, expected one axis"),
        (Turns((Turn(x=1), Turn(x=1, d2="turn"))), ".turns.1", 'example "{x: 1}, {d2: turn}"'),
        (Turns((Turn(z="90deg"),)), ".turns.0.z", "formula '90deg'"),
        (Directors((1, 0, 0)), "", "needs two or three of d1, d2, d3"),
    ],
)
def test_rotations_that_are_none(rotation: Any, path: str, words: str) -> None:
    end = End(directors=rotation)
    assert words in refusal(f"boundary.end.directors{path}", end, parameters={"turn": 0.5})


angles = st.floats(-10, 10)
axes = st.sampled_from(["x", "y", "z", *SINGLES])
turns = st.lists(st.tuples(axes, angles), min_size=1).map(
    lambda pairs: Turns(tuple(Turn(**{axis: angle}) for axis, angle in pairs))
)


@given(turns | st.builds(RotationVector, st.tuples(angles, angles, angles)))
def test_turns_and_rotation_vectors_are_rotations(rotation: Any) -> None:
    validate_scene(scene(End(directors=rotation)))


@given(st.tuples(angles, angles, angles, angles), st.floats(0.5, 2))
def test_quaternions_are_rotations_if_they_are_of_length_1(
    numbers: tuple[float, ...], scale: float
) -> None:
    length = math.hypot(*numbers)
    assume(length > 1e-3)
    w, x, y, z = (number / length for number in numbers)
    validate_scene(scene(End(directors=Quaternion((w, x, y, z)))))
    assume(abs(scale - 1) > 1e-5)
    scaled = Quaternion((scale * w, scale * x, scale * y, scale * z))
    assert "no rotation" in refusal("boundary.end.directors.quaternion", End(directors=scaled))


PLACED = End(position=POINT, directors=RotationVector((0, 1, 0)))


@pytest.mark.parametrize("half_twists", [-3, 0, 2])
def test_loops(half_twists: int) -> None:
    for piece in ("whole", "half"):
        for start in (FREE, PLACED):
            validate_scene(scene(FREE, start, loop=Loop(half_twists, piece)))
    if half_twists:
        guess = MoebiusGuess(Band(half_twists, "fundamental"))
        validate_scene(scene(FREE, FREE, loop=Loop(half_twists, "fundamental"), guess=guess))
    else:
        validate_scene(scene(FREE, FREE, loop=Loop(0), guess="circle"))


@pytest.mark.parametrize("half_twists", [-1, 0, 1])
def test_nothing_is_smaller_than_a_half_below_two_half_twists(half_twists: int) -> None:
    for path, values in (
        ("boundary.loop", {"loop": Loop(half_twists, "fundamental")}),
        ("guess.moebius", {"guess": MoebiusGuess(Band(half_twists, "fundamental"))}),
    ):
        message = refusal(f"{path}.half_twists", FREE, FREE, **values)
        assert message.startswith(f"found {half_twists}, a band of fewer than two half twists")
        assert 'for example "piece: half"' in message


def test_the_end_of_a_loop_follows_from_it() -> None:
    end = End("pinned", POINT)
    message = refusal("boundary.end", end, FREE, loop=Loop(1, "half"))
    assert message.startswith("`support` and `position` of the end follow from the loop; remove")
    assert '"loop: {half_twists: 1, piece: half}" says it all' in message


@pytest.mark.parametrize("key", ["support", *GIVEN])
def test_the_start_of_a_loop_has_a_place_and_no_more(key: str) -> None:
    start = End(**{key: GIVEN.get(key, "free")})
    whole = scene(FREE, start, loop=Loop(1))
    if key in ("position", "directors"):
        validate_scene(whole)
    else:
        message = refusal(f"boundary.start.{key}", FREE, start, loop=Loop(1))
        assert 'as in "start: {position: [0, 0, 0], directors: identity}"' in message
    message = refusal(f"boundary.start.{key}", FREE, start, loop=Loop(2, "fundamental"))
    assert "lies where the symmetry of its loop puts it; remove it" in message


def test_the_place_of_a_loop_is_whole() -> None:
    message = refusal("boundary.start.position", FREE, End(position=LabVector(x=1)), loop=Loop(1))
    assert message.endswith(
        'a loop needs all three components; write for example "position: [1, 0, 0]"'
    )


def test_loop_and_guess_agree_on_half_twists() -> None:
    guess = MoebiusGuess(Band(3))
    message = refusal("guess.moebius.half_twists", FREE, FREE, loop=Loop(-1), guess=guess)
    assert message.startswith("found 3, contradicts boundary.loop, half_twists: -1; one of them")
    assert '"half_twists: -1"' in message
    message = refusal("guess", FREE, FREE, loop=Loop(1, "half"), guess="circle")
    assert '"guess: {moebius: {half_twists: 1, piece: half}}"' in message
    validate_scene(scene(guess=guess))
    validate_scene(scene(guess="circle"))


@pytest.mark.parametrize(
    ("guess", "path"),
    [
        (ArcGuess("1/0"), "guess.arc"),
        (ArcGuess("2*turm"), "guess.arc"),
        (HelixGuess(Helix("sqrt(-1)", 0.5)), "guess.helix.turns"),
    ],
)
def test_formulas_of_guesses_have_values(guess: Any, path: str) -> None:
    assert "formula" in refusal(path, guess=guess, parameters={"turn": 1.0})
    validate_scene(scene(guess=ArcGuess("2*turn"), parameters={"turn": 1.0}))


def sizes(**changes: float) -> RibbonSizes:
    return RibbonSizes(**{name: getattr(SIZES, name) for name in SIZES.__annotations__} | changes)


@pytest.mark.parametrize(
    ("changes", "interval", "loop", "example"),
    [
        ({"length": 0.3}, (0, 1), None, "interval: [0, 0.3]"),
        ({"length": 0.3}, (0.1, 0.5), None, "interval: [0.1, 0.4]"),
        ({"length": 0.3}, (0, 1), Loop(1, "half"), "interval: [0, 0.15]"),
        ({"length": 0.3}, (0, 1), Loop(-3, "fundamental"), "interval: [0, 0.05]"),
        ({"length": 1 - 1e-8}, (0, 1), None, "interval: [0, 0.99999999]"),
    ],
)
def test_the_interval_fits_into_the_ribbon(
    changes: Any, interval: Any, loop: Any, example: str
) -> None:
    message = refusal("interval", FREE, FREE, ribbon=sizes(**changes), interval=interval, loop=loop)
    assert "is longer than the ribbon, ribbon.length: " in message
    assert f'write for example "{example}"' in message


@pytest.mark.parametrize(
    ("changes", "path", "words"),
    [
        ({"width": 1.0}, "ribbon.width", "found 1, expected less than ribbon.length, 1;"),
        ({"width": 20.0}, "ribbon.width", "metres, moduli in pascals; for 1 mm write"),
        ({"thickness": 0.1}, "ribbon.thickness", "found 0.1, expected less than ribbon.width, 0.1"),
        ({"thickness": 0.5}, "ribbon.thickness", '"thickness: 0.001"'),
    ],
)
def test_sizes_of_the_ribbon_decrease(changes: Any, path: str, words: str) -> None:
    assert words in refusal(path, ribbon=sizes(**changes))


def test_a_piece_of_a_ribbon_may_be_solved() -> None:
    validate_scene(scene(ribbon=sizes(length=2.0)))
    validate_scene(scene(ribbon=sizes(length=0.3), interval=(0, 0.1 + 0.2)))


def test_all_problems_are_told_at_once() -> None:
    start = End("held", distance=-1, directors=Quaternion((1, 1, 0, 0)))
    end = End("sliding", LabVector(x=0), along=POINT, moment=POINT)
    messages = refused(end, start, guess=ArcGuess("1/0"), ribbon=sizes(length=0.5, width=0.6))
    assert set(messages) == {
        "boundary.start.support",
        "boundary.start.distance",
        "boundary.start.directors.quaternion",
        "boundary.end",
        "boundary.end.position",
        "boundary.end.along",
        "boundary.end.moment",
        "guess.arc",
        "interval",
        "ribbon.width",
    }
