"""Scene files in: every message with its line, and files that are no scenes."""

import os
from pathlib import Path

import pytest
import yaml
from half_scene import SCENE, changed, refusal
from hypothesis import given
from hypothesis import strategies as st

from ribbonopt import scene as room
from ribbonopt.errors import SceneError
from ribbonopt.scene import Scene, load_scene, loads_scene


def test_the_parser_in_python_reads_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = loads_scene(SCENE)
    monkeypatch.delattr(yaml, "CSafeLoader", raising=False)
    assert loads_scene(SCENE) == scene
    assert refusal(changed("1e-2", "-1")).startswith("s.yaml, line 4, law.epsilon")
    assert "not YAML" in refusal("a: \0")
    assert "s.yaml, line 2: not YAML" in refusal("a: [\n}")


def test_a_good_scene_loads() -> None:
    scene = loads_scene(SCENE)
    assert scene.law == room.Regularized(epsilon=0.01)
    assert scene.boundary.end.position == room.LabVector(y=0.0, z="1 - turn")
    assert scene.guess == room.LoadGuess((0.0, 40.0, 40.0), (0.0, 2.0, -9.0))


def test_one_problem_is_one_line() -> None:
    message = refusal(changed("1e-2", "-1"))
    assert message == "s.yaml, line 4, law.epsilon: found -1, expected a number >= 0"


def test_all_problems_in_the_order_of_the_file() -> None:
    text = changed("1e-2", "1e-2x").replace("interval: [0", "interval: [1").replace("name", "nam")
    message = refusal(text.replace("dot(", "dto("))
    lines = message.splitlines()
    assert lines[0] == "s.yaml: 4 problems"
    assert lines[1].startswith("  line 1, nam: unknown key; did you mean 'name'? (known keys: ")
    assert lines[2] == "  line 4, law.epsilon: found '1e-2x', expected a number >= 0"
    assert lines[3].startswith("  line 5, interval: found [1, 0.5], must go from")
    assert lines[4].startswith("  line 12, boundary.also.0: formula 'dto(n, d1(start)) = 0', col")
    assert "did you mean 'dot'?" in lines[4]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            changed("  type: regularized\n", ""),
            "s.yaml, line 2, law.type: missing; expected 'kirch",
        ),
        (changed("name: half\n", ""), "s.yaml: name: missing; expected text"),
        (SCENE + "name: again\n", "s.yaml, line 1, name: given again in line 15; keep one"),
        (changed("{x: 0}", "{x: 0, x: 1}"), "s.yaml, line 10, boundary.end.d1.x: given again in"),
        (changed("{x: 0}", "{x: 0, 1: 1}"), "s.yaml, line 10, boundary.end.d1.1: is no text"),
        (changed("{x: 0}", "{x: 0, [1]: 1}"), "s.yaml, line 10, boundary.end.d1.[1]: is no text"),
        (changed("half", "!!python/name:os.system half"), "s.yaml, line 1, name: tag !!python/nam"),
        (changed("half", "!x half"), "s.yaml, line 1, name: tag !x is refused"),
        (changed("1 - turn", "1 - trun"), "s.yaml, line 9, boundary.end.position.z: formula '1 -"),
        (changed("[0, 0.5]", "[0, 0.5"), "s.yaml, line 6: not YAML: "),
        ("", "s.yaml: is empty"),
        ("# only a comment\n", "s.yaml: is empty"),
        ("- 1\n", "s.yaml: is a list; expected keys such as name"),
        ("just text", "s.yaml: is a single value; expected keys such as name"),
    ],
)
def test_messages(text: str, message: str) -> None:
    found = refusal(text)
    assert found.startswith(message)
    assert "\n" not in found


def test_faults_of_the_text_and_of_the_values_are_told_together() -> None:
    message = refusal(changed("1e-2", "-1") + "name: again\n")
    assert [line.split(":")[0] for line in message.splitlines()] == [
        "s.yaml",
        "  line 1, name",
        "  line 4, law.epsilon",
    ]


def test_overrides_are_told_after_the_lines_of_the_file() -> None:
    lines = refusal(changed("[0, 0.5]", "3"), "law.epsilon=-1").splitlines()
    assert [line.split(":")[0] for line in lines[1:]] == [
        "  line 5, interval",
        "  --set law.epsilon=-1",
    ]


def test_a_faulty_parameter_does_not_make_its_formulas_faulty() -> None:
    message = refusal(changed("turn: .5", "turn: half"))
    assert message == "s.yaml, line 13, parameters.turn: found 'half', expected a number"


def test_file_is_loaded(tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text("# yaml-language-server: $schema=scene.json\n" + SCENE, encoding="utf-8-sig")
    assert load_scene(file) == load_scene(str(file)) == loads_scene(SCENE)
    assert load_scene(file, ["law.epsilon=1e-3"]).law == room.Regularized(epsilon=1e-3)


def test_relative_paths_stay_as_written(tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text(SCENE)
    guess = load_scene(file, ["guess={solution: ../a/solution.npz}"]).guess
    assert guess == room.SolutionGuess("../a/solution.npz")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "no such file"),
        (b"\x89PNG\r\n\x1a\n", "not a text in UTF-8"),
        ("name: é".encode("latin-1"), "not a text in UTF-8"),
        (b"", "is empty"),
        (b"\0\0\0", "not YAML"),
    ],
)
def test_files_that_are_no_scenes(tmp_path: Path, content: bytes | None, message: str) -> None:
    file = tmp_path / "scene.yaml"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(SceneError, match=message) as caught:
        load_scene(file)
    assert str(caught.value).startswith(str(file))


def test_a_directory_and_an_impossible_name(tmp_path: Path) -> None:
    with pytest.raises(SceneError, match="is a directory"):
        load_scene(tmp_path)
    with pytest.raises(SceneError, match="cannot be read"):
        load_scene(os.fspath(tmp_path / "a\0b"))
    with pytest.raises(SceneError, match="cannot be read"):
        load_scene(tmp_path / ("x" * 5000))


LINES = SCENE.splitlines(keepends=True)
GARBAGE = ["&a ", "*a", "!!x ", "{", "}", "[", "]", ": ", "- ", "\t", "'", '"', "1e-2", "\n", "? "]


@given(
    st.text(max_size=60)
    | st.lists(st.sampled_from(LINES + GARBAGE), max_size=25).map("".join)
    | st.tuples(st.sampled_from(LINES), st.text(max_size=8)).map(lambda t: changed(t[0], t[1]))
)
def test_any_text_gives_a_scene_or_a_scene_error(text: str) -> None:
    try:
        assert isinstance(loads_scene(text), Scene)
    except SceneError as error:
        assert str(error).startswith("<string>")
