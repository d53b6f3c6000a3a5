"""Continuation in a scene: its section, the numbers that it may move, and what is refused."""

import dataclasses
import math
from pathlib import Path
from typing import Any

import pytest

from ribbonopt.errors import SceneError
from ribbonopt.scene import (
    AnyVector,
    Boundary,
    ContinuationStage,
    Directors,
    End,
    Homotopy,
    LabVector,
    Loop,
    Quaternion,
    Regularized,
    RibbonSizes,
    RotationVector,
    Sadowsky,
    Scene,
    SingleSheet,
    Turn,
    Turns,
    dump_scene,
    json_schema,
    load_scene,
    loads_scene,
    validate_scene,
)
from ribbonopt.scene.faults import InvalidSceneError
from ribbonopt.scene.formulas.parsing import FormulaError
from ribbonopt.scene.lens import fault_of, paths_of, value_at, with_value
from ribbonopt.scene.schema.validation import validate
from ribbonopt.scene.stages import (
    end_of,
    ends_of,
    parse_record,
    parse_stop,
    special_stop,
    stages_of,
    words_of,
)

HEAD = """\
name: arch
law: {type: regularized, epsilon: 1e-2}
parameters: {shortening: 0.1, turn: 0.5}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 1 - shortening], directors: {turns: [{z: turn}]}}
"""
WHOLE = (
    HEAD
    + """\
record: {deflection: "dot(r, ex) at 0.5", pull: n3}
continuation:
  - {parameter: law.epsilon, from: 0.1, to: 1e-6, scale: log, first: 0.5, smallest: 1e-3,
     largest: 1}
  - parameter: parameters.shortening
    values: [0.1, 0.2, 0.4]
    points: 30
    stop: [energy > 30, deflection < -0.2]
    special: false
  - {parameter: parameters.turn, to: 3, switch: true, stability: false}
"""
)


def scene(**values: Any) -> Scene:
    """Return an arch that is continued as a test says."""
    return dataclasses.replace(loads_scene(HEAD), **values)


def refusal(tmp_path: Path, section: str, head: str = HEAD) -> str:
    """Return why a file with a section is refused, less the name of the file."""
    path = tmp_path / "scene.yaml"
    path.write_text(head + section, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load_scene(path)
    return str(caught.value).removeprefix(str(path))


def test_what_a_file_says() -> None:
    read = loads_scene(WHOLE)
    assert read.record == {"deflection": "dot(r, ex) at 0.5", "pull": "n3"}
    assert read.continuation == (
        ContinuationStage(
            "law.epsilon", 1e-6, 0.1, scale="log", first=0.5, smallest=1e-3, largest=1.0
        ),
        ContinuationStage(
            "parameters.shortening",
            values=(0.1, 0.2, 0.4),
            points=30,
            stop=("energy > 30", "deflection < -0.2"),
            special=False,
        ),
        ContinuationStage("parameters.turn", 3.0, switch=True, stability=False),
    )
    one = loads_scene(HEAD + "continuation: {parameter: law.epsilon, from: 1, to: 2}\n")
    assert one.continuation == ContinuationStage("law.epsilon", 2.0, 1.0)
    assert (loads_scene(HEAD).record, loads_scene(HEAD).continuation) == ({}, None)


def test_round_trip() -> None:
    read = loads_scene(WHOLE)
    text = dump_scene(read)
    assert "from: 0.1" in text
    assert "from_" not in text
    assert loads_scene(text) == read
    assert validate_scene(read) == read
    assert "continuation" not in dump_scene(loads_scene(HEAD))


def test_built_in_python() -> None:
    built = validate_scene(scene(continuation=ContinuationStage("law.epsilon", to=1, from_=2)))
    assert isinstance(built.continuation, ContinuationStage)
    assert type(built.continuation.from_) is float
    with pytest.raises(SceneError, match=r"continuation\.from: found 'low', expected a number"):
        validate_scene(scene(continuation=ContinuationStage("law.epsilon", 1, "low")))  # type: ignore[arg-type]


def test_override_of_from() -> None:
    read = loads_scene(WHOLE, overrides=["continuation.0.from=0.5"])
    assert stages_of(read)[0].from_ == 0.5


def test_the_underscore_is_never_written() -> None:
    data = {"parameter": "law.epsilon", "to": 1, "from_": 2}
    with pytest.raises(InvalidSceneError, match=r"unknown key; did you mean 'from'\?"):
        validate(ContinuationStage, data)


def test_json_schema() -> None:
    branches = json_schema()["properties"]["continuation"]["oneOf"]
    assert [branch["type"] for branch in branches] == ["object", "array", "null"]
    for section in (branches[0], branches[1]["items"]):
        assert "from" in section["properties"]
        assert "from_" not in section["properties"]
        assert section["required"] == ["parameter"]


def test_stages_begin_where_earlier_ones_ended() -> None:
    stages = (
        ContinuationStage("law.epsilon", to=0.5),
        ContinuationStage("parameters.turn", values=(1.0, 2.0)),
        ContinuationStage("boundary.start.position.0", to=0.5),
        ContinuationStage("law.epsilon", to=0.1),
        ContinuationStage("parameters.turn", to=0.5),
        ContinuationStage("law.epsilon", to=1.0, from_=0.3),
        ContinuationStage("boundary.start.position.x", to=1.0),
    )
    filled = stages_of(scene(continuation=stages))
    assert [stage.from_ for stage in filled] == [0.01, 1.0, 0.0, 0.5, 2.0, 0.3, 0.5]
    assert [dataclasses.replace(stage, from_=None) for stage in filled[:5]] == list(stages[:5])
    again = validate_scene(scene(continuation=filled))
    assert stages_of(again) == filled
    assert stages_of(scene()) == ()


def test_two_ways_from_where_a_stage_begins() -> None:
    text = (
        HEAD
        + """continuation:
  - {parameter: law.epsilon, to: [1, 1e-4], scale: log, switch: 2, stop: [2 folds]}
  - {parameter: law.epsilon, to: 1}
"""
    )
    read = loads_scene(text)
    first, second = stages_of(read)
    assert (first.from_, first.to, first.switch) == (0.01, (1.0, 1e-4), 2)
    # from the end that is named last
    assert (second.from_, second.to) == (1e-4, 1.0)
    assert (ends_of(first), end_of(first), ends_of(second)) == ((1.0, 1e-4), 1e-4, (1.0,))
    again = dump_scene(read)
    assert "to: [1, 0.0001]" in again
    assert loads_scene(again) == read


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("fold", ("fold", 1)),
        ("branch point", ("branch point", 1)),
        (" 1 fold", ("fold", 1)),
        ("3 branch points", ("branch point", 3)),
        ("buckling point", ("buckling point", 1)),
        ("energy > 30", None),
        ("fold > 1", None),
    ],
)
def test_special_points_that_end_a_stage(text: str, found: tuple[str, int] | None) -> None:
    assert special_stop(text) == found


OF_STAGES = [
    (
        "parameter: law.epsilom, to: 1",
        "parameter: 'law.epsilom' is no number of this scene; did you",
    ),
    ("parameter: law.epsilom, to: 1", "did you mean law.epsilon?"),
    ("parameter: zzz, to: 1", "is no number of this scene; expected law.epsilon, interval.start, "),
    ("parameter: boundary.end.position.z, to: 1", "parameters.shortening: continue that instead"),
    ("parameter: interval.end, to: -1", "to: found -1, which makes no valid scene; choose another"),
    ("parameter: interval.end, to: -1", "choose another value: interval: found [0, -1], must go"),
    ("parameter: boundary.start.position.x, scale: log, to: 1", "from: found 0, expected a number"),
    ("parameter: 3, to: 1", "parameter: found 3, expected text"),
    ("to: 1", "missing; expected text"),
]
OF_EPSILON = [
    ("points: 3", 'found neither `to` nor `values`; add for example "to: 0.1"'),
    ("to: 1, values: [2, 3]", "to: stands beside `values`, which say where the stage ends; keep"),
    ("from: 1, values: [2, 3]", "from: found 1, stands beside `values`, which begin at 2; remove"),
    ("to: 0.01", "to: found 0.01, which is where law.epsilon begins; expected another value"),
    ("from: 3, to: 3", "to: found 3, which is where law.epsilon begins"),
    ("values: []", "values: found [], expected at least one number"),
    ("values: [1, 1]", "values: found [1, 1], expected at least one number"),
    (
        "values: [1, 3, 2]",
        "values: found [1, 3, 2], expected at least one number, all increasing or",
    ),
    ("scale: log, to: 0", "to: found 0, expected a number > 0, for the logarithm; or write"),
    ("scale: log, from: 0, to: 1", "from: found 0, expected a number > 0, for the logarithm"),
    ("scale: log, values: [1, 0]", "values: found 0, expected a number > 0, for the logarithm"),
    ("scale: cubic, to: 1", "scale: found 'cubic', expected 'linear' or 'log'"),
    (
        "to: 1, smallest: 2, first: 1",
        "smallest: step sizes reversed: smallest 2 > first 1; expected",
    ),
    ("to: 1, first: 2, largest: 1", "first: step sizes reversed: first 2 > largest 1; expected"),
    ("to: 1, smallest: 2, largest: 1", "smallest: step sizes reversed: smallest 2 > largest 1"),
    ("to: 1, first: 0", "first: found 0, expected a number > 0"),
    ("to: 1, points: 0", "points: found 0, expected a whole number >= 1"),
    ("to: 1, form: 0", "form: unknown key; did you mean 'from'?"),
    ("to: -1", "to: found -1, which makes no valid scene; choose another value: law.epsilon: "),
    ("to: -1", "law.epsilon: found -1.0, expected a number >= 0"),
    ("from: -1, to: 1", "from: found -1, which makes no valid scene"),
    ("values: [1, -1]", "values.1: found -1, which makes no valid scene"),
    ("to: 1, stop: [energy = 30]", "stop.0: formula 'energy = 30': found no sign > or <, expected"),
    ("to: 1, stop: [energy >= 30]", "found '>=', expected 'A > B' or 'A < B', such as 'energy > 3"),
    ("to: 1, stop: [1 < energy < 30]", "stop.0: formula '1 < energy < 30': found 2 signs > or <"),
    ("to: 1, stop: [r.x < 1, 'energy >']", "stop.1: formula 'energy >', column 8: found nothing"),
    ("to: 1, stop: [energy > (3]", "stop.0: formula '(3', column 1: cannot be read"),
    ("to: 1, stop: [r > 1]", "stop.0: formula 'r': found a vector, expected a scalar"),
    ("to: 1, stop: energy > 1", "stop: found 'energy > 1', expected a list, each item text"),
    ("to: 1, stop: [folds]", "stop.0: formula 'folds': found a number that does not fit, expected"),
    ("to: 1, stop: [0 folds]", "stop.0: formula '0 folds': found a number that does not fit"),
    ("to: 1, stop: [2 fold]", "expected 'fold', or '2 folds' for the second one"),
    ("to: 1, stop: [bend]", "found no sign > or <, expected 'A > B' or 'A < B', such as 'energy"),
    ("to: 1, stop: [bend]", "or fold, branch point, buckling point, kink, or a number of them"),
    ("to: 1, stop: [fold], special: false", "stop.0: found 'fold', folds are not located with"),
    ("to: [0.001, 0.005]", "to: found [0.001, 0.005], of which one is to be below and one above"),
    ("from: 2, to: [3, 2]", "one above where law.epsilon begins, 2; for one direction write one"),
    ("from: 2, to: [1, 2, 3]", "to: found [1, 2, 3], expected a list of 2 items, each a number"),
    ("from: 2, to: [1]", "to: found [1], expected a list of 2 items, each a number"),
    ("from: 2, to: [-1, 3]", "to.0: found -1, which makes no valid scene"),
    ("from: 2, to: [3, 0], scale: log", "to: found 0, expected a number > 0, for the logarithm"),
    ("to: [0, 1], values: [1, 2]", "to: stands beside `values`, which say where the stage ends"),
    ("to: 1, switch: -1", "switch: found -1, expected a whole number >= 0"),
    ("to: 1, switch: 1.5", "switch: found 1.5, expected a whole number >= 0"),
    ("to: 1, switch: deep", "switch: found 'deep', expected true or false or a whole number >= 0"),
]


@pytest.mark.parametrize(
    ("section", "message"),
    OF_STAGES + [(f"parameter: law.epsilon, {keys}", said) for keys, said in OF_EPSILON],
)
def test_refusals_name_file_line_and_key(tmp_path: Path, section: str, message: str) -> None:
    said = refusal(tmp_path, f"\ncontinuation:\n  {{{section}}}\n")
    # A key that was not written is placed where its section begins.
    assert said.startswith((", line 9, continuation", ", line 8, continuation"))
    assert message in said


def test_stages_are_some(tmp_path: Path) -> None:
    said = refusal(tmp_path, "continuation: []\n")
    assert said == ", line 7, continuation: expected at least one stage; or remove it"


def test_refusal_of_a_later_stage(tmp_path: Path) -> None:
    stages = ["- {parameter: law.epsilon, to: 1}", "- parameter: law.epsilon", "  to: 1", ""]
    section = "\n".join(["continuation:", *stages])
    said = refusal(tmp_path, section)
    assert said.startswith(", line 10, continuation.1.to: found 1, which is where law.epsilon")


def test_several_faults_are_told_together(tmp_path: Path) -> None:
    stages = ["- {parameter: law.x, to: 1}", "- {parameter: law.epsilon}", ""]
    section = "\n".join(["record: {a: r}", "continuation:", *stages])
    said = refusal(tmp_path, section)
    assert said.startswith(": 3 problems")
    for line in ("line 7, record.a", "line 9, continuation.0.parameter", "line 10, continuation.1"):
        assert line in said


def test_ends_are_tried_with_what_earlier_stages_left(tmp_path: Path) -> None:
    grow = "{parameter: interval.end, to: 3}"
    far = "{parameter: interval.start, to: 2}"
    loads_scene(HEAD + f"continuation: [{grow}, {far}]\n")
    said = refusal(tmp_path, f"continuation: [{far}, {grow}]\n")
    assert "continuation.0.to: found 2, which makes no valid scene" in said


def test_records_hold_at_the_ends_too(tmp_path: Path) -> None:
    section = "record: {a: n3 at 0.5}\ncontinuation: {parameter: interval.end, to: 0.4}\n"
    said = refusal(tmp_path, section)
    assert "continuation.to: found 0.4, which makes no valid scene" in said
    assert "record.a: formula 'n3 at 0.5': found arclength 0.5, expected one from 0 to 0.4" in said


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("a: m2 /", "line 7, record.a: formula 'm2 /', column"),
        ("a: d1 at 0.5", "record.a: formula 'd1': found a vector, expected a scalar; write for"),
        ("a: m4", "unknown name 'm4'; did you mean 'm"),
        ("a: n3 at 2", "found arclength 2, expected one from 0 to 1, the interval; write for"),
        ("a: n3 at the end", "record.a: formula 'the end'"),
        ("a: n3(end)", "'n3' is no function"),
        ("a b: n3", "record.a b: is no name for a record; use letters"),
        ("sin: n3", "record.sin: is no name for a record"),
        ("a: 3", "record.a: found 3, expected text"),
    ],
)
def test_refused_records(tmp_path: Path, entry: str, message: str) -> None:
    assert message in refusal(tmp_path, f"record: {{{entry}}}\n")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("dot(r, ex) at 0.5", ("dot(r, ex)", 0.5)),
        ("n3", ("n3", 2.0)),
        (" u.y  at 1/2 ", ("u.y", 0.5)),
        ("eta at turn", ("eta", 0.5)),
        ("n_dot_m + H + energy at\n0", ("n_dot_m + H + energy", 0.0)),
    ],
)
def test_records_parsed(text: str, expected: tuple[str, float]) -> None:
    assert parse_record(text, scene(interval=(0.0, 2.0))) == expected


def test_stops_parsed() -> None:
    assert parse_stop("energy > 30") == ("energy", ">", "30")
    assert parse_stop(" deflection<-0.2*pull ") == ("deflection", "<", "-0.2*pull")
    with pytest.raises(FormulaError, match="no sign"):
        parse_stop("energy")


SEEN = Scene(
    "seen",
    Homotopy(rho=0.5, epsilon=0.25),
    Boundary(
        End(
            position=LabVector(x=1.0, z="2*turn"),
            directors=Turns((Turn(x=0.125), Turn(d3=2.5))),
            moment=AnyVector(d2=7.0),
        ),
        End(position=(3.0, 4.0, 5.0), d1=LabVector(x=0.0), force=AnyVector(z=6.0)),
    ),
    interval=(0.0, 0.75),
    parameters={"turn": 0.375},
)
VALUES = {
    "law.rho": 0.5,
    "law.epsilon": 0.25,
    "interval.start": 0.0,
    "interval.end": 0.75,
    "parameters.turn": 0.375,
    "boundary.start.position.x": 1.0,
    "boundary.start.directors.turns.0.x": 0.125,
    "boundary.start.directors.turns.1.d3": 2.5,
    "boundary.start.moment.d2": 7.0,
    "boundary.end.position.x": 3.0,
    "boundary.end.position.y": 4.0,
    "boundary.end.position.z": 5.0,
    "boundary.end.d1.x": 0.0,
    "boundary.end.force.z": 6.0,
}


def test_paths_are_all_there_are() -> None:
    assert paths_of(SEEN) == list(VALUES)
    assert [value_at(SEEN, path) for path in VALUES] == list(VALUES.values())
    assert [fault_of(SEEN, path) for path in VALUES] == [""] * len(VALUES)


@pytest.mark.parametrize("path", VALUES)
def test_one_number_changes_and_nothing_else(path: str) -> None:
    before = repr(SEEN)
    changed = with_value(SEEN, path, 0.0625)
    assert value_at(changed, path) == 0.0625
    assert {p: value_at(changed, p) for p in VALUES} == VALUES | {path: 0.0625}
    assert with_value(changed, path, VALUES[path]) == SEEN
    assert repr(SEEN) == before


@pytest.mark.parametrize(
    ("index", "name"),
    [("boundary.end.position.1", "boundary.end.position.y"), ("interval.1", "interval.end")],
)
def test_items_by_index(index: str, name: str) -> None:
    assert value_at(SEEN, index) == value_at(SEEN, name)
    assert with_value(SEEN, index, 9) == with_value(SEEN, name, 9)


def test_other_frames_and_sizes() -> None:
    sizes = RibbonSizes(1.0, 0.01, 1e-4, 1e9, 0.3)
    end = End(directors=RotationVector((0.0, 1.0, "turn")), distance=0.5)
    start = End(directors=Quaternion((1.0, 0.0, 0.0, 0.0)))
    one = dataclasses.replace(SEEN, ribbon=sizes, boundary=Boundary(start, end), law=Sadowsky())
    assert paths_of(one)[3:] == [
        "boundary.start.directors.quaternion.0",
        "boundary.start.directors.quaternion.1",
        "boundary.start.directors.quaternion.2",
        "boundary.start.directors.quaternion.3",
        "boundary.end.directors.rotation_vector.x",
        "boundary.end.directors.rotation_vector.y",
        "boundary.end.distance",
        "ribbon.length",
        "ribbon.width",
        "ribbon.thickness",
        "ribbon.youngs_modulus",
        "ribbon.poisson_ratio",
    ]
    whole = Directors(d1=(0.0, 1.0, 0.0), d3=(1.0, 0.0, 0.0))
    turned = dataclasses.replace(one, boundary=Boundary(End(directors=whole)))
    changed = with_value(turned, "boundary.start.directors.d3.y", 0.5)
    assert changed.boundary.start.directors == Directors(d1=(0.0, 1.0, 0.0), d3=(1.0, 0.5, 0.0))
    assert with_value(one, "ribbon.width", 0.02).ribbon == RibbonSizes(1.0, 0.02, 1e-4, 1e9, 0.3)


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("law.rhoo", "'law.rhoo' is no number of this scene; did you mean law.rho?"),
        ("parameters.trun", "did you mean parameters.turn?"),
        ("boundary.end.position", "is no number of this scene; expected boundary.end.position.x, "),
        ("law", "is no number of this scene; expected law.rho or law.epsilon"),
        ("", "'' is no number of this scene; expected law.rho, "),
        ("law.type", "'law.type' is no number of this scene"),
        ("continuation.from", "is no number of this scene"),
        ("boundary.also.0", "is no number of this scene"),
        ("interval.2", "'interval.2' is no number of this scene; did you mean interval."),
        ("boundary.start.position.y", "boundary.start.position.y is not given; give it the number"),
        ("boundary.end.moment.x", "has no value: boundary.end.moment is not given"),
        ("ribbon.length", "has no value: ribbon is not given"),
        ("boundary.start.position.z", "is the formula '2*turn' of parameters.turn: continue that"),
        ("seed", "'seed' is a whole number, which is not continued; expected law.rho, "),
        ("transcription.degree", "is a whole number"),
        ("guess.force.0", "is no number of this scene"),
        ("solver.tolerance", "is no number of this scene"),
    ],
)
def test_other_paths_are_refused(path: str, message: str) -> None:
    with pytest.raises(SceneError) as caught:
        value_at(SEEN, path)
    assert str(caught.value).startswith("continuation.parameter: ")
    assert message in str(caught.value)
    with pytest.raises(SceneError):
        with_value(SEEN, path, 1.0)


def test_choices_and_twists_are_not_continued() -> None:
    band = Scene("band", SingleSheet(), Boundary(loop=Loop(3)), tolerance=1e-6)
    assert paths_of(band) == ["interval.start", "interval.end"]
    for path in ("law.chi", "boundary.loop.half_twists"):
        assert "is a whole number, which is not continued" in fault_of(band, path)
    assert "is a setting of the computation" in fault_of(band, "tolerance")


def test_formulas_without_parameters_and_of_several() -> None:
    end = End(position=("pi/2", "turn*far + turn", 0.0))
    one = Scene("one", Regularized(), Boundary(end=end), parameters={"turn": 1.0, "far": 2.0})
    assert "which no parameter changes; write it as a number" in fault_of(
        one, "boundary.end.position.x"
    )
    assert "of parameters.turn and parameters.far: continue" in fault_of(
        one, "boundary.end.position.y"
    )


def test_numbers_in_special_units_too() -> None:
    own = {"turn": 1.0, "units.length": 2.0}
    one = Scene("one", Sadowsky(), Boundary(), parameters=own)
    assert paths_of(one) == ["interval.start", "interval.end", "parameters.turn"]


def test_values_become_floats() -> None:
    changed = with_value(SEEN, "law.rho", 1)
    assert isinstance(changed.law, Homotopy)
    assert type(changed.law.rho) is float
    assert math.isnan(value_at(with_value(SEEN, "law.rho", math.nan), "law.rho"))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("1e9", []),
        ("2.5E-3 + 1.e5 - .1e2", []),
        ("shortening*1e3 + e1", ["shortening", "e1"]),
        ("sqrt(n0z)/x2", ["n0z", "x2"]),
    ],
)
def test_exponents_are_no_words(text: str, words: list[str]) -> None:
    assert words_of(text) == words
