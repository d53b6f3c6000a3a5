"""Pictures that fail lose nothing: numbers are in their place first, and it is told what failed."""

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.figure
import pytest
from branches import COLUMN, SHORT
from half_studies import SCENE

from ribbonopt.output.results import load_solution

Run = Callable[..., Any]
SMALL = ("--formulations", "inverted", "--transcriptions", "gauss", "--tolerances", "1e-3")


def no_strains(figure: Any, path: Path, **keywords: Any) -> None:
    if Path(path).name == ".strains.png.new":
        raise MemoryError
    Path(path).write_text("drawn")


@pytest.fixture
def fails(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: Any, **__: Any) -> None:
        raise RuntimeError("on purpose")

    monkeypatch.setattr(matplotlib.figure.Figure, "savefig", fail)


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    (tmp_path / "half.yaml").write_text(SCENE)
    return tmp_path / "half.yaml"


def test_solve(run: Run, scene: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(matplotlib.figure.Figure, "savefig", no_strains)
    status, out, err = run("solve", scene, "--out", "result", "--plot", "--json")
    assert status == 3
    assert json.loads(out)["status"] == "converged"
    assert err.startswith("ribbonopt: pictures: result/strains.png: cannot be drawn (MemoryError: ")
    assert err.endswith("; the numbers are kept\n")
    assert load_solution("result").verified
    there = ["plane.png", "ribbon.png", "scene.yaml", "solution.npz", "summary.json"]
    assert sorted(os.listdir("result")) == there  # the other pictures are drawn


def test_solve_where_matplotlib_is_broken(
    run: Run, scene: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "matplotlib.backends.backend_agg", None)
    status, _, err = run("solve", scene, "--out", "result", "--plot")
    assert (status, err.count("\n")) == (3, 1)
    assert "strains.png: cannot be drawn (ModuleNotFoundError" in err
    assert load_solution("result").verified


def test_plot(run: Run, scene: Path, fails: None) -> None:
    assert run("solve", scene, "--out", "result", "--quiet").status == 0
    status, out, err = run("plot", "result")
    assert (status, out) == (3, "")
    assert err.startswith("ribbonopt: result/strains.png: cannot be drawn (RuntimeError: on purpos")
    assert load_solution("result").verified


def test_continue(run: Run, tmp_path: Path, fails: None) -> None:
    (tmp_path / "column.yaml").write_text(COLUMN + SHORT)
    status, out, err = run("continue", "column.yaml", "--out", "branch", "--plot")
    assert status == 3
    assert "points" in out
    assert "branch.png: cannot be drawn (RuntimeError: on purpose)" in err
    assert sorted(os.listdir("branch")) == ["branch.csv", "branch.jsonl", "scene.yaml"]


def test_batch(run: Run, study: Path, fails: None, monkeypatch: pytest.MonkeyPatch) -> None:
    study.write_text("scene: scene.yaml\nsweep: {grid: {law.epsilon: [0.1, 0.09]}}\n")
    status, out, err = run("batch", study, "--out", "batch", "--jobs", "1", "--plot")
    assert (status, "2 ribbons: 2 converged" in out) == (3, True)
    assert "outcomes.png: cannot be drawn" in err
    assert "scatter.png: cannot be drawn" in err
    rows = ["report.html", "rows.jsonl", "study.json", "table.csv"]
    assert sorted(os.listdir("batch")) == rows

    def fail(*_: Any) -> str:
        raise RecursionError("on purpose")

    monkeypatch.setattr("ribbonopt.viewer.report._page", fail)
    status, _, err = run("batch", study, "--out", "again", "--jobs", "1")
    assert (status, "pictures: cannot be drawn (RecursionError: on purpose)" in err) == (3, True)
    assert sorted(os.listdir("again")) == rows[1:]


def test_compare(run: Run, scene: Path, fails: None) -> None:
    status, out, err = run("compare", scene, *SMALL, "--out", "study")
    assert (status, "comparison.png: cannot be drawn" in err, "truth" in out) == (3, True, True)
    assert sorted(os.listdir("study")) == ["comparison.csv", "comparison.json"]


def test_numbers_that_find_no_room_are_told(
    run: Run, scene: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("ribbonopt.output.exports.Summary.write", full)
    status, out, err = run("solve", scene, "--out", "result")
    assert (status, "half: converged, verified" in out) == (2, True)
    told = "ribbonopt: result: cannot be written (No space left on device); choose another folder"
    assert err == told + "\n"
    assert os.listdir(tmp_path) == ["half.yaml"]
