"""`ribbonopt solve` of a scene that asks for all its equilibria: told, kept, shown, refused."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

Run = Callable[..., Any]

ARCH = """
name: arch
law: {type: kirchhoff, B2: 1, B3: 1}
parameters: {a: 0, idle: 1}
boundary:
  start: {support: clamped, position: [0, 0, 0], directors: identity}
  end: {support: clamped, position: [0, 0, 0.9], directors: {turns: [{y: a*deg}]}}
transcription: {type: collocation, degree: 6, intervals: 8}
tolerance: 1e-6
planar: true
"""
ALL = "equilibria: {along: [parameters.a], below: 9}\n"

#: what the scene says, and what the message must say
BAD = {
    "misspelt word": ("every", ("equilibria", "'all'")),
    "unknown number": ("{along: [parameters.b]}", ("equilibria.along.0", "parameters.a")),
    "no number": ("{along: [name]}", ("equilibria.along.0", "name")),
    "twice": ("{along: [parameters.a, parameters.a]}", ("equilibria.along.1", "twice")),
    "own value outside": (
        "{along: {parameters.a: [5, 10]}}",
        ("equilibria.along.parameters.a", "below", "own parameters.a, 0", "[5, 10]"),
    ),
    "no scene there": (
        "{along: {law.B2: [-1, 2]}}",
        ("equilibria.along.law.B2.0", "-1", "another value"),
    ),
    "idle": ("{along: [parameters.idle]}", ("equilibria.along", "changes nothing")),
    "no energy": ("{below: 0}", ("equilibria.below", "0")),
    "unknown key": ("{alon: [parameters.a]}", ("alon", "did you mean 'along'")),
}


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "arch.yaml"
    path.write_text(ARCH + ALL)
    return path


@pytest.mark.parametrize("fault", BAD)
def test_bad_input_is_one_message_and_nothing_is_written(
    run: Run, scene: Path, tmp_path: Path, fault: str
) -> None:
    asked, said = BAD[fault]
    scene.write_text(f"{ARCH}equilibria: {asked}\n")
    result = run("solve", scene, "--out", tmp_path / "out")
    assert result.status == 2
    assert result.out == ""
    assert len(result.err.splitlines()) <= 2
    for words in said:
        assert words in result.err
    assert not (tmp_path / "out").exists()


def test_minima_are_no_square_system(run: Run, scene: Path, tmp_path: Path) -> None:
    scene.write_text(f"{ARCH}{ALL}formulation: energy\n")
    result = run("solve", scene, "--out", tmp_path / "out")
    assert result.status == 2 and "formulation energy" in result.err
    assert not (tmp_path / "out").exists()


def test_all_are_told_and_kept(run: Run, scene: Path, tmp_path: Path) -> None:
    result = run("solve", scene, "--out", tmp_path / "out")
    assert result.status == 0
    assert "4 equilibria, by energy" in result.out
    assert "an image of 1" in result.out and "an image of 3" in result.out
    assert "unstable, 1 direction, 1 of them in its plane" in result.out
    assert "half a turn about the middle" in result.out
    assert "a search below the strain energy 9" in result.out
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    found = summary["equilibria"]
    assert [each["image_of"] for each in found] == [1, 1, 3, 3]
    assert [each["negative_in_plane"] for each in found] == [0, 0, 1, 1]
    assert summary["search"] in result.out
    kept = sorted(path.name for path in (tmp_path / "out" / "equilibria").iterdir())
    assert kept == ["2", "3", "4"]
    again = json.loads((tmp_path / "out" / "equilibria" / "3" / "summary.json").read_text())
    assert again["energy"] == found[2]["energy"]


@pytest.mark.slow
def test_rows_of_a_batch_count_them(run: Run, scene: Path, tmp_path: Path) -> None:
    study = {"name": "s", "scene": "arch.yaml", "sweep": {"grid": {"parameters.a": [0, 33]}}}
    (tmp_path / "study.yaml").write_text(json.dumps(study))
    result = run("batch", tmp_path / "study.yaml", "--out", tmp_path / "out", "--jobs", 1)
    assert result.status == 0, result.err
    lines = (tmp_path / "out" / "rows.jsonl").read_text().splitlines()
    rows = [json.loads(line) for line in lines]
    assert {row["parameters.a"]: row["equilibria"] for row in rows} == {0: 4, 33: 1}
