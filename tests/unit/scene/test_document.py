"""A text that says a scene is read once: what one set of overrides does, no other one sees."""

import pytest
from half_scene import SCENE
from hypothesis import example, given
from hypothesis import strategies as st

from ribbonopt.errors import SceneError
from ribbonopt.scene import loads_scene
from ribbonopt.scene.document import Document
from ribbonopt.scene.text.yamltext import YamlTextError, plain_number, read

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


def test_scenes_of_a_document_share_nothing_that_changes() -> None:
    document = Document(SCENE)
    first = document.scene(["parameters.a=1"])
    first.parameters["a"] = 2.0
    assert document.scene(["parameters.a=1"]).parameters["a"] == 1.0


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
