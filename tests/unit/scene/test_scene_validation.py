"""Annotated dataclasses to instances: what is accepted, and every problem with its path."""

import dataclasses
import math
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

import numpy as np
import pytest

from ribbonopt.scene import (
    AnyVector,
    Band,
    Boundary,
    Collocation,
    Directors,
    End,
    Helix,
    HelixGuess,
    LabVector,
    LoadGuess,
    MoebiusGuess,
    Newton,
    Quaternion,
    Regularized,
    Sadowsky,
    Scene,
    SolutionGuess,
    Turn,
    Turns,
)
from ribbonopt.scene.faults import InvalidSceneError
from ribbonopt.scene.schema.bounds import Bounds
from ribbonopt.scene.schema.validation import check_of, validate

GOOD: dict[str, Any] = {
    "name": "one",
    "law": {"type": "regularized", "epsilon": 1},
    "boundary": {},
    "guess": {"force": [0, 1, 2], "moment": [3, 4, 5]},
}


def problems(**changes: Any) -> dict[str, str]:
    """Return the messages of a faulty scene by dotted path."""
    with pytest.raises(InvalidSceneError) as caught:
        validate(Scene, {**GOOD, **changes})
    return {".".join(map(str, p.path)): str(p) for p in caught.value.problems}


def test_builds_what_was_written() -> None:
    scene = validate(Scene, GOOD)
    assert scene == Scene(
        name="one",
        law=Regularized(epsilon=1.0),
        boundary=Boundary(),
        guess=LoadGuess(force=(0.0, 1.0, 2.0), moment=(3.0, 4.0, 5.0)),
    )
    assert isinstance(scene.law, Regularized)
    assert type(scene.law.epsilon) is float


def test_branches_are_picked_by_shape() -> None:
    start = {"position": [0, "a", 1], "directors": "identity", "force": {"d1": 0, "x": None}}
    end = {"position": {"y": 1}, "directors": {"d1": [1, 0, 0]}, "d3": None}
    scene = validate(Scene, {**GOOD, "boundary": {"start": start, "end": end}})
    assert scene.boundary.start.position == (0.0, "a", 1.0)
    assert scene.boundary.start.directors == "identity"
    assert scene.boundary.start.force == AnyVector(d1=0.0)
    assert scene.boundary.end.position == LabVector(y=1.0)
    assert scene.boundary.end.directors == Directors(d1=(1.0, 0.0, 0.0))


def test_guess_is_picked_by_its_keys() -> None:
    assert validate(Scene, {**GOOD, "guess": {"solution": "a"}}).guess == SolutionGuess("a")
    helix = {"turns": "2*turn", "rise": 0.5}
    assert validate(Scene, {**GOOD, "guess": {"helix": helix}}).guess == HelixGuess(Helix(**helix))
    band = validate(Scene, {**GOOD, "guess": {"moebius": {"half_twists": 3}}}).guess
    assert band == MoebiusGuess(Band(3))
    assert problems(guess={"solution": "a", "solutoin": 1}).keys() == {"guess.solutoin"}
    assert problems(guess={"force": [0, 1, 2]}).keys() == {"guess.moment"}


def test_guess_need_not_be_given() -> None:
    without = {key: value for key, value in GOOD.items() if key != "guess"}
    assert validate(Scene, without).guess == "auto"
    assert validate(Scene, {**GOOD, "guess": "circle"}).guess == "circle"


def test_rotations_are_picked_by_their_keys() -> None:
    turns = [{"x": "90*deg"}, {"d3": 1}]
    start = {"directors": {"quaternion": [1, 0, 0, "a"]}}
    end = {"directors": {"turns": turns}}
    boundary = validate(Scene, {**GOOD, "boundary": {"start": start, "end": end}}).boundary
    assert boundary.start.directors == Quaternion((1.0, 0.0, 0.0, "a"))
    assert boundary.end.directors == Turns((Turn(x="90*deg"), Turn(d3=1.0)))


def test_instances_are_checked_again() -> None:
    scene = validate(Scene, GOOD)
    assert validate(Scene, scene) == scene
    loose = dataclasses.replace(scene, interval=[0, 1], law=Regularized(epsilon=2))
    assert validate(Scene, loose).interval == (0.0, 1.0)
    wrong = dataclasses.replace(scene, law=Regularized(epsilon=-1), name=3)
    with pytest.raises(InvalidSceneError) as caught:
        validate(Scene, wrong)
    assert [p.path for p in caught.value.problems] == [("name",), ("law", "epsilon")]


def test_data_may_hold_instances() -> None:
    assert validate(Scene, {**GOOD, "law": Sadowsky()}).law == Sadowsky()
    assert "expected a mapping whose `type`" in problems(law=End())["law"]


COLLOCATION = {"type": "collocation"}


@pytest.mark.parametrize(
    ("changes", "path", "message"),
    [
        (
            {"law": {"type": "regularized", "epsilon": -1}},
            "law.epsilon",
            "found -1, expected a numb",
        ),
        (
            {"law": {"type": "regularized", "epsilon": True}},
            "law.epsilon",
            "found true, expected a ",
        ),
        (
            {"law": {"type": "regularized", "epsilon": "1"}},
            "law.epsilon",
            "found '1', expected a nu",
        ),
        ({"law": {"type": "regularized", "epsilon": math.inf}}, "law.epsilon", "must be finite"),
        ({"law": {"type": "regularized", "epsilon": math.nan}}, "law.epsilon", "must be finite"),
        ({"law": {"type": "regularized", "epsilon": 10**400}}, "law.epsilon", "expected a number"),
        ({"law": {"type": "homotopy", "rho": 2}}, "law.rho", "expected a number from 0 to 1"),
        ({"law": {"type": "variational", "delta": 0}}, "law.delta", "a number > 0 and <= 1"),
        ({"law": {"type": "sadowski"}}, "law.type", "did you mean 'sadowsky'?"),
        ({"law": {}}, "law.type", "missing; expected 'kirchhoff', "),
        ({"law": {"type": ["sadowsky"]}}, "law.type", "found ['sadowsky'], expected 'kirchhoff'"),
        ({"law": "sadowski"}, "law", "expected a mapping whose `type` is 'kirchhoff'"),
        (
            {"law": {"type": "sadowsky", "epsilon": 1}},
            "law.epsilon",
            "belongs to type 'regularized'",
        ),
        ({"law": {"type": "single_sheet", "chi": 2}}, "law.chi", "found 2, expected 1 or -1"),
        ({"law": {"type": "single_sheet", "chi": True}}, "law.chi", "found true, expected 1 or -1"),
        ({"law": {"type": "single_sheet", "chi": 1.0}}, "law.chi", "found 1.0, expected 1 or -1"),
        (
            {"transcription": COLLOCATION | {"degree": 0}},
            "transcription.degree",
            "a whole number from 1 to 10",
        ),
        (
            {"transcription": COLLOCATION | {"degree": 3.0}},
            "transcription.degree",
            "found 3.0, expected a whole",
        ),
        ({"transcription": COLLOCATION | {"degree": True}}, "transcription.degree", "found true"),
        (
            {"transcription": COLLOCATION | {"intervals": 0}},
            "transcription.intervals",
            "a whole number >= 1",
        ),
        (
            {"transcription": COLLOCATION | {"scheme": "gaus"}},
            "transcription.scheme",
            "did you mean 'gauss'?",
        ),
        ({"transcription": {"degree": 3}}, "transcription.type", "missing; expected 'collocation'"),
        ({"transcripton": {}}, "transcripton", "unknown key; did you mean 'transcription'?"),
        (
            {"solver": {"tolerance": 1}},
            "solver.type",
            "missing; expected 'auto', 'ipopt' or 'newton'",
        ),
        ({"interval": [0]}, "interval", "found [0], expected a list of 2 items"),
        ({"interval": [0, 1, 2]}, "interval", "found [0, 1, 2], expected a list of 2 items"),
        ({"interval": "0 1"}, "interval", "found '0 1', expected a list of 2 items"),
        ({"interval": [0, "1"]}, "interval.1", "found '1', expected a number"),
        ({"parameters": {"a": "b"}}, "parameters.a", "found 'b', expected a number"),
        ({"parameters": [1]}, "parameters", "expected a mapping of names"),
        ({"parameters": {3: 4}}, "parameters.3", "expected text as the key"),
        ({"name": None}, "name", "found null, expected text"),
        ({"guess": 1}, "guess", "a mapping with keys force, moment, or strains, or arc, or helix"),
        ({"guess": "atuo"}, "guess", "expected 'auto' or 'circle'; did you mean 'auto'?"),
        ({"guess": "none"}, "guess", "expected 'auto' or 'circle' or a mapping with keys force"),
        ({"guess": "moebius"}, "guess", "did you mean {moebius: ...}?"),
        ({"guess": {}}, "guess", "found {}, expected 'auto' or 'circle' or a mapping with keys"),
        ({"guess": {"moebuis": {}}}, "guess.moebuis", "unknown key; did you mean 'moebius'?"),
        ({"guess": {"arc": 1, "force": [0] * 3}}, "guess.arc", "cannot stand beside force, moment"),
        ({"guess": {"helix": {"turns": 3}}}, "guess.helix.rise", "missing; expected a number from"),
        ({"guess": {"helix": {"turns": 3, "rise": 2}}}, "guess.helix.rise", "from -1 to 1"),
        ({"solver": "newtn"}, "solver", "or that name alone; did you mean 'newton'?"),
        ({"starts": 0}, "starts", "found 0, expected a whole number >= 1"),
        ({"seed": -1}, "seed", "found -1, expected a whole number >= 0"),
        ({"boundary": None}, "boundary", "found null, expected a mapping with keys among start"),
        ({"boundary": {"also": "n = 0"}}, "boundary.also", "found 'n = 0', expected a list"),
        ({"boundary": {"also": [1]}}, "boundary.also.0", "found 1, expected text"),
        (
            {"boundary": {"end": {"d1": [1, 2]}}},
            "boundary.end.d1",
            "a list of 3 items, each a number",
        ),
        ({"boundary": {"end": {"d1": [1, 2, None]}}}, "boundary.end.d1.2", "a number or a formula"),
        ({"boundary": {"end": {"d1": {"w": 1}}}}, "boundary.end.d1.w", "known keys: x, y, z"),
        (
            {"boundary": {"end": {"d1": 7}}},
            "boundary.end.d1",
            "or a mapping with keys among x, y, z",
        ),
        ({"boundary": {"end": {"directors": "id"}}}, "boundary.end.directors", "'identity'"),
        ({"boundary": {"end": "clamped"}}, "boundary.end", "did you mean {support: clamped}?"),
        ({"boundary": {"end": {"support": "clampt"}}}, "boundary.end.support", "mean 'clamped'?"),
        ({"boundary": {"end": {"axis": "x"}}}, "boundary.end.axis", "expected 'd1', 'd2' or 'd3'"),
        (
            {"boundary": {"end": {"directors": {"quaternoin": [1, 0, 0, 0]}}}},
            "boundary.end.directors.quaternoin",
            "unknown key; did you mean 'quaternion'? (known keys: quaternion)",
        ),
        (
            {"boundary": {"end": {"directors": {"quaternion": [1, 0, 0]}}}},
            "boundary.end.directors.quaternion",
            "found [1, 0, 0], expected a list of 4 items",
        ),
        (
            {"boundary": {"end": {"directors": {"quaternion": [1, 0, 0, 0], "d1": [1, 0, 0]}}}},
            "boundary.end.directors.quaternion",
            "cannot stand beside d1, d2, d3; keep one",
        ),
        (
            {"boundary": {"end": {"directors": {"w": 1}}}},
            "boundary.end.directors",
            "'identity' or a mapping with keys d1, d2, d3, or quaternion, or rotation_vector, or",
        ),
        (
            {"boundary": {"end": {"directors": {"turns": [{"w": 1}]}}}},
            "boundary.end.directors.turns.0.w",
            "known keys: x, y, z, d1, d2, d3",
        ),
        (
            {"boundary": {"loop": {"half_twist": 1}}},
            "boundary.loop.half_twist",
            "unknown key; did you mean 'half_twists'? (known keys: half_twists, piece)",
        ),
        (
            {"boundary": {"loop": {"half_twists": 1.5}}},
            "boundary.loop.half_twists",
            "found 1.5, expected a whole number",
        ),
        (
            {"boundary": {"loop": {"half_twists": 1, "piece": "hal"}}},
            "boundary.loop.piece",
            "expected 'whole', 'half', 'fundamental' or 'auto'; did you mean 'half'?",
        ),
    ],
)
def test_one_problem_speaks_of_one_branch(changes: Any, path: str, message: str) -> None:
    found = problems(**changes)
    assert list(found) == [path]
    assert message in found[path]


def test_all_problems_at_once() -> None:
    found = problems(law={"type": "regularized", "epsilon": -1}, interval=3, colour=1)
    assert found.keys() == {"law.epsilon", "interval", "colour"}
    with pytest.raises(InvalidSceneError) as caught:
        validate(Scene, {})
    missing = {p.path for p in caught.value.problems}
    assert missing == {("name",), ("law",), ("boundary",)}


@pytest.mark.parametrize("data", [None, 3, "text", [], True])
def test_a_scene_is_a_mapping(data: object) -> None:
    with pytest.raises(InvalidSceneError, match="expected a mapping with keys among name"):
        validate(Scene, data)


def test_nothing_is_written_through_defaults() -> None:
    first, second = validate(Scene, GOOD), validate(Scene, GOOD)
    assert first.parameters is not second.parameters


def test_other_dataclasses_validate_too() -> None:
    @dataclass(frozen=True)
    class Inner:
        on: bool = False
        many: tuple[int, ...] = ()

    validated = validate(Inner, {"on": True, "many": [1, 2]})
    assert validated == Inner(on=True, many=(1, 2))
    for wrong in (1, "true", None):
        with pytest.raises(InvalidSceneError, match="expected true or false"):
            validate(Inner, {"on": wrong})


@pytest.mark.parametrize(
    "annotation", [list[int], int | float, set, Annotated[str | int | float, 1]]
)
def test_unsupported_annotations_are_refused(annotation: Any) -> None:
    with pytest.raises((TypeError, KeyError)):
        check_of(annotation)


def test_strictness_of_numbers_in_unions() -> None:
    @dataclass(frozen=True)
    class Mixed:
        value: Annotated[float, Bounds(lt=3)] | Literal["auto"] | None = None
        table: dict[str, float] = field(default_factory=dict)

    assert validate(Mixed, {"value": 2}) == Mixed(2.0)
    assert validate(Mixed, {"value": "auto"}) == Mixed("auto")
    for value, message in ((3, "a number < 3"), ("aut", "'auto'"), (True, "number < 3 or 'auto'")):
        with pytest.raises(InvalidSceneError, match=message):
            validate(Mixed, {"value": value})


def test_what_numpy_makes_becomes_plain() -> None:
    made = {"name": np.str_("a"), "interval": np.array([0, 1]), "tolerance": np.float32(0.25) / 4}
    scene = validate(Scene, {**GOOD, **made, "parameters": {np.str_("k"): np.int64(2)}})
    assert scene.interval == (0.0, 1.0)
    assert {type(value) for value in scene.interval} == {float}
    assert (type(scene.name), type(scene.tolerance)) == (str, float)
    assert [*map(type, [*scene.parameters, *scene.parameters.values()])] == [str, float]
    for wrong in (np.array(0.5), np.array([0.0, 0.5, 1.0]), "01", {"a": 1, "b": 2}, 5):
        assert problems(interval=wrong).keys() == {"interval"}
    assert problems(tolerance=np.bool_(True), seed=np.int64(1)).keys() == {"tolerance", "seed"}


def test_a_key_in_a_mapping_of_the_users_own_is_text() -> None:
    assert problems(parameters={1: 2.0}) == {"parameters.1": "found 1, expected text as the key"}
    assert problems(**{"law": {"type": "sadowsky", 3: 4}})["law.3"].endswith("text as the key")


def test_annotations_mean_what_they_mean_where_they_stand() -> None:
    @dataclass(frozen=True)
    class Turned(Turn):
        w: float = 0.0

    assert validate(Turned, {"x": "90*deg", "w": 1}) == Turned("90*deg", w=1.0)
    with pytest.raises(InvalidSceneError, match="expected a number or a formula"):
        validate(Turned, {"x": []})


def test_defaults_of_the_classes_are_valid() -> None:
    for cls in (Collocation, Newton, Regularized, Sadowsky, End, Boundary):
        assert validate(cls, {}) == cls()
        assert validate(cls, cls()) == cls()
