"""Names that are odd, and names of folders all the same, go through every verb and come back."""

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from half_studies import SCENE
from hostile import acting

from ribbonopt.output.results import load_solution
from ribbonopt.studies.batch.cells import as_yaml
from ribbonopt.studies.batch.sweep import load_study
from ribbonopt.text import is_executed

Run = Callable[..., Any]

ODD = r"=1+1 $frac{$ 日本 '<b>' %s {0}".replace("<b>", "&lt;b")
BRANCH = "continuation: {parameter: law.epsilon, to: 0.2, first: 0.1, stability: false}\n"


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "scene.yaml"
    path.write_text(SCENE.replace("half", as_yaml(ODD), 1), encoding="utf-8")
    return path


def test_a_solve_keeps_its_name(run: Run, scene: Path, tmp_path: Path) -> None:
    status, out, err = run("solve", scene, "--plot")
    assert (status, err) == (0, "")
    assert out.startswith(f"{ODD}: converged")
    assert not acting(out)
    assert load_solution(tmp_path / "results" / ODD).scene.name == ODD
    assert run("plot", tmp_path / "results" / ODD).status == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["results", "scene.yaml"]
    assert [path.name for path in (tmp_path / "results").iterdir()] == [ODD]


def test_a_branch_keeps_its_name(run: Run, scene: Path, tmp_path: Path) -> None:
    with open(scene, "a", encoding="utf-8") as file:
        file.write(BRANCH)
    status, out, err = run("continue", scene, "--plot")
    assert (status, err) == (0, "")
    assert out.startswith(f"{ODD}: ")
    assert (tmp_path / "results" / f"{ODD}-branch" / "branch.png").is_file()


def test_tables_of_a_batch_are_no_formulas_and_are_read_again(
    run: Run, scene: Path, tmp_path: Path
) -> None:
    names = [ODD, "@home", "+1", "true", "1e-3", "\uff1da", "plain", "it's; a, b"]
    values = ", ".join(map(as_yaml, names))
    study = f"name: {as_yaml(ODD)}\nscene: scene.yaml\nsweep: {{grid: {{name: [{values}]}}}}\n"
    (tmp_path / "study.yaml").write_text(study, encoding="utf-8")
    status, _, err = run("batch", "study.yaml", "--jobs", 1, "--plot")
    assert (status, err) == (0, "")
    table = tmp_path / "results" / ODD / "table.csv"
    with open(table, encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert not any(is_executed(text) for row in rows for text in (*row, *row.values()))
    # The inputs of a table are the inputs of another study.
    with open(tmp_path / "again.csv", "w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([["name"], *([row["name"]] for row in rows)])
    (tmp_path / "again.yaml").write_text("scene: scene.yaml\nsweep: {csv: again.csv}\n")
    (sweep,) = load_study([tmp_path / "again.yaml"]).sweeps
    assert [inputs["name"] for inputs in sweep.inputs] == names
