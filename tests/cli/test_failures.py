"""What goes wrong is told in one message, and leaves nothing half written."""

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from ribbonopt.output.results import load_solution

Run = Callable[..., Any]

HALF = """\
name: half
law: {type: regularized, epsilon: 0.01}
interval: [0, 0.5]
boundary:
  start: {position: [0, 0, 0], directors: identity, force: {d1: 0}, moment: {d1: 0}}
  end: {position: {y: 0, z: 0}, d1: {x: 0}, d3: {x: 0}}
guess: {force: [0, 40, 40], moment: [0, 2, -9]}
transcription: {type: collocation, scheme: gauss, degree: 6, intervals: 10}
"""
END = "  end: {position: {y: 0, z: 0}, d1: {x: 0}, d3: {x: 0}}\n"

#: what the user did: text in place of what, and what the message must say
BAD: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "not YAML": ("{type: regularized,", "{type: [regularized,", ("line 2",)),
    "tab": ("  start:", "\tstart:", ("line 5",)),
    "misspelt key": ("interval:", "intervall:", ("line 3", "intervall", "did you mean 'interval'")),
    "misspelt law": ("regularized", "regularised", ("line 2", "law", "regularized")),
    "misspelt inner key": ("degree: 6", "degre: 6", ("line 8", "degre", "did you mean 'degree'")),
    "wrong type": ("degree: 6", "degree: six", ("line 8", "transcription.degree", "six")),
    "text for a number": ("0.01", "small", ("line 2", "law.epsilon", "small")),
    "list too short": ("[0, 40, 40]", "[0, 40]", ("line 7", "guess.force")),
    "not a number": ("0.01", ".nan", ("line 2", "law.epsilon")),
    "infinite": ("0.01", ".inf", ("line 2", "law.epsilon")),
    "negative epsilon": ("0.01", "-0.01", ("line 2", "law.epsilon", "-0.01")),
    "interval reversed": ("[0, 0.5]", "[0.5, 0]", ("line 3", "interval", "[0.5, 0]")),
    "interval empty": ("[0, 0.5]", "[0.5, 0.5]", ("line 3", "interval", "[0.5, 0.5]")),
    "too many": ("{y: 0, z: 0}", "{x: 0, y: 0, z: 0}", ("14", "13", "boundary.end.position.x")),
    "too few": (", d3: {x: 0}", "", ("12", "13", "boundary.end.d1.x")),
    "none at the end": (END, "", ("9", "13", "boundary.start.force.d1")),
    "twice": (END, END + "  also: ['r(end).y = 0']\n", ("boundary.also.0", "end.position.y")),
    "twice with another value": (
        END,
        END + "  also: ['r(end).y = 0.1']\n",
        ("boundary.also.0", "end.position.y"),
    ),
    "condition on nothing": (END, END + "  also: ['1 = 2']\n", ("line 7", "boundary.also.0")),
    "key given twice": ("law:", "name: other\nlaw:", ("line 2", "name")),
    "directors not orthonormal": (
        "directors: identity",
        "directors: {d1: [1, 0, 0], d2: [0.6, 0.8, 0]}",
        ("line 5", "boundary.start.directors.d2", "orthogonal"),
    ),
    "director of wrong length": (
        "directors: identity",
        "directors: {d1: [2, 0, 0], d2: [0, 1, 0]}",
        ("line 5", "boundary.start.directors.d1", "length 2"),
    ),
    "frame and director": ("identity,", "identity, d1: {x: 1},", ("line 5", "boundary.start.d1")),
    "unknown name in a value": ("{y: 0,", "{y: turn,", ("line 6", "end.position.y", "turn")),
    "call in a value": ("{y: 0,", "{y: __import__('os'),", ("line 6", "__import__")),
    "call in an equation": (
        END,
        END + "  also: ['__import__(\"os\").getcwd() = 0']\n",
        ("line 7", "boundary.also.0", "__import__"),
    ),
    "attribute in an equation": (
        END,
        END + "  also: ['r(end).__class__ = 0']\n",
        ("line 7", "boundary.also.0", "__class__"),
    ),
    "no equation": (END, END + "  also: ['dot(n, d1)']\n", ("line 7", "boundary.also.0")),
    "degree 0": ("degree: 6", "degree: 0", ("line 8", "transcription.degree", "0")),
    "degree 11": ("degree: 6", "degree: 11", ("line 8", "transcription.degree", "11")),
    "no intervals": ("intervals: 10", "intervals: 0", ("line 8", "transcription.intervals", "0")),
    "unknown scheme": ("gauss", "gaus", ("line 8", "transcription.scheme", "gaus")),
    "no law": ("law: {type: regularized, epsilon: 0.01}\n", "", ("law",)),
}


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "half.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def refused(outcome: Any, tmp_path: Path) -> str:
    """Check that input was refused and nothing written; return the message."""
    status, out, err = outcome
    assert status == 2
    assert out == ""
    assert "Traceback" not in err
    assert err.startswith("ribbonopt: ")
    assert err.count("ribbonopt: ") == 1
    assert sorted(path.name for path in tmp_path.iterdir()) in ([], ["half.yaml"])
    return str(err)


def test_the_scene_that_is_spoilt_below_is_good(run: Run, tmp_path: Path) -> None:
    assert run("solve", written(tmp_path, HALF), "--quiet").status == 0


@pytest.mark.parametrize("verb", ["solve", "check"])
@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_refused(run: Run, tmp_path: Path, case: str, verb: str) -> None:
    old, new, words = BAD[case]
    assert HALF.count(old) == 1
    path = written(tmp_path, HALF.replace(old, new))
    extra = ["--out", tmp_path / "result"] if verb == "solve" else []
    message = refused(run(verb, path, *extra), tmp_path)
    for word in words:
        assert word in message


@pytest.mark.parametrize("case", BAD)
def test_messages_name_the_file(run: Run, tmp_path: Path, case: str) -> None:
    old, new, _ = BAD[case]
    message = refused(run("solve", written(tmp_path, HALF.replace(old, new))), tmp_path)
    assert "half.yaml" in message


def test_all_problems_are_told_at_once(run: Run, tmp_path: Path) -> None:
    text = (
        HALF.replace("0.01", "-1").replace("degree: 6", "degree: 0").replace("[0, 0.5]", "[1, 0]")
    )
    message = refused(run("solve", written(tmp_path, text)), tmp_path)
    for word in ("3 problems", "line 2", "line 3", "line 8"):
        assert word in message


def test_missing_file(run: Run, tmp_path: Path) -> None:
    assert "none.yaml: no such file" in refused(run("solve", "none.yaml", "--out", "x"), tmp_path)


@pytest.mark.parametrize("text", ["", "\n", "# a comment only\n", "---\n", "null\n"])
def test_empty_file(run: Run, tmp_path: Path, text: str) -> None:
    assert "half.yaml: is empty" in refused(run("solve", written(tmp_path, text)), tmp_path)


@pytest.mark.parametrize("text", ["- 1\n", "word\n", "3\n"])
def test_file_without_keys(run: Run, tmp_path: Path, text: str) -> None:
    assert "expected keys such as" in refused(run("solve", written(tmp_path, text)), tmp_path)


def test_binary_file(run: Run, tmp_path: Path) -> None:
    (tmp_path / "half.yaml").write_bytes(b"\x89PNG\xff\xfe")
    assert "half.yaml" in refused(run("solve", "half.yaml"), tmp_path)


def test_folder_for_a_file(run: Run, tmp_path: Path) -> None:
    assert "is a directory" in refused(run("solve", "."), tmp_path)


@pytest.mark.parametrize(
    "override", ["law.epsilon", "law.epsilon=-1", "law.eps=1", "=3", "name.x=1", "law.epsilon=[1"]
)
def test_bad_overrides(run: Run, tmp_path: Path, override: str) -> None:
    message = refused(run("solve", written(tmp_path, HALF), "--set", override), tmp_path)
    assert f"--set {override}" in message


def test_output_below_a_file_cannot_be_written(run: Run, tmp_path: Path) -> None:
    path = written(tmp_path, HALF)
    message = refused(run("solve", path, "--out", path / "result"), tmp_path)
    assert "half.yaml" in message
    assert "cannot be written" in message


def test_output_that_is_a_file_is_refused(run: Run, tmp_path: Path) -> None:
    path = written(tmp_path, HALF)
    assert "is a file" in refused(run("solve", path, "--out", path), tmp_path)
    assert path.read_text() == HALF


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write")
def test_read_only_folder_cannot_be_written(run: Run, tmp_path: Path) -> None:
    path = written(tmp_path, HALF)
    tmp_path.chmod(0o555)
    try:
        message = refused(run("solve", path, "--out", tmp_path / "result"), tmp_path)
    finally:
        tmp_path.chmod(0o755)
    assert "cannot be written" in message


def test_output_with_foreign_files_is_left_alone(run: Run, tmp_path: Path) -> None:
    path = written(tmp_path, HALF)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("mine")
    status, _, err = run("solve", path, "--out", tmp_path / "mine")
    assert status == 2
    assert "notes.txt" in err
    assert [p.name for p in (tmp_path / "mine").iterdir()] == ["notes.txt"]


def test_bad_input_in_json_is_one_object(run: Run, tmp_path: Path) -> None:
    status, out, err = run("solve", written(tmp_path, HALF.replace("0.01", "-1")), "--json")
    found = json.loads(out)
    assert status == 2
    assert (found["status"], found["verified"]) == ("bad_input", False)
    assert found["message"] in err


def test_quiet_still_tells_failures(run: Run, tmp_path: Path) -> None:
    path = written(tmp_path, HALF.replace("0.01", "-1"))
    assert "law.epsilon" in refused(run("solve", path, "--quiet"), tmp_path)


def test_plot_of_no_result(run: Run, tmp_path: Path) -> None:
    assert "without a result of ribbonopt" in refused(run("plot", tmp_path), tmp_path)


def test_missing_guess(run: Run, tmp_path: Path) -> None:
    text = HALF.replace("{force: [0, 40, 40], moment: [0, 2, -9]}", "{solution: nowhere}")
    assert "nowhere" in refused(run("solve", written(tmp_path, text)), tmp_path)


UNREACHABLE = "parameters={shortening: -0.2}"


@pytest.mark.parametrize("verb", ["solve", "check"])
def test_unreachable_ends_are_told_before_solving(
    run: Run, configs: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, verb: str
) -> None:
    def never(*_: object) -> None:
        raise AssertionError("solved")

    monkeypatch.setattr("ribbonopt.solvers.newton.NewtonSolver.solve", never)
    monkeypatch.setattr("ribbonopt.solvers.ipopt.IpoptSolver.solve", never)
    status, out, err = run(verb, configs / "elastica_clamped.yaml", "--set", UNREACHABLE)
    assert (status, out) == (3, "")
    for word in ("unreachable", "1.2 apart", "boundary.end.position", "1 long"):
        assert word in err
    assert list(tmp_path.iterdir()) == []


def test_unreachable_ends_write_nothing(run: Run, configs: Path, tmp_path: Path) -> None:
    scene = configs / "elastica_clamped.yaml"
    assert run("solve", scene, "--set", UNREACHABLE, "--out", "x").status == 3
    assert list(tmp_path.iterdir()) == []


def test_unreachable_ends_in_json(run: Run, configs: Path) -> None:
    found = run("solve", configs / "elastica_clamped.yaml", "--set", UNREACHABLE, "--json")
    assert json.loads(found.out)["status"] == "unreachable"


@pytest.mark.parametrize("solver", ["ipopt", "newton"])
def test_no_convergence_says_what_resists(
    run: Run, configs: Path, tmp_path: Path, solver: str
) -> None:
    stop = f"solver={{type: {solver}, max_iterations: 1}}"
    law = "law={type: single_sheet, chi: 1}"  # of which no smooth law stands in place
    status, out, err = run("solve", configs / "moebius_half.yaml", "--set", stop, "--set", law)
    assert status == 3
    assert "max iterations" in out
    assert "What resists most is" in err
    assert "Traceback" not in err
    assert list(tmp_path.iterdir()) == []


def test_partial_results_are_kept_beside_an_older_result(
    run: Run, configs: Path, tmp_path: Path
) -> None:
    scene, target = configs / "moebius_half.yaml", tmp_path / "result"
    assert run("solve", scene, "--out", target, "--quiet").status == 0
    before = {path.name: path.read_bytes() for path in target.iterdir()}
    stop = "solver={type: newton, max_iterations: 1}"
    status, _, err = run("solve", scene, "--set", stop, "--out", target)
    assert status == 3
    assert "kept in" in err
    assert {path.name: path.read_bytes() for path in target.iterdir()} == before
    kept = [path for path in tmp_path.iterdir() if path != target]
    assert [path.name for path in kept] == ["result.not-converged"]
    assert not load_solution(kept[0]).verified


def test_no_convergence_in_json_is_one_object(run: Run, configs: Path) -> None:
    stop = "solver={type: newton, max_iterations: 1}"
    status, out, _ = run("solve", configs / "moebius_half.yaml", "--set", stop, "--json")
    found = json.loads(out)
    assert (status, found["status"], found["verified"]) == (3, "max_iterations", False)
