"""A text that says a scene is read once: each of its scenes is as if it had been read alone."""

import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from half_scene import SCENE
from hypothesis import example, given
from hypothesis import strategies as st

from ribbonopt.errors import SceneError
from ribbonopt.scene import document as of_document
from ribbonopt.scene import loads_scene
from ribbonopt.scene.document import Document
from ribbonopt.scene.text.yamltext import YamlTextError, plain_number, read

CONFIGS = Path(__file__).parents[3] / "configs"
OVERRIDES = (
    ["law.epsilon=1e-3"],
    ["law={type: homotopy}", "law.epsilon=0.25"],
    ["law={type: homotopy}"],
    ["law={type: homotopy}", "law.epsilon=-0.25"],
    ["boundary.end={d1: {x: 0.5}}", "boundary.end.d1.x=2"],
    ["boundary.start.position.2=0.5"],
    ["boundary.start.position.2=1e200", "interval.1=0"],
    ["boundary.start=", "boundary.start.position.x=1"],
    ["parameters.a=1", "parameters.b=nan"],
    ["parameters.a=1"],
    ["law.epsilon=!!x 1", "laws=3"],
    ["law.epsilon"],
    [],
)
FACTORS = (1.01, 0.5, 1, 3, 0, -1, -0.2, 1e-200, 1e7, 1e300, 1e999)
SCENES = [
    pytest.param(path, id=path.stem)
    for path in sorted(CONFIGS.glob("*.yaml"))
    if isinstance(read(path.read_text()).data, dict) and "law" in read(path.read_text()).data
]


def told(text: str, overrides: list[str], document: Document | None = None) -> object:
    """Return the scene, or the message that refuses it."""
    try:
        return document.scene(overrides) if document else loads_scene(text, "s.yaml", overrides)
    except SceneError as error:
        return str(error)


def test_a_document_gives_each_scene_as_if_it_were_the_first() -> None:
    document = Document(SCENE, "s.yaml")
    for overrides in (*OVERRIDES, *reversed(OVERRIDES)):
        assert told(SCENE, overrides, document) == told(SCENE, overrides), overrides
    kinds = [type(told(SCENE, overrides)) for overrides in OVERRIDES]
    assert 4 < kinds.count(str) < len(kinds) - 4  # of both there are some


@pytest.mark.parametrize("text", ["", "- 1", "a: [", "colour: red"])
def test_what_says_no_scene_is_refused_before_any_is_asked_for(text: str) -> None:
    with pytest.raises(SceneError, match=r"^s\.yaml"):
        Document(text, "s.yaml")


@example("-")
@example("---")
@example("+.5")
@example("-1e5")
@example("0" * 500)
@given(st.text("0123456789+-.eE", max_size=12) | st.floats().map(repr) | st.integers().map(str))
def test_a_plain_number_is_what_yaml_reads(text: str) -> None:
    number = plain_number(text)
    try:
        said = read(text)
    except YamlTextError:
        assert number is None
        return
    if number is not None:
        assert (repr(number), [], 1) == (repr(said.data), said.problems, len(said.places))
    elif isinstance(said.data, float):
        assert set(text) - set("0123456789+-.eE")  # none is overlooked


def numbers_in(data: Any, path: str = "") -> Iterator[tuple[str, float]]:
    """Yield the numbers of plain data with their dotted paths."""
    if isinstance(data, dict | list):
        for key, value in data.items() if isinstance(data, dict) else enumerate(data):
            yield from numbers_in(value, f"{path}.{key}".lstrip("."))
    elif isinstance(data, int | float) and not isinstance(data, bool):
        yield path, data


@pytest.mark.parametrize("rounds", [3, pytest.param(30, marks=pytest.mark.sweep)])
@pytest.mark.parametrize("path", SCENES)
def test_other_numbers_alone_give_what_the_whole_text_would(path: Path, rounds: int) -> None:
    """In any of its places, sound or not: the same scene, or the same words."""
    text, rng = path.read_text(), random.Random(path.stem)
    numbers = dict(numbers_in(read(text).data))
    for keys in [rng.sample(sorted(numbers), min(2, len(numbers))) for _ in range(rounds)]:
        document = Document(text, str(path))
        rows = [[1.0 for _ in keys], [1.01 for _ in keys], [1.02 for _ in keys]]
        rows += [[rng.choice(FACTORS) for _ in keys] for _ in range(10)]
        for row in rows:
            values = zip(keys, row, strict=True)
            overrides = [f"{key}={numbers[key] * factor!r}" for key, factor in values]
            try:
                expected: object = loads_scene(text, str(path), overrides)
            except SceneError as error:
                expected = str(error)
            try:
                assert document.scene(overrides) == expected, overrides
            except SceneError as error:
                assert str(error) == expected, overrides


def test_from_the_third_scene_on_only_numbers_are_set(monkeypatch: pytest.MonkeyPatch) -> None:
    document, whole = Document(SCENE), of_document.validated
    asked: list[object] = []

    def validated(data: object, folder: str = "") -> object:
        asked.append(data)
        return whole(data, folder)

    monkeypatch.setattr(of_document, "validated", validated)
    rows = [[f"law.epsilon={e}", f"boundary.end.position.y={e}"] for e in (0.1, 0.2, 0.3, 0.4)]
    found = [document.scene(row) for row in rows]
    assert len(asked) == 2
    assert [scene.law.epsilon for scene in found] == [0.1, 0.2, 0.3, 0.4]  # type: ignore[union-attr]
    with pytest.raises(SceneError, match="found -1, expected a number >= 0"):
        document.scene(["law.epsilon=-1", "boundary.end.position.y=0"])


@pytest.mark.parametrize(
    "kind",
    [
        ["law.epsilon={}", "law={{type: homotopy}}"],
        ["law.epsilon={}", "law.epsilon=0.5"],
        ["law={{type: homotopy, epsilon: {}}}", "law.epsilon=0.5"],
    ],
)
def test_what_a_later_override_undoes_stays_undone(kind: list[str]) -> None:
    """Numbers that are those of the scene all the same, twice, and then are not."""
    document = Document(SCENE)
    for number in (0.0, 0.0, 0.0, 0.3):
        overrides = [text.format(number) for text in kind]
        assert document.scene(overrides) == loads_scene(SCENE, overrides=overrides)


ROD = """\
name: rod
law: {type: kirchhoff, B2: 1.0, B3: 2.0}
parameters: {F: 1.0}
boundary:
  start: {position: [0, 0, 0], directors: identity}
  end: {force: [0, 0, F], moment: [0, 0, 1e4]}
loads: {pressure: s**20}
"""
SIZES = "{length: 0.5, width: 0.02, thickness: 1e-4, youngs_modulus: 2e9, poisson_ratio: 0.3}"
SHEET = f"""\
name: sheet
law: {{type: sadowsky}}
ribbon: {SIZES}
boundary: {{start: {{position: [0, 0, 0], directors: identity}}, end: {{}}}}
"""


@pytest.mark.parametrize(
    ("text", "key", "numbers", "fault"),
    [
        (ROD, "parameters.F", (1, 2, 3, 1e13), "boundary.end.force"),  # by its formula
        (ROD, "interval.1", (1, 2, 3, 9), "loads.pressure"),  # by what it is worth along it
        (ROD, "law.B2", (1, 2, 3, 1e-5), "boundary.end.moment"),  # by the units that follow
        (SHEET, "ribbon.length", (0.5, 0.6, 0.7, 0.01), "ribbon.width"),
    ],
)
def test_what_is_the_same_is_looked_at_again_where_it_means_something_else(
    text: str, key: str, numbers: tuple[float, ...], fault: str
) -> None:
    if "interval" in key:
        text += "interval: [0, 1]\n"
    document = Document(text, "s.yaml")
    for number in numbers[:-1]:
        overrides = [f"{key}={number}"]
        assert document.scene(overrides) == loads_scene(text, "s.yaml", overrides)
    overrides = [f"{key}={numbers[-1]}"]
    words = told(text, overrides)
    assert isinstance(words, str) and fault in words
    assert told(text, overrides, document) == words
