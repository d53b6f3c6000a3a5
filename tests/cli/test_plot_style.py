"""`ribbonopt plot` for papers: files, sizes, insets, moving pictures; refusals write nothing."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from batches import STUDY
from branches import COLUMN, SHORT
from half_studies import SCENE
from PIL import Image

from ribbonopt import load_scene
from ribbonopt.scene import dump_scene, loads_scene

Run = Callable[..., Any]
LABELS = 'labels: {P: "load $P$", shortening: "$\\\\Delta$"}\n'


@pytest.fixture
def half(run: Run, tmp_path: Path) -> Path:
    (tmp_path / "half.yaml").write_text(SCENE)
    assert run("solve", "half.yaml", "--out", "half", "--quiet").status == 0
    return tmp_path / "half"


@pytest.fixture
def column(run: Run, tmp_path: Path) -> Path:
    (tmp_path / "column.yaml").write_text(COLUMN + SHORT + LABELS)
    assert run("continue", "column.yaml", "--out", "branch", "--quiet").status == 0
    return tmp_path / "branch"


def test_a_result_as_svg_of_one_column(run: Run, half: Path, tmp_path: Path) -> None:
    (tmp_path / "paper.yaml").write_text("width: 5\nformat: [svg]\nfont: serif\nletters: true\n")
    more = ("--style", "paper.yaml", "--width", "3.35", "--no-titles", "--camera=-120,30")
    status, out, err = run("plot", half, *more, "--color", "u3", "--out", "figures")
    assert (status, err) == (0, "")
    names = ["strains.svg", "plane.svg", "ribbon.svg"]
    assert out.splitlines() == [f"figures/{name}" for name in names]
    for name in names:
        text = (tmp_path / "figures" / name).read_text()
        assert 'width="241.2pt"' in text and "<text" in text and ">half</text>" not in text
    assert ">(a)</text>" in (tmp_path / "figures" / "strains.svg").read_text()
    # The folder of a result knows what was drawn into it: it may be replaced.
    (half / "ribbon.svg").write_text("of an older result")
    assert run("solve", "half.yaml", "--out", "half", "--quiet").status == 0
    assert not (half / "ribbon.svg").exists()


def test_a_branch_with_insets_labels_and_a_gif(run: Run, column: Path) -> None:
    more = ("--inset", "0, 2", "--animate", "gif", "--dpi", "50", "--format", "svg", "--width", "5")
    status, out, err = run("plot", column, *more)
    assert (status, err) == (0, "")
    assert [Path(line).name for line in out.splitlines()] == [
        *("branch.svg", "ribbons.svg", "branch.gif")
    ]
    text = (column / "branch.svg").read_text()
    assert "<!-- load $P$ -->" in text and ">parameters.P" not in text
    rows = (column / "branch.jsonl").read_text().count('"row"')
    with Image.open(column / "branch.gif") as image:
        assert image.n_frames == rows and image.size == (250, image.size[1])
    assert run("continue", "column.yaml", "--out", "branch", "--resume", "--quiet").status == 0


def test_a_batch_is_coloured_by_a_column_and_called_as_its_study_says(
    run: Run, study: Path, tmp_path: Path
) -> None:
    study.write_text(STUDY + 'labels: {energy: "$W$"}\n')
    assert run("batch", study, "--jobs", "1", "--out", "b", "--quiet").status == 0
    assert json.loads((tmp_path / "b" / "study.json").read_text())["labels"] == {"energy": "$W$"}
    status, out, err = run("plot", "b", "--format", "svg", "--color", "u3", "--no-titles")
    assert (status, err) == (0, "")
    assert {Path(line).name for line in out.splitlines()} == {
        *("report.html", "outcomes.svg", "scatter.svg")
    }
    status, _, err = run("plot", "b", "--color", "u33", "--out", "none")
    assert status == 2 and "--color: found 'u33', expected a column" in err
    assert "did you mean 'u3'?" in err
    for option in ("--camera=x", "--half-width=1", "--inset=1", "--animate=gif"):
        status, _, err = run("plot", "b", option, "--out", "none")
        assert status == 2 and option.split("=")[0] in err
    study.write_text(STUDY + "labels: [energy]\n")
    assert "expected columns and what they are called" in run("batch", study, "--out", "c").err
    assert not (tmp_path / "none").exists() and not (tmp_path / "c").exists()


@pytest.mark.parametrize(
    "words, said",
    [
        ("--width 0", "--width: found 0.0, expected a number from 1 to 40"),
        ("--width wide", "--width: found 'wide', expected a number"),
        ("--dpi nan", "--dpi: found nan"),
        ("--format png,jpg", "--format: found 'jpg', expected 'png', 'svg' or 'pdf'"),
        ("--camera up", "--camera: found 'up', expected azimuth,elevation"),
        ("--color U2", "--color: found 'U2', expected one of u2, u3, eta, energy"),
        ("--half-width -1", "--half-width: found -1.0, expected a number > 0"),
        ("--font Helvetikka", "--font: found 'Helvetikka', expected sans, serif or the family"),
        ("--style none.yaml", "none.yaml: no such file"),
        ("--style wrong.yaml", "wrong.yaml, line 2, widht: unknown key; did you mean 'width'?"),
        ("--style list.yaml", "list.yaml: expected keys of a style"),
        ("--inset 1", "--inset: half is no branch"),
        ("--animate mp4", "--animate: half is no branch"),
    ],
)
def test_what_makes_no_sense_is_refused(
    run: Run, half: Path, tmp_path: Path, words: str, said: str
) -> None:
    (tmp_path / "wrong.yaml").write_text("dpi: 100\nwidht: 3\n")
    (tmp_path / "list.yaml").write_text("[1, 2]\n")
    status, out, err = run("plot", "half", *words.split(), "--out", "none")
    assert (status, out) == (2, "")
    assert err.startswith(f"ribbonopt: {said}")
    assert not (tmp_path / "none").exists()


def test_points_that_a_branch_has_not_are_refused(run: Run, column: Path, tmp_path: Path) -> None:
    for text, said in (
        ("99", "found 99, expected points of the branch, 0 to"),
        ("a", "found 'a'; expected a whole number from 0"),
    ):
        status, _, err = run("plot", column, "--inset", text, "--out", "none")
        assert status == 2 and f"--inset: {said}" in err
    assert not (tmp_path / "none").exists()


def test_labels_of_scenes_are_texts_and_stay_in_files() -> None:
    scene = loads_scene(COLUMN + LABELS)
    assert scene.labels == {"P": "load $P$", "shortening": "$\\Delta$"}
    assert loads_scene(dump_scene(scene)) == scene
    assert "labels" not in dump_scene(loads_scene(COLUMN))


def test_a_label_that_is_no_text_is_refused(run: Run, tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text(COLUMN + "labels: {P: [1]}\n")
    status, _, err = run("check", "a.yaml")
    assert status == 2 and "labels.P" in err
    (tmp_path / "b.yaml").write_text(COLUMN + 'labels: {P: "\\\\frac{ $\\\\frac{$ \\e[31m"}\n')
    assert load_scene(tmp_path / "b.yaml").labels["P"].startswith("\\frac")
