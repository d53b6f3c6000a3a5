"""Whatever a file or a user says, what a command prints is text: bounded, and nothing acts."""

import io
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest
from half_studies import SCENE
from hostile import ALL, ESCAPES, MARKUP, NAMES_KEPT, acting, file_names, texts

from ribbonopt.cli import main, terminal
from ribbonopt.errors import SceneError
from ribbonopt.scene import load_scene
from ribbonopt.studies.batch.cells import as_yaml

ENCODINGS = ("utf-8", "ascii", "cp1252", "utf-16", "cp932")
ROOT = Path(__file__).parents[2]


class Said(NamedTuple):
    status: int
    out: str
    err: str


Say = Callable[..., Said]


@pytest.fixture
def said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Say:
    """Return the runner of a command whose streams refuse what their encoding cannot say."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: object, encoding: str = "utf-8") -> Said:
        streams = [io.BytesIO(), io.BytesIO()]
        for name, stream in zip(("stdout", "stderr"), streams, strict=True):
            text = io.TextIOWrapper(stream, encoding, "strict", newline="\n", write_through=True)
            monkeypatch.setattr(sys, name, text)
        try:
            status = main([str(argument) for argument in arguments])
        except SystemExit as end:
            status = int(end.code or 0)
        return Said(status, *(stream.getvalue().decode(encoding) for stream in streams))

    return run


def check(found: Said, status: int = 2) -> None:
    """Assert that a command has failed with one bounded message, in which nothing acts."""
    assert (found.status, found.out) == (status, "")
    assert not acting(found.err)
    assert len(found.err) < 10 * terminal.LONGEST
    first, *others = found.err.removesuffix("\n").split("\n")
    assert first.startswith(("ribbonopt: ", "usage: "))
    # No line that a text brings along looks like one of ours.
    ours = ("  ", "ribbonopt: error", "ribbonopt check: error", "ribbonopt solve: error")
    assert all(line.startswith(ours) for line in others)


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_hostile_scenes_are_told_as_text(said: Say, tmp_path: Path, encoding: str) -> None:
    scene = tmp_path / "scene.yaml"
    places = [
        "{}: 1\n",
        "formulation: {}\n",
        "record: {{{}: energy}}\n",
        "record: {{a: {}}}\n",
        "parameters: {{{}: 1}}\n",
        "continuation: {{parameter: {}, to: 1}}\n",
        "boundary2: [{}]\n",
    ]
    for i, text in enumerate((*ESCAPES, *MARKUP, *texts(seed=2, count=20))):
        place = places[i % len(places)].format(as_yaml(text))
        scene.write_text(SCENE + place, encoding="utf-8", errors="backslashreplace")
        check(said("check", scene, encoding=encoding))


def test_names_of_scenes_are_validated(said: Say, tmp_path: Path) -> None:
    (tmp_path / "scene.yaml").write_text(SCENE.replace("name: half", "name: ../evil"))
    found = said("solve", "scene.yaml", "--plot")
    check(found)
    assert "scene.yaml, line 1, name: found '../evil', expected a name without /" in found.err
    found = said("check", "scene.yaml", "--set", "name=CON")
    assert "--set name=CON: found 'CON', is reserved" in found.err
    assert [path.name for path in tmp_path.iterdir()] == ["scene.yaml"]


def test_files_of_any_name_are_told(said: Say) -> None:
    for name in (*file_names(seed=3, count=60), "a\nribbonopt: all is well", "\udcff"):
        check(said("solve", "./" + name))
        check(said("batch", "./" + name.translate(dict.fromkeys(map(ord, "*?[")))))


def test_overrides_and_arguments_of_any_text(said: Say, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text(SCENE)
    for text in (*ESCAPES, *texts(seed=4, count=60), "x" * 1_000_000, "\x1b" * 1_000_000):
        check(said("check", "s.yaml", "--set", text + "=\x1b"))
        check(said("check", "s.yaml", "--set", "interval.0" + text + "=1"))
        check(said(text or "verb"))
        check(said("check", "s.yaml", "--no" + text))
        check(said("bench", "s.yaml", "--formulations=" + text))


def test_undecodable_overrides_are_refused(said: Say, tmp_path: Path) -> None:
    (tmp_path / "s.yaml").write_text(SCENE)
    found = said("check", "s.yaml", "--set", "a\udcff=1", "--set", "name=con")
    check(found)
    assert r"a\udcff=1: the key is no text in UTF-8" in found.err


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("".join(f"k{i}: 1\n" for i in range(500)), "and 480 more"),
        ("? " + "k" * 3_000_000 + "\n: 1\n", "more characters"),
        ("formulation: " + "x" * 3_000_000 + "\n", "formulation: found 'xxx"),
        ("switching: [" + "x, " * 5000 + "]\n", "and 4,980 more"),
        ("a: *" + "x" * 3_000_000 + "\n", "is not defined before it"),
        ("a: !" + "x" * 3_000_000 + " 1\n", "more characters"),
        ("seed: -0x" + "f" * 100_000 + "\n", "seed"),
    ],
    ids=["keys", "key", "value", "list", "alias", "tag", "number"],
)
def test_messages_are_bounded(said: Say, tmp_path: Path, text: str, told: str) -> None:
    (tmp_path / "s.yaml").write_text(SCENE + text)
    found = said("check", "s.yaml")
    check(found)
    assert len(found.err) < terminal.LONGEST + 100
    assert told in found.err
    with pytest.raises(SceneError) as caught:  # as rows of batches keep it
        load_scene(tmp_path / "s.yaml")
    assert len(str(caught.value)) < terminal.LONGEST
    found = said("check", "s.yaml", "--json")
    answer = json.loads(found.out)
    assert (answer["status"], found.out.count("\n")) == ("bad_input", 1)
    assert len(found.out) < 2 * terminal.LONGEST


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_names_in_any_language_are_checked(said: Say, tmp_path: Path, encoding: str) -> None:
    for name in NAMES_KEPT[::3]:
        scene = tmp_path / "s.yaml"
        scene.write_text(SCENE.replace("half", as_yaml(name), 1), encoding="utf-8")
        found = said("check", "s.yaml", encoding=encoding)
        seen = name.encode(encoding, "backslashreplace").decode(encoding)
        assert (found.status, found.err) == (0, "")
        assert found.out.startswith(f"{seen}: valid\n")
        answer = said("check", "s.yaml", "--json", encoding=encoding)
        assert json.loads(answer.out)["name"] == name
        assert answer.out.isascii()


def test_helps_are_plain(said: Say) -> None:
    for arguments in (("--help",), ("continue", "--help"), ("--version",)):
        found = said(*arguments, encoding="ascii")
        assert (found.status, found.err, acting(found.out)) == (0, "", set())
        assert "more characters" not in found.out


@pytest.mark.parametrize(
    "variables",
    [
        {"PYTHONIOENCODING": "ascii:strict"},
        {"PYTHONIOENCODING": "cp1252:strict"},
        {"PYTHONIOENCODING": "utf-16"},
        {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
    ],
    ids=lambda variables: " ".join(variables.values()),
)
def test_processes_with_poor_streams(tmp_path: Path, variables: dict[str, str]) -> None:
    (tmp_path / "s.yaml").write_text(SCENE.replace("half", "メビウス 😀", 1), encoding="utf-8")
    paths = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))
    command = [sys.executable, "-m", "ribbonopt", "check"]
    for file, status in (("s.yaml", 0), (os.fsdecode(b"\xff\x1b[2J.yaml"), 2)):
        done = subprocess.run(
            [*command, file],
            capture_output=True,
            check=False,
            cwd=tmp_path,
            env=os.environ | variables | {"PYTHONPATH": paths},
        )
        assert done.returncode == status
        encoding = variables.get("PYTHONIOENCODING", "ascii").partition(":")[0]
        told = (done.stdout + done.stderr).decode(encoding)
        assert r"\u30e1\u30d3" in told or "メビ" in told or r"\x1b[2J.yaml: no such file" in told
        assert not acting(told)


def test_a_process_without_streams_says_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdout", None)
    monkeypatch.setattr(sys, "stderr", None)
    terminal.say("a")
    terminal.complain("a")
    terminal.overwrite("a")
    assert not terminal.seen()


def test_the_line_of_progress_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    for text in ALL:
        terminal.overwrite(text)
        written = capsys.readouterr().err
        assert written.startswith("\r")
        assert not acting(written[1:]) | ({"\n"} & set(written))
